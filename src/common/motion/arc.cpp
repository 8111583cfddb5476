#include "common/motion/arc.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace kerf::motion {

namespace {

/// A travel within this of zero is a full circle, in radians.
constexpr float kFullCircle = 5E-7F;
constexpr double kFullCircleWide = 5E-7;
/// Chords between two exact computations of the radius vector.
constexpr int kChordsToCorrection = 12;

template <class Wide>
constexpr Wide kTwoPi = static_cast<Wide>(2) * std::numbers::pi_v<Wide>;

}  // namespace

Arc arc_of(const gcode::ArcMove& move, const AxisValues& start_mm) {
  const gcode::PlaneAxes axes = gcode::axes_of(move.plane);
  return {.start_mm = start_mm,
          .target_mm = move.target_mm,
          .center_offset_mm = move.center_offset_mm,
          .radius_mm = move.radius_mm,
          .plane_axes = {static_cast<std::uint8_t>(axes.first), static_cast<std::uint8_t>(axes.second),
                         static_cast<std::uint8_t>(axes.linear)},
          .clockwise = move.clockwise,
          .turns = move.turns};
}

ArcChords::ArcChords(const Arc& arc, const MotionRules& rules, const MotionSettings& settings)
    : arc_(arc),
      rules_(rules),
      tolerance_mm_(settings.arc_tolerance_mm),
      axes_(static_cast<std::size_t>(settings.axes)),
      wide_(rules.float_rule == FloatRule::DoubleLiterals || rules.arc_radius_in_double),
      position_(arc.start_mm),
      turns_left_(std::max(arc.turns, 1)) {
  const std::size_t a0 = arc.plane_axes[0];
  const std::size_t a1 = arc.plane_axes[1];
  if (turns_left_ > 1) {
    const float rest = wide_ ? travel<double>({arc.target_mm[a0], arc.target_mm[a1]})
                             : travel<float>({arc.target_mm[a0], arc.target_mm[a1]});
    const auto all =
        static_cast<float>(static_cast<double>(2.0F) * std::numbers::pi * static_cast<float>(turns_left_ - 1) +
                           static_cast<double>(arc.clockwise ? -rest : rest));
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const float whole = arc.target_mm[axis] - arc.start_mm[axis];
      per_turn_mm_[axis] = static_cast<float>(static_cast<double>(whole / all * 2.0F) * std::numbers::pi);
    }
  }
  begin_leg();
  first_chords_ = static_cast<int>(chords_);
}

template <class Wide>
float ArcChords::travel(const std::array<float, 2>& end) const {
  const float r0 = -arc_.center_offset_mm[0];
  const float r1 = -arc_.center_offset_mm[1];
  const float start0 = arc_.start_mm[arc_.plane_axes[0]];
  const float start1 = arc_.start_mm[arc_.plane_axes[1]];
  float angle = 0.0F;
  if (rules_.arc_radius_in_double) {
    const double t0 = static_cast<double>(end[0]) - (static_cast<double>(start0) - static_cast<double>(r0));
    const double t1 = static_cast<double>(end[1]) - (static_cast<double>(start1) - static_cast<double>(r1));
    const double x = r0;
    const double y = r1;
    angle = static_cast<float>(std::atan2(x * t1 - y * t0, x * t0 + y * t1));
  } else {
    const float t0 = end[0] - (start0 + arc_.center_offset_mm[0]);
    const float t1 = end[1] - (start1 + arc_.center_offset_mm[1]);
    angle = static_cast<float>(std::atan2(static_cast<Wide>(r0 * t1 - r1 * t0), static_cast<Wide>(r0 * t0 + r1 * t1)));
  }
  const bool tight = std::is_same_v<Wide, float> || rules_.arc_radius_in_double;
  const bool full_clockwise = tight ? angle >= -kFullCircle : static_cast<double>(angle) >= -kFullCircleWide;
  const bool full_counterclockwise = tight ? angle <= kFullCircle : static_cast<double>(angle) <= kFullCircleWide;
  if (arc_.clockwise && full_clockwise) return static_cast<float>(static_cast<Wide>(angle) - kTwoPi<Wide>);
  if (!arc_.clockwise && full_counterclockwise) return static_cast<float>(static_cast<Wide>(angle) + kTwoPi<Wide>);
  return angle;
}

float ArcChords::swept_rad() const {
  const std::array<float, 2> end = {arc_.target_mm[arc_.plane_axes[0]], arc_.target_mm[arc_.plane_axes[1]]};
  return wide_ ? travel<double>(end) : travel<float>(end);
}

template <class Wide>
std::uint32_t ArcChords::chord_count(float travel_rad) const {
  const float doubled = 2.0F * arc_.radius_mm - tolerance_mm_;
  const Wide chord = std::sqrt(static_cast<Wide>(tolerance_mm_ * doubled));
  const Wide half = std::fabs(Wide{0.5} * static_cast<Wide>(travel_rad) * static_cast<Wide>(arc_.radius_mm));
  const Wide count = std::floor(half / chord);
  // Tolerances as large as the circle give no number, and no chords.
  constexpr auto kMost = static_cast<Wide>(4.0E9);
  return count > Wide{0} && count < kMost ? static_cast<std::uint32_t>(count) & rules_.arc_chord_mask : 0;
}

