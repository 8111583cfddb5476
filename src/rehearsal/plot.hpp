#pragma once
// Pictures of a toolpath, fit for print: dark on white, with axes, work zero, a scale bar and a legend.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/plot_painter.hpp"
#include "rehearsal/toolpath_summary.hpp"

namespace kerf::rehearsal {

struct PlotOptions {
  PlotView view = PlotView::Isometric;
  /// Empty: what tells most of this path.
  std::optional<PlotColour> colour{};
  double width_px = 1200;
  /// At most: a picture of a flat part is as high as it needs to be.
  double height_px = 900;
  std::string title{};
  /// With title and legend; without them a picture is one of several on a page.
  bool is_sheet = true;
};

/// One picture for each of `options`, in their order. The program is read once, however many they are.
[[nodiscard]] std::vector<Drawing> plot(std::string_view text, const PathStart& start, const PathSummary& path,
                                        std::span<const PlotOptions> options);

/// Greatest of 1, 2 and 5 times a power of ten that is not above `value`.
[[nodiscard]] double round_step(double value);

/// A length or place in mm without needless digits: "0.25", "12.5", "300"; with a real minus sign.
[[nodiscard]] std::string paper_number(double value);

}  // namespace kerf::rehearsal
