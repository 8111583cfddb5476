#include "common/motion/step_cursor.hpp"

namespace kerf::motion {

void StepCursor::enter(const StepBlock& block) {
  leave();
  block_ = block;
}

void StepCursor::leave() {
  if (block_.id == 0) return;
  position_base_ = position();
  for (std::size_t axis = 0; axis < kAxes; ++axis) motor_base_[axis] += moved(axis, progress_);
  block_.id = 0;
  block_.step_events = 0;
  progress_ = 0;
}

std::int32_t StepCursor::moved(std::size_t axis, std::int64_t progress) const {
  const std::int64_t steps = block_.steps[axis];
  if (steps == 0 || block_.step_events == 0) return 0;
  const std::int64_t events = std::int64_t{block_.step_events} << kFinestSmoothing;
  const auto done = static_cast<std::int32_t>((events / 2 + progress * steps - 1) / events);
  return ((block_.negative_axes >> axis) & 1U) != 0 ? -done : done;
}

AxisSteps StepCursor::position(std::int64_t ahead) const {
  AxisSteps steps = position_base_;
  if (block_.is_backlash) return steps;
  for (std::size_t axis = 0; axis < kAxes; ++axis) steps[axis] += moved(axis, progress_ + ahead);
  return steps;
}

AxisSteps StepCursor::motors(std::int64_t ahead) const {
  AxisSteps steps = motor_base_;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    steps[axis] = is_frozen(axis) ? frozen_at_[axis] : steps[axis] + moved(axis, progress_ + ahead);
  }
  return steps;
}

std::int64_t StepCursor::progress_to(std::size_t axis, std::int32_t steps, bool above) const {
  const std::int32_t here = motors()[axis];
  if (above ? here >= steps : here <= steps) return 0;
  const bool goes_up = ((block_.negative_axes >> axis) & 1U) == 0;
  if (goes_up != above || is_frozen(axis) || block_.step_events == 0) return -1;
  const std::int64_t wanted = above ? std::int64_t{steps} - motor_base_[axis] : std::int64_t{motor_base_[axis]} - steps;
  const std::int64_t per_event = block_.steps[axis];
  if (wanted > per_event) return -1;
  // Smallest progress at which `wanted` steps are done, see moved().
  const std::int64_t events = std::int64_t{block_.step_events} << kFinestSmoothing;
  return (events * wanted - events / 2 + 1 + per_event - 1) / per_event - progress_;
}

void StepCursor::set_position(const AxisSteps& steps) {
  const AxisSteps now = position();
  for (std::size_t axis = 0; axis < kAxes; ++axis) position_base_[axis] += steps[axis] - now[axis];
}

void StepCursor::set_motors(const AxisSteps& steps) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    frozen_at_[axis] = steps[axis];
    motor_base_[axis] = steps[axis] - moved(axis, progress_);
  }
}

void StepCursor::freeze(AxisMask axes, std::int64_t ahead) {
  const AxisSteps now = motors(ahead);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const bool was_frozen = is_frozen(axis);
    if (was_frozen) motor_base_[axis] = frozen_at_[axis] - moved(axis, progress_ + ahead);
    frozen_at_[axis] = now[axis];
  }
  frozen_ = axes;
}

}  // namespace kerf::motion
