#include "rehearsal/plot_painter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::rehearsal {
namespace {

constexpr Rgb kRapidColour = 0x9AA5B1;
/// Nobody sees a line that is so little off.
constexpr double kTolerance_px = 0.15;
constexpr double kCellsPerPx = 2;
constexpr std::size_t kMostCells = 16'000'000;
constexpr double kThinner = 0.6;
constexpr double kDotWidth = 2.4;
constexpr std::size_t kZ = 2;

double dot(const std::array<double, 3>& left, const std::array<double, 3>& right) {
  return left[0] * right[0] + left[1] * right[1] + left[2] * right[2];
}

vocabulary::AxisMask needed_axes(const ViewAxes& axes) {
  unsigned mask = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes.right.at(axis) != 0 || axes.up.at(axis) != 0) mask |= 1U << axis;
  }
  return static_cast<vocabulary::AxisMask>(mask);
}

Point between(const Point& from, const Point& to, double share) {
  Point point{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point.at(axis) = std::lerp(from.at(axis), to.at(axis), static_cast<float>(share));
  }
  return point;
}

}  // namespace

ViewAxes axes_of(PlotView view) {
  constexpr double kHalf = 1 / std::numbers::sqrt2;
  const double sixth = 1 / std::sqrt(6.0);
  switch (view) {
    case PlotView::Top: return {.right = {1, 0, 0}, .up = {0, 1, 0}};
    case PlotView::Front: return {.right = {1, 0, 0}, .up = {0, 0, 1}};
    case PlotView::Side: return {.right = {0, 1, 0}, .up = {0, 0, 1}};
    case PlotView::Isometric: break;
  }
  return {.right = {kHalf, kHalf, 0}, .up = {-sixth, sixth, 2 * sixth}};
}

Pixel Projection::at(const std::array<double, 3>& mm) const {
  return {.x = zero.x + px_per_mm * dot(axes.right, mm), .y = zero.y - px_per_mm * dot(axes.up, mm)};
}

Pixel Projection::at(const Point& mm) const {
  return at(std::array<double, 3>{mm[0], mm[1], mm[2]});
}

PathPainter::PathPainter(const PathColours& colours, PlotView view, const Projection& projection, Pixel paper_from,
                         Pixel paper_to)
    : colours_(&colours),
      projection_(projection),
      needed_axes_(needed_axes(projection.axes)),
      sees_plunges_as_points_(view == PlotView::Top),
      chord_tolerance_mm_(static_cast<float>(kTolerance_px / projection.px_per_mm)),
      paper_from_(paper_from),
      columns_(static_cast<std::size_t>(std::max(paper_to.x - paper_from.x, 1.0) * kCellsPerPx)),
      rows_(static_cast<std::size_t>(std::max(paper_to.y - paper_from.y, 1.0) * kCellsPerPx)),
      cells_(std::min(columns_ * rows_, kMostCells)),
      // The first is for rapids.
      layers_(colours.layers() + 1, Layer{.run = StraightRun(kTolerance_px)}) {}

void PathPainter::add(const PathChunk& chunk) {
  const PathVertex* before = &chunk.start;
  for (const PathVertex& vertex : chunk.vertices) {
    const bool is_known = (unknown_axes_between(*before, vertex) & needed_axes_) == 0;
    if (is_known && !is_event(vertex.kind)) add_motion(before->at_mm, vertex);
    before = &vertex;
  }
}

void PathPainter::add_motion(const Point& from, const PathVertex& vertex) {
  if (!is_cut(vertex.kind)) {
    add_line(0, projection_.at(from), projection_.at(vertex.at_mm));
    return;
  }
  if (!is_arc(vertex.kind)) {
    add_cut(from, vertex.at_mm, vertex);
    return;
  }
  chords_.clear();
  append_chords(from, vertex, chord_tolerance_mm_, chords_);
  const Point* before = &from;
  for (const Point& point : chords_) {
    add_cut(*before, point, vertex);
    before = &point;
  }
}