void ArcChords::begin_leg() {
  const std::size_t a0 = arc_.plane_axes[0];
  const std::size_t a1 = arc_.plane_axes[1];
  leg_target_ = arc_.target_mm;
  if (turns_left_ > 1) {
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const bool moves = axis == arc_.plane_axes[2] || rules_.arc_moves_all_axes;
      if (moves) leg_target_[axis] = position_[axis] + per_turn_mm_[axis];
    }
    leg_target_[a0] = arc_.start_mm[a0];
    leg_target_[a1] = arc_.start_mm[a1];
  }
  const std::array<float, 2> end = {leg_target_[a0], leg_target_[a1]};
  const float angle = wide_ ? travel<double>(end) : travel<float>(end);
  const bool double_literals = rules_.float_rule == FloatRule::DoubleLiterals;
  chords_ = double_literals ? chord_count<double>(angle) : chord_count<float>(angle);
  chord_ = 0;
  since_correction_ = 0;
  radius_ = {-static_cast<double>(arc_.center_offset_mm[0]), -static_cast<double>(arc_.center_offset_mm[1])};
  if (rules_.arc_radius_in_double) {
    center_ = {static_cast<double>(arc_.start_mm[a0]) - radius_[0],
               static_cast<double>(arc_.start_mm[a1]) - radius_[1]};
  } else {
    center_ = {arc_.start_mm[a0] + arc_.center_offset_mm[0], arc_.start_mm[a1] + arc_.center_offset_mm[1]};
  }
  if (chords_ == 0) return;

  const auto count = static_cast<float>(chords_);
  theta_ = angle / count;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const bool moves = axis == arc_.plane_axes[2] || rules_.arc_moves_all_axes;
    per_chord_mm_[axis] = moves ? (leg_target_[axis] - position_[axis]) / count : 0.0F;
  }
  // Small-angle sine and cosine; their error is why the vector is corrected now and then.
  cos_ = 2.0F - theta_ * theta_;
  sin_ = double_literals
             ? static_cast<float>(static_cast<double>(theta_) * 0.16666667 * (static_cast<double>(cos_) + 4.0))
             : theta_ * 0.16666667F * (cos_ + 4.0F);
  cos_ *= 0.5F;
}

void ArcChords::turn_radius() {
  if (rules_.arc_radius_in_double) {
    const double s = sin_;
    const double c = cos_;
    const auto second = static_cast<float>(radius_[0] * s + radius_[1] * c);
    radius_[0] = radius_[0] * c - radius_[1] * s;
    radius_[1] = second;
    return;
  }
  const auto r0 = static_cast<float>(radius_[0]);
  const auto r1 = static_cast<float>(radius_[1]);
  const float second = r0 * sin_ + r1 * cos_;
  radius_[0] = r0 * cos_ - r1 * sin_;
  radius_[1] = second;
}

void ArcChords::correct_radius() {
  const float angle = static_cast<float>(chord_) * theta_;
  const bool double_literals = rules_.float_rule == FloatRule::DoubleLiterals;
  const float c = double_literals ? static_cast<float>(std::cos(static_cast<double>(angle))) : std::cos(angle);
  const float s = double_literals ? static_cast<float>(std::sin(static_cast<double>(angle))) : std::sin(angle);
  const auto [x, y] = arc_.center_offset_mm;
  radius_[0] = -x * c + y * s;
  radius_[1] = -x * s - y * c;
}

std::optional<AxisValues> ArcChords::next() {
  if (finished_) return std::nullopt;
  const std::size_t a0 = arc_.plane_axes[0];
  const std::size_t a1 = arc_.plane_axes[1];
  ++chord_;
  if (chord_ >= chords_) {
    position_ = leg_target_;
    if (--turns_left_ == 0) {
      finished_ = true;
    } else {
      begin_leg();
    }
    return position_;
  }
  if (since_correction_ < kChordsToCorrection) {
    turn_radius();
    ++since_correction_;
  } else {
    correct_radius();
    since_correction_ = 0;
  }
  if (rules_.arc_radius_in_double) {
    position_[a0] = static_cast<float>(center_[0] + radius_[0]);
    position_[a1] = static_cast<float>(center_[1] + radius_[1]);
  } else {
    position_[a0] = static_cast<float>(center_[0]) + static_cast<float>(radius_[0]);
    position_[a1] = static_cast<float>(center_[1]) + static_cast<float>(radius_[1]);
  }
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    if (axis != a0 && axis != a1) position_[axis] += per_chord_mm_[axis];
  }
  return position_;
}

}  // namespace kerf::motion
