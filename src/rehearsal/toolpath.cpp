#include "rehearsal/toolpath.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::rehearsal {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kQuarterTurn = std::numbers::pi / 2;
/// Ends this close make a full circle (gnea/grbl config.h ARC_ANGULAR_TRAVEL_EPSILON).
constexpr double kSameAngle = 5e-7;
/// Nobody sees more on any screen, and a tolerance of nothing must end too.
constexpr double kMostChordsOfTurn = 2048;
/// Many turns of one line are not worth the memory.
constexpr double kMostChords = 20'000;
constexpr int kMostTurns = 1000;

struct PlaneOrder {
  std::size_t first;
  std::size_t second;
  std::size_t linear;
};

constexpr PlaneOrder order_of(ArcPlane plane) {
  switch (plane) {
    case ArcPlane::XY: return {.first = 0, .second = 1, .linear = 2};
    case ArcPlane::ZX: return {.first = 2, .second = 0, .linear = 1};
    case ArcPlane::YZ: break;
  }
  return {.first = 1, .second = 2, .linear = 0};
}

/// An arc by its angles. Where its ends are not equally far from the centre, the radius grows evenly, and the last
/// point is the programmed one.
class Sweep {
 public:
  Sweep(const Point& start_mm, const PathVertex& end) : start_(start_mm), end_(end.at_mm), order_(order_of(end.plane)) {
    center_1_ = static_cast<double>(start_mm[order_.first]) + static_cast<double>(end.center_offset_mm[0]);
    center_2_ = static_cast<double>(start_mm[order_.second]) + static_cast<double>(end.center_offset_mm[1]);
    start_radius_ = std::hypot(from_center_1(start_mm), from_center_2(start_mm));
    end_radius_ = std::hypot(from_center_1(end_), from_center_2(end_));
    from_ = std::atan2(from_center_2(start_mm), from_center_1(start_mm));
    const double to = std::atan2(from_center_2(end_), from_center_1(end_));
    sign_ = end.kind == PathKind::ArcClockwise ? -1.0 : 1.0;
    swept_ = std::remainder(sign_ * (to - from_), kFullTurn);
    if (swept_ <= kSameAngle) swept_ += kFullTurn;
    swept_ += kFullTurn * std::clamp(end.turns - 1, 0, kMostTurns);
  }

  [[nodiscard]] double swept_rad() const { return swept_; }
  [[nodiscard]] double radius_mm() const { return std::max(start_radius_, end_radius_); }

  [[nodiscard]] Point at(double share) const {
    const double angle = from_ + sign_ * swept_ * share;
    const double radius = start_radius_ + (end_radius_ - start_radius_) * share;
    Point point{};
    point[order_.first] = static_cast<float>(center_1_ + radius * std::cos(angle));
    point[order_.second] = static_cast<float>(center_2_ + radius * std::sin(angle));
    point[order_.linear] = std::lerp(start_[order_.linear], end_[order_.linear], static_cast<float>(share));
    return point;
  }

  void include_extremes(PathBounds& bounds) const {
    for (int quarter = 0; quarter < 4; ++quarter) {
      double along = std::remainder(sign_ * (quarter * kQuarterTurn - from_), kFullTurn);
      if (along < 0) along += kFullTurn;
      for (; along < swept_; along += kFullTurn) bounds.include(at(along / swept_));
    }
  }

 private:
  [[nodiscard]] double from_center_1(const Point& point) const {
    return static_cast<double>(point[order_.first]) - center_1_;
  }
  [[nodiscard]] double from_center_2(const Point& point) const {
    return static_cast<double>(point[order_.second]) - center_2_;
  }

  Point start_;
  Point end_;
  PlaneOrder order_;
  double center_1_ = 0;
  double center_2_ = 0;
  double start_radius_ = 0;
  double end_radius_ = 0;
  double from_ = 0;
  double sign_ = 1;
  double swept_ = 0;
};

}  // namespace

void PathBounds::include(const Point& point) {
  for (std::size_t axis = 0; axis < point.size(); ++axis) {
    least_mm[axis] = std::min(least_mm[axis], point[axis]);
    most_mm[axis] = std::max(most_mm[axis], point[axis]);
  }
}

void PathBounds::include(const PathBounds& other) {
  if (other.is_empty()) return;
  include(other.least_mm);
  include(other.most_mm);
}

void append_chords(const Point& start_mm, const PathVertex& end, float tolerance_mm, std::vector<Point>& out) {
  const Sweep sweep(start_mm, end);
  const double radius = sweep.radius_mm();
  const double tolerance = static_cast<double>(tolerance_mm);
  // The sagitta of a chord over the angle a is r(1 - cos(a/2)).
  const double step = tolerance < radius ? 2 * std::acos(1 - tolerance / radius) : std::numbers::pi;
  const double most = std::min(kMostChordsOfTurn * std::ceil(sweep.swept_rad() / kFullTurn), kMostChords);
  const double wanted = std::ceil(sweep.swept_rad() / std::max(step, 1e-6));
  const auto chords = static_cast<std::size_t>(std::clamp(wanted, 1.0, most));
  for (std::size_t chord = 1; chord < chords; ++chord) {
    out.push_back(sweep.at(static_cast<double>(chord) / static_cast<double>(chords)));
  }
  out.push_back(end.at_mm);
}

void include_motion(PathBounds& bounds, const Point& start_mm, const PathVertex& end) {
  bounds.include(start_mm);
  bounds.include(end.at_mm);
  if (is_arc(end.kind)) Sweep(start_mm, end).include_extremes(bounds);
}

double length_of(const Point& start_mm, const PathVertex& end) {
  const auto along = [&](std::size_t axis) {
    return static_cast<double>(end.at_mm.at(axis)) - static_cast<double>(start_mm.at(axis));
  };
  if (!is_arc(end.kind)) return std::hypot(along(0), along(1), along(2));
  const Sweep sweep(start_mm, end);
  return std::hypot(sweep.swept_rad() * sweep.radius_mm(), along(order_of(end.plane).linear));
}

}  // namespace kerf::rehearsal