void PathPainter::add_cut(const Point& from, const Point& to, const PathVertex& vertex) {
  const bool is_plunge = from[0] == to[0] && from[1] == to[1];
  if (sees_plunges_as_points_ && is_plunge) {
    const double lower = static_cast<double>(std::min(from[kZ], to[kZ]));
    if (to[kZ] < from[kZ]) add_dot(colours_->layer_of(vertex, lower) + 1, projection_.at(to));
    return;
  }
  const double from_z = static_cast<double>(from[kZ]);
  const double to_z = static_cast<double>(to[kZ]);
  Point begin = from;
  // A slope changes its colour on the way.
  const auto& steps = colours_->height_steps_mm();
  const auto first = std::ranges::upper_bound(steps, std::min(from_z, to_z));
  const auto last = std::ranges::lower_bound(steps, std::max(from_z, to_z));
  const auto cut_at = [&](double height_mm) {
    const Point end = between(from, to, (height_mm - from_z) / (to_z - from_z));
    const double middle = (static_cast<double>(begin[kZ]) + height_mm) / 2;
    add_line(colours_->layer_of(vertex, middle) + 1, projection_.at(begin), projection_.at(end));
    begin = end;
  };
  if (to_z > from_z) {
    for (auto step = first; step < last; ++step) cut_at(*step);
  } else {
    for (auto step = last; step > first; --step) cut_at(*(step - 1));
  }
  const double middle = (static_cast<double>(begin[kZ]) + to_z) / 2;
  add_line(colours_->layer_of(vertex, middle) + 1, projection_.at(begin), projection_.at(to));
}

void PathPainter::add_line(std::size_t layer, Pixel from, Pixel to) {
  Layer& paint = layers_[layer];
  if (!paint.is_open || paint.last != from) {
    flush(layer);
    paint.run_begin = paint.last = from;
    paint.run.begin({from.x, from.y, 0});
    paint.is_open = true;
    paint.continues = false;
  }
  if (!paint.run.take({to.x, to.y, 0})) {
    flush(layer);
    paint.is_open = true;
    paint.run_begin = paint.last;
    paint.run.begin({paint.last.x, paint.last.y, 0});
    static_cast<void>(paint.run.take({to.x, to.y, 0}));
  }
  paint.last = to;
}

void PathPainter::add_dot(std::size_t layer, Pixel at) {
  if (!cover_cell(layer, at.x, at.y)) return;
  layers_[layer].dots.add({at, at});
}

void PathPainter::flush(std::size_t layer) {
  Layer& paint = layers_[layer];
  if (!paint.is_open) return;
  paint.is_open = false;
  const bool is_nothing = layer == 0 && paint.run_begin == paint.last;
  if (is_nothing || !cover(layer, paint.run_begin, paint.last)) {
    paint.continues = false;
    return;
  }
  if (!paint.continues) {
    paint.strokes.points.push_back(paint.run_begin);
    paint.strokes.ends.push_back(paint.strokes.points.size());
  }
  paint.strokes.points.push_back(paint.last);
  paint.strokes.ends.back() = paint.strokes.points.size();
  paint.continues = true;
}

bool PathPainter::cover_cell(std::size_t layer, double x, double y) {
  const double column = std::floor((x - paper_from_.x) * kCellsPerPx);
  const double row = std::floor((y - paper_from_.y) * kCellsPerPx);
  const bool is_on_paper =
      column >= 0 && row >= 0 && column < static_cast<double>(columns_) && row < static_cast<double>(rows_);
  if (!is_on_paper) return false;
  const std::size_t cell = static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
  if (cell >= cells_.size()) return true;
  const std::uint32_t bit = std::uint32_t{1} << layer;
  const bool is_new = (cells_[cell] & bit) == 0;
  cells_[cell] |= bit;
  return is_new;
}

bool PathPainter::cover(std::size_t layer, Pixel from, Pixel to) {
  const double length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y)) * kCellsPerPx;
  if (!std::isfinite(length)) return false;
  const auto steps = static_cast<std::size_t>(std::clamp(std::ceil(length), 1.0, 1e5));
  bool is_new = false;
  for (std::size_t step = 0; step <= steps; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(steps);
    is_new |= cover_cell(layer, std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share));
  }
  return is_new;
}

void PathPainter::finish(Drawing& drawing, double width_px) {
  for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
    flush(layer);
    Layer& paint = layers_[layer];
    const bool is_rapid = layer == 0;
    paint.strokes.ink = {.colour = is_rapid ? kRapidColour : colours_->colour(layer - 1),
                         .width_px = is_rapid ? width_px * kThinner : width_px,
                         .dash = is_rapid ? Dash::Dashed : Dash::Solid};
    paint.dots.ink = {.colour = paint.strokes.ink.colour, .width_px = width_px * kDotWidth};
    if (!paint.strokes.ends.empty()) drawing.items.emplace_back(std::move(paint.strokes));
    if (!paint.dots.ends.empty()) drawing.items.emplace_back(std::move(paint.dots));
  }
}

}  // namespace kerf::rehearsal
