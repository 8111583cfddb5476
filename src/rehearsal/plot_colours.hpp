#pragma once
// Which colour a piece of path has, and what that means. All colours stand out from white paper, on a screen and
// printed.

#include <cstddef>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "rehearsal/drawing.hpp"
#include "rehearsal/toolpath_summary.hpp"

namespace kerf::rehearsal {

enum class PlotColour { Operation, Tool, Feed, Height };
BOOST_DESCRIBE_ENUM(PlotColour, Operation, Tool, Feed, Height)

/// What tells most of this path: its operations if it names more than one, else its tools, else the height.
[[nodiscard]] PlotColour telling_colour(const PathSummary& path);

struct LegendRow {
  std::string name;
  Rgb colour = 0;
};

/// Cuts are drawn in layers, one a colour, the first at the bottom.
class PathColours {
 public:
  /// So many at most: what is more shares the last.
  static constexpr std::size_t kMostLayers = 16;

  PathColours(const PathSummary& path, PlotColour by);

  [[nodiscard]] PlotColour by() const { return by_; }
  [[nodiscard]] std::size_t layers() const { return colours_.size(); }
  [[nodiscard]] Rgb colour(std::size_t layer) const { return colours_.at(layer); }
  [[nodiscard]] std::size_t layer_of(const PathVertex& cut, double height_mm) const;
  /// Heights at which the colour changes, ascending; empty unless it is the height that gives it.
  [[nodiscard]] const std::vector<double>& height_steps_mm() const { return height_steps_mm_; }

  [[nodiscard]] std::string legend_title() const;
  /// For operations and tools, in order.
  [[nodiscard]] const std::vector<LegendRow>& legend() const { return legend_; }
  /// Feed or height: the ends of the scale.
  [[nodiscard]] const Extent& scale() const { return scale_; }

 private:
  void colour_by_scale(const Extent& extent);

  PlotColour by_;
  std::vector<Rgb> colours_;
  std::vector<std::size_t> layer_by_number_;
  std::vector<LegendRow> legend_;
  std::vector<double> height_steps_mm_;
  Extent scale_{};
};

/// 0 to 1 on the scale for feeds and heights.
[[nodiscard]] Rgb scale_colour(double share);

/// Operations and tools by the order in which they begin.
[[nodiscard]] Rgb category_colour(std::size_t index);

}  // namespace kerf::rehearsal
