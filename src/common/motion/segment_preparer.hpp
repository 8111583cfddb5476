#pragma once
// Cuts planned blocks into segments of constant step rate.

#include <array>
#include <cstdint>
#include <optional>

#include "common/motion/planner.hpp"

namespace kerf::motion {

/// What the step interrupt needs to know about a block; outlives the planned block, which leaves the queue when its
/// last segment is prepared.
struct StepBlock {
  /// Counts up with each block; 0 is none.
  std::uint32_t id = 0;
  std::uint32_t source_line = 0;
  AxisSteps steps{};
  std::uint32_t step_events = 0;
  AxisMask negative_axes = 0;
  bool is_backlash = false;
  bool rapid = false;
  bool laser_dynamic = false;
  std::int32_t line_number = 0;
  float length_mm = 0;
  float programmed_rate = 0;
};

/// A stretch of constant step rate.
struct Segment {
  std::uint32_t block_id = 0;
  /// Step interrupts in the segment.
  std::uint32_t ticks = 0;
  /// Adaptive smoothing: an interrupt advances the motion by 2^-smoothing of a step of the fastest axis.
  std::uint8_t smoothing = 0;
  bool is_decelerating = false;
  bool ends_block = false;
  /// Timer counts between interrupts.
  std::uint64_t counts_per_tick = 0;
  float end_speed = 0;
  /// Laser power in M4 mode, as spindle speed without overrides.
  float dynamic_rpm = 0;
};

/// Prepares segments from the planner's front block as the firmwares do (gnea/grbl stepper.c st_prep_buffer;
/// motion.md 1.3): every segment takes about 10 ms, holds at least one step, and follows the ramps of the block's speed
/// profile. Same floats, same order.
class SegmentPreparer {
 public:
  SegmentPreparer(Planner& planner, const MotionRules& rules);

  /// The next segment; nothing when the queue is empty or the motion has come to its planned end.
  std::optional<Segment> next();
  /// True when next() has something to work on.
  [[nodiscard]] bool has_work() const;

  /// Normal operation from here on: cycle start and resume.
  void run();
  /// From the next segment on decelerate to rest.
  void begin_hold();
  /// As begin_hold(), but decelerating from `speed`, as if the segments after it had never been prepared.
  void begin_hold_at(float speed);
  [[nodiscard]] bool is_holding() const { return holding_; }
  /// The hold came to rest: what remains is planned anew from there.
  void finish_hold();

  /// The planner's system motion instead of its queue; `keeps_block` saves a held block for end_system_motion().
  /// `ends_block`: a block of the queue that is under preparation is executed to its end first, and if it is, that was
  /// the system motion (grblHAL).
  void begin_system_motion(bool keeps_block, bool ends_block);
  void end_system_motion();
  [[nodiscard]] bool in_system_motion() const { return system_motion_; }

  void reset();

  [[nodiscard]] const StepBlock& block(std::uint32_t id) const { return step_blocks_[id % kStepBlocks]; }
  /// Speed at the end of the last prepared segment, mm/min.
  [[nodiscard]] float speed() const { return planner_.prepared_speed_; }

 private:
  /// More than the segments that can wait, so that a block's entry lives as long as a segment refers to it.
  static constexpr std::size_t kStepBlocks = 32;

  enum class Ramp : std::uint8_t { Accelerate, Cruise, Decelerate, DecelerateToOverride };

  /// Progress inside one segment.
  struct Walk {
    float dt_limit;
    float dt = 0;
    float slice;
    float remaining_mm;
  };

  void load_steps(const PlannedBlock& block);
  template <class Wide>
  void compute_profile(PlannedBlock& block);
  void compute_hold_profile(const PlannedBlock& block, float inverse_2a);
  template <class Wide>
  [[nodiscard]] Walk walk_ramps(const PlannedBlock& block);
  template <class Wide>
  void advance_ramp(const PlannedBlock& block, Walk& walk);
  template <class Wide>
  void slow_to_override(const PlannedBlock& block, Walk& walk);
  std::optional<Segment> segment_from(PlannedBlock& block, const Walk& walk);
  void set_rate(Segment& segment, std::uint32_t steps, float minutes_per_step) const;
  void end_motion();

  Planner& planner_;
  MotionRules rules_;
  /// Timer counts per step below which no smoothing, or level 1 or 2 at most, applies.
  std::array<std::uint32_t, 3> smoothing_counts_{};
  float timer_counts_per_min_ = 0;
  float segment_min_ = 0;

  std::array<StepBlock, kStepBlocks> step_blocks_{};
  std::uint32_t last_id_ = 0;

  bool holding_ = false;
  bool system_motion_ = false;
  bool motion_ended_ = false;
  bool keeps_block_ = false;
  bool next_block_keeps_decelerating_ = false;
  bool block_is_partial_ = false;
  /// The last segment had no step and left everything as it was, as all after it would: a distance so long that 32 bits
  /// lose what a segment takes off it.
  bool stuck_ = false;

  /// Step bookkeeping of the block in preparation.
  struct Steps {
    std::uint32_t block_id = 0;
    float remaining = 0;
    float per_mm = 0;
    float dt_remainder = 0;
  };
  Steps steps_;
  Steps kept_steps_;
  float least_mm_ = 0;
  float inverse_rate_ = 0;

  Ramp ramp_ = Ramp::Accelerate;
  /// All distances are measured from the end of the block.
  float profile_end_mm_ = 0;
  float accelerate_until_mm_ = 0;
  float decelerate_after_mm_ = 0;
  float top_speed_ = 0;
  float exit_speed_ = 0;
};

}  // namespace kerf::motion
