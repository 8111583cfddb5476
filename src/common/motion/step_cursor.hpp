#pragma once
// Where the motors are, from how far the step interrupt has come in its block.

#include <cstdint>

#include "common/motion/segment_preparer.hpp"

namespace kerf::motion {

/// Follows the step interrupt through a block without stepping. Bresenham counters start at half the event count and an
/// axis steps when its counter exceeds it, so the steps of an axis are a function of progress alone, whatever the
/// smoothing levels were. Progress is counted in eighths of a step of the fastest axis, the finest smoothing.
class StepCursor {
 public:
  static constexpr unsigned kFinestSmoothing = 3;

  /// Progress of one interrupt at a smoothing level.
  [[nodiscard]] static std::int64_t progress_per_tick(std::uint8_t smoothing) { return 8 >> smoothing; }

  /// Starts a block where the last one ended; `block` must not change while it is followed.
  void enter(const StepBlock& block);
  void advance(std::int64_t progress) { progress_ += progress; }
  /// True between a block's first step and reset(); the block may be complete.
  [[nodiscard]] bool is_in(std::uint32_t block_id) const { return block_.id == block_id && block_.id != 0; }
  /// Forgets the block and keeps the position.
  void leave();

  /// Reported position when the interrupt is `ahead` further.
  [[nodiscard]] AxisSteps position(std::int64_t ahead = 0) const;
  /// Motor position: without frozen axes, with backlash take-up.
  [[nodiscard]] AxisSteps motors(std::int64_t ahead = 0) const;

  /// How much further the interrupt must come until the motor of `axis` reaches `steps`: 0 if it is there or beyond
  /// (`above`: at or above it), negative if this block does not get there.
  [[nodiscard]] std::int64_t progress_to(std::size_t axis, std::int32_t steps, bool above) const;

  void set_position(const AxisSteps& steps);
  void set_motors(const AxisSteps& steps);
  /// Motors of `axes` stop where they are `ahead` from here; the others move.
  void freeze(AxisMask axes, std::int64_t ahead = 0);
  [[nodiscard]] AxisMask frozen() const { return frozen_; }

  [[nodiscard]] const StepBlock& block() const { return block_; }

 private:
  static constexpr std::size_t kAxes = kMaxAxes;

  [[nodiscard]] std::int32_t moved(std::size_t axis, std::int64_t progress) const;
  [[nodiscard]] bool is_frozen(std::size_t axis) const { return ((frozen_ >> axis) & 1U) != 0; }

  StepBlock block_;
  std::int64_t progress_ = 0;
  /// At progress 0 of the block.
  AxisSteps position_base_{};
  AxisSteps motor_base_{};
  AxisSteps frozen_at_{};
  AxisMask frozen_ = 0;
};

}  // namespace kerf::motion
