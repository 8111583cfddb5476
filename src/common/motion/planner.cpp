#include "common/motion/planner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace kerf::motion {

namespace {

/// Stands for "no limit" in every firmware.
constexpr float kLargeValue = 1.0E+38F;
/// Beyond this cosine a junction counts as straight, or as a reversal.
constexpr float kStraight = 0.999999F;
constexpr double kStraightWide = 0.999999;

/// Half angle identities, in the width of the firmware's literals.
template <class Wide>
float junction_limit(float cos_theta, float acceleration, float deviation) {
  const auto sin_half = static_cast<float>(std::sqrt(Wide{0.5} * (Wide{1} - static_cast<Wide>(cos_theta))));
  const float product = acceleration * deviation * sin_half;
  return std::max(0.0F, static_cast<float>(static_cast<Wide>(product) / (Wide{1} - static_cast<Wide>(sin_half))));
}

template <class Wide>
float scaled_by_percent(float rate, int percent) {
  return static_cast<float>(static_cast<Wide>(rate) * (static_cast<Wide>(0.01L) * static_cast<Wide>(percent)));
}

float scaled_by_percent(FloatRule rule, float rate, int percent) {
  return rule == FloatRule::Single ? scaled_by_percent<float>(rate, percent) : scaled_by_percent<double>(rate, percent);
}

/// Motor steps nearest to `mm`.
std::int32_t steps_from_mm(float mm, float steps_per_mm) {
  return static_cast<std::int32_t>(std::lround(mm * steps_per_mm));
}

}  // namespace

Planner::Planner(const MotionRules& rules, const MotionSettings& settings) : rules_(rules) {
  const int blocks = settings.planner_blocks > 0 ? settings.planner_blocks : rules.planner_blocks;
  ring_.resize(static_cast<std::size_t>(blocks) + 1);
  set_settings(settings);
}

void Planner::set_settings(const MotionSettings& settings) {
  settings_ = settings;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    const float acceleration = settings.acceleration_mm_per_s2[axis];
    stored_acceleration_[axis] = rules_.acceleration_converted_last ? acceleration : acceleration * 60.0F * 60.0F;
  }
}

Planner::Added Planner::plan(const PathLine& line) {
  PlannedBlock& block = ring_[slot(head_)];
  AxisSteps target{};
  AxisValues direction{};
  if (fill_block(block, line, position_, target, direction) == Added::Dropped) return Added::Dropped;
  // From an empty queue motion starts at rest.
  block.max_junction_speed_sqr = is_empty() ? 0.0F : junction_speed_sqr(direction);

  const float nominal = nominal_speed(block);
  limit_entry(block, nominal, previous_nominal_);
  previous_nominal_ = nominal;
  if (!line.is_backlash) {
    previous_direction_ = direction;
    position_ = target;
  }
  head_ = after(head_);
  recalculate();
  return Added::Queued;
}

Planner::Added Planner::plan_system_motion(const PathLine& line, const AxisSteps& start) {
  AxisSteps target{};
  AxisValues direction{};
  return fill_block(system_block(), line, start, target, direction);
}

Planner::Added Planner::fill_block(PlannedBlock& block, const PathLine& line, const AxisSteps& start, AxisSteps& target,
                                   AxisValues& direction) const {
  block = PlannedBlock{};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings_.axes); ++axis) {
    const float steps_per_mm = settings_.steps_per_mm[axis];
    target[axis] = steps_from_mm(line.target_mm[axis], steps_per_mm);
    const std::int32_t delta = target[axis] - start[axis];
    block.steps[axis] = std::abs(delta);
    block.step_events = std::max(block.step_events, static_cast<std::uint32_t>(block.steps[axis]));
    direction[axis] = static_cast<float>(delta) / steps_per_mm;
    if (delta < 0) block.negative_axes = static_cast<AxisMask>(block.negative_axes | (1U << axis));
  }
  if (block.step_events == 0) return Added::Dropped;

  block.feed = line.feed;
  block.source_line = line.source_line;
  block.is_backlash = line.is_backlash;
  block.millimeters = unit_vector(direction);
  block.length_mm = block.millimeters;
  block.acceleration = acceleration_along(direction);
  block.rapid_rate = limit_by_axis(settings_.max_rate_mm_per_min, direction);
  if (line.feed.rapid) {
    block.programmed_rate = block.rapid_rate;
  } else {
    block.programmed_rate = line.feed.rate_mm_per_min;
    if (line.feed.inverse_time) block.programmed_rate *= block.millimeters;
  }
  return Added::Queued;
}

