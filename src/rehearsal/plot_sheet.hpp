#pragma once
// What stands around and behind the path on one picture.

#include "rehearsal/plot.hpp"

namespace kerf::rehearsal {

/// Where everything is on the paper of one picture.
class PlotSheet {
 public:
  PlotSheet(const PlotOptions& options, const PathSummary& path, const PathColours& colours);

  [[nodiscard]] const Projection& projection() const { return projection_; }
  [[nodiscard]] Pixel paper_from() const { return from_; }
  [[nodiscard]] Pixel paper_to() const { return to_; }
  [[nodiscard]] double height_px() const { return height_px_; }
  /// Of the cuts.
  [[nodiscard]] double line_px() const;

  /// Grid, axes and box.
  void draw_behind(Drawing& drawing) const;
  /// Work zero, and on a sheet title, legend and scale bar.
  void draw_before(Drawing& drawing) const;

 private:
  void fit();
  [[nodiscard]] double legend_height_px() const;
  void draw_grid(Drawing& drawing) const;
  void draw_box(Drawing& drawing) const;
  void draw_floor(Drawing& drawing) const;
  void draw_sizes(Drawing& drawing) const;
  void draw_zero(Drawing& drawing) const;
  void draw_axes_from_zero(Drawing& drawing) const;
  void draw_scale_bar(Drawing& drawing, double y) const;
  void draw_header(Drawing& drawing) const;
  void draw_legend(Drawing& drawing) const;
  double draw_rows(Drawing& drawing, double y) const;
  double draw_scale(Drawing& drawing, double y) const;
  [[nodiscard]] double text_px() const;
  [[nodiscard]] bool is_on_paper(Pixel at) const;

  const PlotOptions& options_;
  const PathSummary& path_;
  const PathColours& colours_;
  Projection projection_;
  /// What is shown; never empty.
  PathBounds shown_{};
  /// The field for the path.
  Pixel from_{};
  Pixel to_{};
  double height_px_ = 0;
};

}  // namespace kerf::rehearsal
