#pragma once
// A path as lines on paper: projected, thinned out to what the paper can show, and sorted by colour.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <boost/describe.hpp>

#include "rehearsal/drawing.hpp"
#include "rehearsal/plot_colours.hpp"
#include "rehearsal/straight_run.hpp"

namespace kerf::rehearsal {

/// Front is seen from -Y, side from +X, isometric from +X -Y +Z.
enum class PlotView { Top, Front, Side, Isometric };
BOOST_DESCRIBE_ENUM(PlotView, Top, Front, Side, Isometric)

/// What of X, Y and Z points to the right, and what points up.
struct ViewAxes {
  std::array<double, 3> right{};
  std::array<double, 3> up{};
};

[[nodiscard]] ViewAxes axes_of(PlotView view);

/// From places to pixels.
struct Projection {
  ViewAxes axes{};
  double px_per_mm = 1;
  /// Where work zero is.
  Pixel zero{};

  [[nodiscard]] Pixel at(const std::array<double, 3>& mm) const;
  [[nodiscard]] Pixel at(const Point& mm) const;
};

/// Keeps no more of a path than its paper has room for, however long it is: a line is left out where its colour is
/// already.
class PathPainter {
 public:
  /// `colours` must outlive it. Only what is within `paper` (from its top left to its bottom right corner) is kept.
  PathPainter(const PathColours& colours, PlotView view, const Projection& projection, Pixel paper_from,
              Pixel paper_to);

  void add(const PathChunk& chunk);
  /// Rapids first, then cuts, layer by layer.
  void finish(Drawing& drawing, double width_px);

 private:
  struct Layer {
    StraightRun run;
    Strokes strokes{};
    /// Plunges, seen from above.
    Strokes dots{};
    Pixel run_begin{};
    Pixel last{};
    bool is_open = false;
    bool continues = false;
  };

  void add_motion(const Point& from, const PathVertex& vertex);
  void add_cut(const Point& from, const Point& to, const PathVertex& vertex);
  void add_line(std::size_t layer, Pixel from, Pixel to);
  void add_dot(std::size_t layer, Pixel at);
  void flush(std::size_t layer);
  /// Marks the cells under a line; false when all of them were.
  bool cover(std::size_t layer, Pixel from, Pixel to);
  bool cover_cell(std::size_t layer, double x, double y);

  const PathColours* colours_;
  Projection projection_;
  vocabulary::AxisMask needed_axes_;
  bool sees_plunges_as_points_;
  float chord_tolerance_mm_;
  Pixel paper_from_;
  std::size_t columns_;
  std::size_t rows_;
  /// A bit for each layer that covers a cell.
  std::vector<std::uint32_t> cells_;
  std::vector<Layer> layers_;
  std::vector<Point> chords_;
};

}  // namespace kerf::rehearsal