float Planner::unit_vector(AxisValues& vector) const {
  const auto axes = static_cast<std::size_t>(settings_.axes);
  float sum = 0.0F;
  for (std::size_t i = 0; i < axes; ++i) {
    const float part = vector[rules_.sums_from_last_axis ? axes - 1 - i : i];
    if (part != 0.0F) sum += part * part;
  }
  const float length = std::sqrt(sum);
  const float inverse = 1.0F / length;
  for (std::size_t axis = 0; axis < axes; ++axis) vector[axis] *= inverse;
  return length;
}

float Planner::limit_by_axis(const AxisValues& limits, const AxisValues& direction) const {
  float limit = kLargeValue;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings_.axes); ++axis) {
    if (direction[axis] != 0.0F) limit = std::min(limit, std::fabs(limits[axis] / direction[axis]));
  }
  return limit;
}

float Planner::acceleration_along(const AxisValues& direction) const {
  const float limit = limit_by_axis(stored_acceleration_, direction);
  return rules_.acceleration_converted_last ? limit * 3600.0F : limit;
}

float Planner::junction_speed_sqr(const AxisValues& direction) const {
  const auto axes = static_cast<std::size_t>(settings_.axes);
  const bool wide = rules_.float_rule == FloatRule::DoubleLiterals;
  AxisValues turn{};
  float cos_theta = 0.0F;
  for (std::size_t i = 0; i < axes; ++i) {
    const std::size_t axis = rules_.sums_from_last_axis ? axes - 1 - i : i;
    cos_theta -= previous_direction_[axis] * direction[axis];
    turn[axis] = direction[axis] - previous_direction_[axis];
  }
  if (wide ? static_cast<double>(cos_theta) > kStraightWide : cos_theta > kStraight) return 0.0F;
  if (wide ? static_cast<double>(cos_theta) < -kStraightWide : cos_theta < -kStraight) return kLargeValue;
  (void)unit_vector(turn);
  const float acceleration = acceleration_along(turn);
  const float deviation = settings_.junction_deviation_mm;
  return wide ? junction_limit<double>(cos_theta, acceleration, deviation)
              : junction_limit<float>(cos_theta, acceleration, deviation);
}

float Planner::nominal_speed(const PlannedBlock& block) const {
  float rate = block.programmed_rate;
  if (block.feed.per_revolution || block.feed.synchronized) rate *= spindle_rpm_;
  if (block.feed.rapid) {
    rate = scaled_by_percent(rules_.float_rule, rate, rapid_percent_);
  } else {
    if (!block.feed.no_override && !(rules_.override_caps_first && feed_percent_ == 100)) {
      if (rules_.override_caps_first) rate = std::min(rate, block.rapid_rate);
      rate = scaled_by_percent(rules_.float_rule, rate, feed_percent_);
    }
    rate = std::min(rate, block.rapid_rate);
  }
  return rate > rules_.minimum_rate_mm_per_min ? rate : rules_.minimum_rate_mm_per_min;
}

void Planner::limit_entry(PlannedBlock& block, float nominal, float previous_nominal) {
  const float slower = std::min(nominal, previous_nominal);
  block.max_entry_speed_sqr = std::min(slower * slower, block.max_junction_speed_sqr);
}

void Planner::recalculate() {
  if (before(head_) == planned_) return;
  reverse_pass();
  forward_pass();
}

