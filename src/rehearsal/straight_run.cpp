#include "rehearsal/straight_run.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::rehearsal {
namespace {

using Place = StraightRun::Place;

double dot(const Place& left, const Place& right) {
  return left[0] * right[0] + left[1] * right[1] + left[2] * right[2];
}

double angle_between(const Place& left, const Place& right) {
  const Place cross{left[1] * right[2] - left[2] * right[1], left[2] * right[0] - left[0] * right[2],
                    left[0] * right[1] - left[1] * right[0]};
  return std::atan2(std::sqrt(dot(cross, cross)), dot(left, right));
}

/// Unit vectors; `angle_rad` from `from` towards `to`, which are `between_rad` apart and not opposite.
Place turned(const Place& from, const Place& to, double angle_rad, double between_rad) {
  const double whole = std::sin(between_rad);
  if (whole < 1e-12) return from;
  const double keep = std::sin(between_rad - angle_rad) / whole;
  const double take = std::sin(angle_rad) / whole;
  return {keep * from[0] + take * to[0], keep * from[1] + take * to[1], keep * from[2] + take * to[2]};
}

}  // namespace

void StraightRun::begin(const Place& at) {
  begin_ = at;
  farthest_ = 0;
  has_cone_ = false;
}

bool StraightRun::take(const Place& point) {
  Place way{point[0] - begin_[0], point[1] - begin_[1], point[2] - begin_[2]};
  const double length = std::sqrt(dot(way, way));
  // The line would end before the place that was farthest.
  if (length < farthest_) return false;
  if (length <= tolerance_) {
    farthest_ = length;
    return true;
  }
  for (double& part : way) part /= length;
  const double half_angle = std::asin(std::min(tolerance_ / length, 1.0));
  if (!has_cone_) {
    axis_ = way;
    half_angle_rad_ = half_angle;
    has_cone_ = true;
    farthest_ = length;
    return true;
  }
  const double between = angle_between(axis_, way);
  if (between > half_angle_rad_) return false;
  farthest_ = length;
  if (between + half_angle <= half_angle_rad_) {
    axis_ = way;
    half_angle_rad_ = half_angle;
  } else if (between + half_angle_rad_ > half_angle) {
    // The two overlap in a lens: its widest circle lies on the way between their middles.
    axis_ = turned(axis_, way, (between + half_angle_rad_ - half_angle) / 2, between);
    half_angle_rad_ = (half_angle_rad_ + half_angle - between) / 2;
  }
  return true;
}

}  // namespace kerf::rehearsal
