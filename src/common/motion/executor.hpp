#pragma once
// Planned blocks become motion over time: segments are prepared, then stepped, with exact positions at any instant.

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "common/base/time.hpp"
#include "common/motion/planner.hpp"

namespace kerf::motion {

/// A step count at which a switch or probe makes contact. Motor steps: axes that are frozen do not move.
struct StepThreshold {
  vocabulary::Axis axis = vocabulary::Axis::X;
  std::int32_t steps = 0;
  /// True: contact while the motor is at or above `steps`; false: at or below.
  bool above = true;
  /// True: the step interrupt looks (probe), one interrupt after the step; false: whoever polls sees it at once
  /// (switches).
  bool seen_by_step_interrupt = false;
  /// True: the axis' motor stops at the contact (homing).
  bool freezes_axis = false;

  bool operator==(const StepThreshold&) const = default;
};

/// The first step of a block was decided.
struct BlockStarted {
  Instant at;
  std::uint32_t block = 0;
  std::uint32_t source_line = 0;
  bool operator==(const BlockStarted&) const = default;
};
/// All steps of a block are done; `at` is when the next block may start.
struct BlockFinished {
  Instant at;
  std::uint32_t block = 0;
  std::uint32_t source_line = 0;
  float length_mm = 0;
  float programmed_rate_mm_per_min = 0;
  AxisSteps steps{};
  bool operator==(const BlockFinished&) const = default;
};
/// The stepper went idle without a hold. `at` includes the `$1` delay of Grbl.
struct MotionEnded {
  Instant at;
  bool system_motion = false;
  bool operator==(const MotionEnded&) const = default;
};
/// A hold came to rest; the rest of the motion is kept and cycle_start() resumes it.
struct HoldComplete {
  Instant at;
  bool operator==(const HoldComplete&) const = default;
};
/// A watched threshold was crossed; `steps` is the position at contact.
struct ThresholdCrossed {
  Instant at;
  StepThreshold threshold;
  AxisSteps steps{};
  bool operator==(const ThresholdCrossed&) const = default;
};
using ExecutorEvent = std::variant<BlockStarted, BlockFinished, MotionEnded, HoldComplete, ThresholdCrossed>;

enum class ExecutorPhase : std::uint8_t { Resting, Running, Decelerating, Held };
enum class SystemMotion : std::uint8_t { Homing, Parking };

/// Executes the planner's blocks in virtual time, segment by segment. Instants given to it never go back.
/// Owner's loop: advance_to(next_deadline()), take_events(), fill the planner if it has room, repeat.
class Executor {
 public:
  Executor(Planner& planner, const MotionRules& rules);

  /// Starts queued motion, or resumes after HoldComplete. With an empty queue a held executor just rests. Ignored while
  /// moving.
  void cycle_start(Instant now);
  /// Decelerates to rest; HoldComplete follows. Also the first half of a motion cancel and jog cancel: after
  /// HoldComplete the caller clears planner and executor. Ignored unless Running.
  void begin_hold(Instant now);
  /// Runs one line from where the machine is, from rest to rest, beside the queue; only at rest or held. MotionEnded
  /// follows, unless the line is Dropped. Homing skips the `$1` delay; parking keeps the held block for a later
  /// cycle_start().
  Planner::Added start_system_motion(Instant now, const PathLine& line, SystemMotion kind);
  /// Stops dead and forgets all segments, thresholds and frozen axes; the position stays. The planner is the caller's.
  void reset(Instant now);

  void advance_to(Instant now);
  /// Next instant at which anything can change for the owner: a segment place becomes free (so the planner may get
  /// room), a threshold is crossed, a block or the motion ends. kNever at rest.
  [[nodiscard]] Instant next_deadline() const;

  [[nodiscard]] ExecutorPhase phase() const;
  /// Reported position: steps that were decided up to and including `at`. `at` is not before the last advance_to() and
  /// not after next_deadline().
  [[nodiscard]] AxisSteps steps_at(Instant at) const;
  /// Where the motors are: without steps of frozen axes, with backlash take-up.
  [[nodiscard]] AxisSteps motor_steps_at(Instant at) const;
  /// Sets the reported position (homing); motors keep theirs unless given.
  void set_position(const AxisSteps& steps);
  void set_motor_position(const AxisSteps& steps);

  /// The speed that firmware reports: at the end of the last prepared segment, up to 50 ms (90 ms) ahead. 0 at rest.
  [[nodiscard]] float speed_mm_per_min() const;
  /// Spindle speed that the executing segment asks for in laser M4 mode, overrides not applied.
  [[nodiscard]] std::optional<float> dynamic_rpm() const;

  void watch(const StepThreshold& threshold);
  void clear_watches();
  /// Homing: these motors no longer move, though the reported position counts on. Replaces the previous mask.
  void freeze_axes(AxisMask axes);

  [[nodiscard]] std::vector<ExecutorEvent> take_events();
};

}  // namespace kerf::motion
