#pragma once
// Planned blocks become motion over time: segments are prepared, then stepped, with exact positions at any instant.

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "common/base/time.hpp"
#include "common/motion/planner.hpp"
#include "common/motion/segment_preparer.hpp"
#include "common/motion/step_cursor.hpp"

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
  /// When the motors came to rest: before the `$1` delay.
  Instant stopped_at{};
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
  void cycle_start(Instant now) { cycle_start(now, Duration::zero()); }
  /// The same, but the steppers wake only `after` a while (the main loop is still busy).
  void cycle_start(Instant now, Duration after);
  /// Decelerates to rest; HoldComplete follows. Also the first half of a motion cancel and jog cancel: after
  /// HoldComplete the caller clears planner and executor. Ignored unless Running.
  void begin_hold(Instant now);
  /// As begin_hold(), but drops prepared segments that do not slow down yet, where the firmware does so (grblHAL's
  /// 0x19); for a stop that is not resumed.
  void begin_stop(Instant now);
  /// Runs one line from where the machine is, from rest to rest, beside the queue; only at rest or held. MotionEnded
  /// follows, unless the line is Dropped. Homing skips the `$1` delay; parking keeps the held block for a later
  /// cycle_start().
  Planner::Added start_system_motion(Instant now, const PathLine& line, SystemMotion kind) {
    return start_system_motion(now, line, kind, Duration::zero());
  }
  /// The same, but the steppers wake only `after` a while.
  Planner::Added start_system_motion(Instant now, const PathLine& line, SystemMotion kind, Duration after);
  /// Stops dead and forgets all segments, thresholds and frozen axes; the position stays. The planner is the caller's.
  void reset(Instant now);

  void advance_to(Instant now);
  /// Fills the free segment places now, as firmware does each time before it plans a block: a block that stands alone
  /// and fits into them ends at rest, whatever is planned behind it.
  void prepare();
  /// The same at rest, where nothing starts it: a system motion then executes those segments first.
  void prepare_at_rest();
  /// Next instant at which anything can change for the owner: a segment place becomes free (so the planner may get
  /// room), a threshold is crossed, a block or the motion ends. kNever at rest.
  [[nodiscard]] Instant next_deadline() const;

  [[nodiscard]] ExecutorPhase phase() const;
  /// Reported position: steps that were decided up to and including `at`. `at` is not before the last advance_to() and
  /// not after next_deadline().
  [[nodiscard]] AxisSteps steps_at(Instant at) const;
  /// Where the motors are: without steps of frozen axes, with backlash take-up.
  [[nodiscard]] AxisSteps motor_steps_at(Instant at) const;
  /// The same, less what the last interrupt decided: its pulses go out with the next one.
  [[nodiscard]] AxisSteps pulsed_steps_at(Instant at) const;
  /// Sets the reported position (homing); motors keep theirs unless given.
  void set_position(const AxisSteps& steps);
  void set_motor_position(const AxisSteps& steps);

  /// The speed that firmware reports: at the end of the last prepared segment, up to 50 ms (90 ms) ahead. 0 at rest.
  [[nodiscard]] float speed_mm_per_min() const;
  /// Spindle speed that the executing segment asks for in laser M4 mode, overrides not applied.
  [[nodiscard]] std::optional<float> dynamic_rpm() const;

  /// How long a stop or a reset outside homing keeps Grbl's main program in a busy wait (`$1`); zero elsewhere, and
  /// with 255.
  [[nodiscard]] Duration lock_delay() const;
  /// The motors rest, and that wait is under way until MotionEnded or HoldComplete: lines and realtime commands lie
  /// still.
  [[nodiscard]] bool is_locking() const { return stage_ == Stage::Locking; }

  /// Reports a contact once, while moving. A threshold that is met already counts at the next step of the motion.
  void watch(const StepThreshold& threshold);
  void clear_watches();
  /// Homing: these motors no longer move, though the reported position counts on. Replaces the previous mask.
  void freeze_axes(AxisMask axes);

  /// The block under the step interrupt; null at rest.
  [[nodiscard]] const StepBlock* executing() const;

  [[nodiscard]] std::vector<ExecutorEvent> take_events();
  /// The same into a vector of the caller's, whose storage is used again.
  void take_events(std::vector<ExecutorEvent>& into);

 private:
  static constexpr std::size_t kMostSegments = 16;

  enum class Stage : std::uint8_t {
    Idle,
    /// Interrupts of the current segment are to come.
    Stepping,
    /// The segment's last interrupt is past, the next one loads a segment or finds none.
    Draining,
    /// Motors at rest, the interrupt waits for `$1` (Grbl).
    Locking,
  };

  /// A threshold and the timer count at which it will be seen if the motion goes on as prepared; kNotSeen if not in
  /// this segment.
  struct Watch {
    StepThreshold threshold;
    std::int64_t seen_at = kNotSeen;
  };
  static constexpr std::int64_t kNotSeen = INT64_MAX;

  [[nodiscard]] Instant instant_of(std::int64_t counts) const;
  [[nodiscard]] std::int64_t counts_at(Instant at) const;
  /// Interrupts of the current segment up to and including `counts`.
  [[nodiscard]] std::int64_t ticks_until(std::int64_t counts) const;
  [[nodiscard]] std::int64_t progress_until(Instant at) const;
  [[nodiscard]] std::int64_t next_count() const;
  [[nodiscard]] bool has_more_for_free_slots() const;
  [[nodiscard]] bool needs_refill() const;
  /// When the main loop's pass comes that fills what became free at `at`.
  [[nodiscard]] Instant pass_after(Instant at) const;
  [[nodiscard]] Instant refill_time() const { return refill_at_ == kNever ? pass_after(now_) : refill_at_; }
  /// As next_deadline(), with what only the executor itself has to do.
  [[nodiscard]] Instant next_step() const;

  void wake(Instant now);
  void refill();
  void run_next();
  void finish_segment();
  void load_or_stop();
  void report_finished_block(Instant at);
  void stop(Instant at);
  void place_watches();
  void place(Watch& watch) const;
  void report_watch(std::size_t index);

  Planner& planner_;
  MotionRules rules_;
  SegmentPreparer preparer_;
  StepCursor cursor_;

  std::array<Segment, kMostSegments> segments_{};
  std::size_t first_segment_ = 0;
  std::size_t segment_count_ = 0;

  Stage stage_ = Stage::Idle;
  bool held_ = false;
  SystemMotion system_kind_ = SystemMotion::Homing;
  Instant now_{};
  /// Timer counts are measured from the start of the motion; a count is `num_/den_` nanoseconds.
  Instant started_{};
  std::int64_t num_ = 1;
  std::int64_t den_ = 1;
  /// The segment that is being stepped: a copy, because its place is free from its last interrupt on.
  Segment current_;
  std::int64_t segment_start_ = 0;
  std::int64_t segment_end_ = 0;
  bool block_to_report_ = false;
  /// kNever: nothing has become free since the last filling.
  Instant refill_at_ = kNever;
  Instant stopped_at_{};
  Instant locked_until_{};

  std::vector<Watch> watches_;
  std::vector<ExecutorEvent> events_;
};

}  // namespace kerf::motion
