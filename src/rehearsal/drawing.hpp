#pragma once
// A picture as a list of what to draw, in order: the same for every kind of paper. Places are pixels from the top left
// corner, angles degrees.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace kerf::rehearsal {

struct Pixel {
  double x = 0;
  double y = 0;
  bool operator==(const Pixel&) const = default;
};

/// 0xRRGGBB.
using Rgb = std::uint32_t;

enum class Dash : std::uint8_t { Solid, Dashed };

struct Ink {
  Rgb colour = 0;
  double width_px = 1;
  Dash dash = Dash::Solid;
  bool operator==(const Ink&) const = default;
};

/// Open lines of one ink, with round ends.
struct Strokes {
  Ink ink{};
  std::vector<Pixel> points;
  /// Index behind the last point of each line.
  std::vector<std::size_t> ends;

  /// One line more.
  void add(std::initializer_list<Pixel> line) {
    points.insert(points.end(), line);
    ends.push_back(points.size());
  }
};

/// A filled polygon.
struct Area {
  Rgb fill = 0;
  std::vector<Pixel> corners;
};

enum class Anchor : std::uint8_t { Start, Middle, End };

struct Label {
  Pixel at{};
  std::string text;
  double size_px = 12;
  Rgb colour = 0;
  Anchor anchor = Anchor::Start;
  bool bold = false;
  /// Counter-clockwise around `at`.
  double turned_deg = 0;
};

using DrawingItem = std::variant<Strokes, Area, Label>;

struct Drawing {
  double width_px = 0;
  double height_px = 0;
  /// For those who cannot see it; empty when it only shows what is told beside it.
  std::string title;
  std::vector<DrawingItem> items;
};

/// About as wide as common sans-serif fonts make it.
[[nodiscard]] double text_width_px(std::string_view text, double size_px, bool bold = false);

/// `text`, or as much of its beginning as fits, with an ellipsis. Never cuts within a letter of UTF-8.
[[nodiscard]] std::string shortened(std::string_view text, double width_px, double size_px, bool bold = false);

/// `text` as the content of an XML or HTML element, or of an attribute in double quotes: valid UTF-8 without control
/// characters, whatever came in.
[[nodiscard]] std::string escape_markup(std::string_view text);

/// How an SVG element stands in its surroundings.
enum class SvgPlace : std::uint8_t {
  File,    ///< a file of its own, on white paper
  Inline,  ///< within an HTML page that gives it its width
};

[[nodiscard]] std::string to_svg(const Drawing& drawing, SvgPlace place = SvgPlace::File);

}  // namespace kerf::rehearsal
