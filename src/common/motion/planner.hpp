#pragma once
// The look-ahead planner: straight lines become blocks with entry speeds that every later block can still stop from.

#include <cstdint>
#include <vector>

#include "common/gcode/action.hpp"
#include "common/motion/rules.hpp"

namespace kerf::motion {

/// One straight line for the planner.
struct PathLine {
  AxisValues target_mm{};
  gcode::Feed feed;
  /// Line of the program, for reports only.
  std::uint32_t source_line = 0;
  /// Backlash take-up: the motors move, the reported position does not.
  bool is_backlash = false;
};

/// A planned block; distances shrink while its segments are prepared.
struct PlannedBlock {
  AxisSteps steps{};
  std::uint32_t step_events = 0;
  AxisMask negative_axes = 0;
  float entry_speed_sqr = 0;
  float max_entry_speed_sqr = 0;
  float max_junction_speed_sqr = 0;
  float acceleration = 0;
  /// Distance that is not yet prepared, mm.
  float millimeters = 0;
  /// Whole length, mm.
  float length_mm = 0;
  float rapid_rate = 0;
  float programmed_rate = 0;
  gcode::Feed feed;
  std::uint32_t source_line = 0;
  bool is_backlash = false;
};

/// Plans lines as the three firmwares do (gnea/grbl planner.c; motion.md 1.1 and 1.2), in 32-bit floats and in their
/// order of operations. Holds a bounded queue; the segment preparer takes blocks from its front.
class Planner {
 public:
  enum class Added : std::uint8_t {
    Queued,
    /// The line is shorter than half a step on every axis: no block, no time.
    Dropped,
  };

  Planner(const MotionRules& rules, const MotionSettings& settings);

  [[nodiscard]] bool is_full() const { return count_ == capacity_; }
  [[nodiscard]] bool is_empty() const { return count_ == 0; }
  [[nodiscard]] int free_blocks() const { return capacity_ - count_; }
  [[nodiscard]] int block_count() const { return count_; }

  /// Adds a line and plans anew. The queue must not be full.
  Added plan(const PathLine& line);

  /// Homing and parking: plans a line from `start` beside the queue, from rest to rest; Executor::start_system_motion
  /// calls it.
  Added plan_system_motion(const PathLine& line, const AxisSteps& start);

  /// Percent, already limited to the firmware's range; all queued blocks are planned anew.
  void set_overrides(int feed_percent, int rapid_percent);
  void set_feed_override(int percent) { set_overrides(percent, rapid_percent_); }
  void set_rapid_override(int percent) { set_overrides(feed_percent_, percent); }
  [[nodiscard]] int feed_override() const { return feed_percent_; }
  [[nodiscard]] int rapid_override() const { return rapid_percent_; }

  /// Where the queued motion ends.
  [[nodiscard]] const AxisSteps& position_steps() const { return position_; }
  [[nodiscard]] AxisValues position_mm() const;
  /// After motion that the planner did not see whole (homing, probe, cancelled jog).
  void sync_position(const AxisSteps& steps);
  /// Drops all blocks and forgets the previous direction (firmware's reset); overrides stay.
  void clear();

  /// Takes over changed `$` settings for lines planned from now on. `planner_blocks` only counts at construction.
  void set_settings(const MotionSettings& settings);
  [[nodiscard]] const MotionSettings& settings() const { return settings_; }
  [[nodiscard]] const MotionRules& rules() const { return rules_; }

  /// Oldest block: the one whose segments are being prepared. Null when empty.
  [[nodiscard]] const PlannedBlock* current() const { return is_empty() ? nullptr : &blocks_[tail_]; }

 private:
  friend class SegmentPreparer;

  MotionRules rules_;
  MotionSettings settings_;
  std::vector<PlannedBlock> blocks_;
  int capacity_;
  int tail_ = 0;
  int count_ = 0;
  int feed_percent_ = 100;
  int rapid_percent_ = 100;
  AxisSteps position_{};
};

}  // namespace kerf::motion