void Planner::reverse_pass() {
  int index = before(head_);
  PlannedBlock* current = &ring_[slot(index)];
  current->entry_speed_sqr =
      std::min(current->max_entry_speed_sqr, 2.0F * current->acceleration * current->millimeters);
  index = before(index);
  if (index == planned_) {
    if (index == tail_) reread_preparing_block();
    return;
  }
  while (index != planned_) {
    const PlannedBlock& next = *current;
    current = &ring_[slot(index)];
    index = before(index);
    if (index == tail_) reread_preparing_block();
    if (current->entry_speed_sqr != current->max_entry_speed_sqr) {
      current->entry_speed_sqr = std::min(next.entry_speed_sqr + 2.0F * current->acceleration * current->millimeters,
                                          current->max_entry_speed_sqr);
    }
  }
}

void Planner::forward_pass() {
  const PlannedBlock* current = nullptr;
  PlannedBlock* next = &ring_[slot(planned_)];
  for (int index = after(planned_); index != head_; index = after(index)) {
    current = next;
    next = &ring_[slot(index)];
    // A block that accelerates all the way cannot be improved by anything that comes later, nor can those before it.
    if (current->entry_speed_sqr < next->entry_speed_sqr) {
      const float reachable = current->entry_speed_sqr + 2.0F * current->acceleration * current->millimeters;
      if (reachable < next->entry_speed_sqr) {
        next->entry_speed_sqr = reachable;
        planned_ = index;
      }
    }
    if (next->entry_speed_sqr == next->max_entry_speed_sqr) planned_ = index;
  }
}

void Planner::replan_all() {
  reread_preparing_block();
  planned_ = tail_;
  if (rules_.replan_needs_blocks && is_empty()) return;
  recalculate();
}

void Planner::set_overrides(int feed_percent, int rapid_percent) {
  if (feed_percent == feed_percent_ && rapid_percent == rapid_percent_) return;
  feed_percent_ = feed_percent;
  rapid_percent_ = rapid_percent;
  limit_all_entries();
}

void Planner::set_spindle_rpm(float rpm) {
  if (rpm == spindle_rpm_) return;
  spindle_rpm_ = rpm;
  for (int index = tail_; index != head_; index = after(index)) {
    const gcode::Feed& feed = ring_[slot(index)].feed;
    if (feed.per_revolution || feed.synchronized) return limit_all_entries();
  }
}

void Planner::limit_all_entries() {
  if (rules_.replan_needs_blocks && is_empty()) return;
  float previous = kLargeValue;
  for (int index = tail_; index != head_; index = after(index)) {
    PlannedBlock& block = ring_[slot(index)];
    const float nominal = nominal_speed(block);
    limit_entry(block, nominal, previous);
    previous = nominal;
  }
  previous_nominal_ = previous;
  replan_all();
}

AxisValues Planner::position_mm() const {
  AxisValues mm{};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings_.axes); ++axis) {
    mm[axis] = static_cast<float>(position_[axis]) / settings_.steps_per_mm[axis];
  }
  return mm;
}

void Planner::sync_position(const AxisSteps& steps) {
  position_ = steps;
}

void Planner::clear() {
  head_ = tail_ = planned_ = 0;
  previous_direction_ = {};
  previous_nominal_ = 0.0F;
  preparing_ = nullptr;
}

float Planner::exit_speed_sqr() const {
  const int next = after(tail_);
  return next == head_ ? 0.0F : ring_[slot(next)].entry_speed_sqr;
}

void Planner::discard_front() {
  if (is_empty()) return;
  if (tail_ == planned_) planned_ = after(tail_);
  tail_ = after(tail_);
}

void Planner::reread_preparing_block() {
  if (preparing_ == nullptr) return;
  profile_changed_ = true;
  preparing_->entry_speed_sqr = prepared_speed_ * prepared_speed_;
  preparing_ = nullptr;
}

}  // namespace kerf::motion
