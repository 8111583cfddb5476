#include "sender/job/step_loss.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kerf::job {
namespace {

/// Ends of blocks are rounded to whole steps; on the way an axis that moves is another step behind or ahead at most.
constexpr double kStepsAtRest = 0.5;
constexpr double kStepsInMotion = 1.5;
/// Less than that of a direction says nothing.
constexpr double kLeastShare = 0.05;

}  // namespace

void StepLoss::begin(const PathRules& rules) {
  axes_ = static_cast<std::size_t>(rules.settings.axes);
  step_mm_ = {};
  if (!rules.motion.restart_resets_bresenham) {
    set({});
    return;
  }
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const float steps = rules.settings.steps_per_mm[axis];
    if (steps > 0) step_mm_[axis] = 1 / steps;
    box_.least_mm[axis] = std::min(box_.least_mm[axis], 0.0F);
    box_.most_mm[axis] = std::max(box_.most_mm[axis], 0.0F);
  }
  set(box_);
}

void StepLoss::on_restart() {
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    box_.least_mm[axis] -= step_mm_[axis];
    box_.most_mm[axis] += step_mm_[axis];
  }
  set(box_);
}

void StepLoss::narrow(std::span<const PathPiece> pieces, const AxisValues& at_mm) {
  if (reach_mm_ == 0) return;
  std::optional<Box> left;
  for (const PathPiece& piece : pieces) {
    Box box = box_;
    if (!cut(box, piece, at_mm)) continue;
    if (!left) left = box;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      left->least_mm[axis] = std::min(left->least_mm[axis], box.least_mm[axis]);
      left->most_mm[axis] = std::max(left->most_mm[axis], box.most_mm[axis]);
    }
  }
  if (left) set(*left);
}

// Across the piece, in the direction of each axis: what was reported lies so far off it, and that is the offset but for
// steps and digits.
bool StepLoss::cut(Box& box, const PathPiece& piece, const AxisValues& at_mm) const {
  double way_way = 0;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const auto way = static_cast<double>(piece.end_mm[axis] - piece.start_mm[axis]);
    way_way += way * way;
  }
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const auto way = static_cast<double>(piece.end_mm[axis] - piece.start_mm[axis]);
    double off = 0;
    double slack = rounding_mm_;
    double least = 0;
    double most = 0;
    double own = 0;
    for (std::size_t other = 0; other < axes_; ++other) {
      const auto other_way = static_cast<double>(piece.end_mm[other] - piece.start_mm[other]);
      const double share = (other == axis ? 1.0 : 0.0) - (way_way > 0 ? way * other_way / way_way : 0.0);
      off += share * static_cast<double>(at_mm[other] - piece.start_mm[other]);
      const auto step = static_cast<double>(step_mm_[other]);
      slack += std::abs(share) * step * (other_way == 0 ? kStepsAtRest : kStepsInMotion);
      const double low = share * static_cast<double>(share > 0 ? box.least_mm[other] : box.most_mm[other]);
      const double high = share * static_cast<double>(share > 0 ? box.most_mm[other] : box.least_mm[other]);
      if (other == axis) {
        own = share;
        continue;
      }
      least += low;
      most += high;
    }
    if (own < kLeastShare) continue;
    box.least_mm[axis] = std::max(box.least_mm[axis], static_cast<float>((off - slack - most) / own));
    box.most_mm[axis] = std::min(box.most_mm[axis], static_cast<float>((off + slack - least) / own));
    if (box.least_mm[axis] > box.most_mm[axis]) return false;
  }
  return true;
}

void StepLoss::set(const Box& box) {
  box_ = box;
  double square = 0;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    middle_mm_[axis] = (box_.least_mm[axis] + box_.most_mm[axis]) / 2;
    const auto half = static_cast<double>(box_.most_mm[axis] - box_.least_mm[axis]) / 2;
    square += half * half;
  }
  reach_mm_ = std::sqrt(square);
}

}  // namespace kerf::job
