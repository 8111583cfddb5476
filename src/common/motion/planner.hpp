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

  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;

  [[nodiscard]] bool is_full() const { return after(head_) == tail_; }
  [[nodiscard]] bool is_empty() const { return head_ == tail_; }
  [[nodiscard]] int block_count() const { return head_ >= tail_ ? head_ - tail_ : head_ - tail_ + ring_size(); }
  [[nodiscard]] int free_blocks() const { return ring_size() - 1 - block_count(); }

  /// Adds a line and plans anew. The queue must not be full.
  Added plan(const PathLine& line);

  /// Homing and parking: plans a line from `start` beside the queue, from rest to rest; Executor::start_system_motion
  /// calls it.
  Added plan_system_motion(const PathLine& line, const AxisSteps& start);

  /// Percent, already limited to the firmware's range; all queued blocks are planned anew.
  void set_overrides(int feed_percent, int rapid_percent);
  /// What the encoder of the spindle measures; motions that follow it are planned anew.
  void set_spindle_rpm(float rpm);
  void set_feed_override(int percent) { set_overrides(percent, rapid_percent_); }
  void set_rapid_override(int percent) { set_overrides(feed_percent_, percent); }
  [[nodiscard]] int feed_override() const { return feed_percent_; }
  [[nodiscard]] int rapid_override() const { return rapid_percent_; }

  /// Where the queued motion ends.
  [[nodiscard]] const AxisSteps& position_steps() const { return position_; }
  [[nodiscard]] AxisValues position_mm() const;
  /// After motion that the planner did not see whole (homing, probe, cancelled jog).
  void sync_position(const AxisSteps& steps);
  /// Drops all blocks and forgets the previous direction (firmware's reset); position and overrides stay.
  void clear();

  /// The line that plan_system_motion() took last.
  [[nodiscard]] const PlannedBlock& system_motion() const { return ring_[slot(head_)]; }

  /// Takes the oldest block out, as its last segment does; for those who plan without moving.
  void discard_front();

  /// Takes over changed `$` settings for lines planned from now on. `planner_blocks` only counts at construction.
  void set_settings(const MotionSettings& settings);
  [[nodiscard]] const MotionSettings& settings() const { return settings_; }
  [[nodiscard]] const MotionRules& rules() const { return rules_; }

  /// Oldest block: the one whose segments are being prepared. Null when empty.
  [[nodiscard]] const PlannedBlock* current() const { return is_empty() ? nullptr : &ring_[slot(tail_)]; }
  /// Block number `index` from the oldest, below block_count().
  [[nodiscard]] const PlannedBlock& at(int index) const { return ring_[slot((tail_ + index) % ring_size())]; }

 private:
  friend class SegmentPreparer;

  [[nodiscard]] static std::size_t slot(int index) { return static_cast<std::size_t>(index); }
  [[nodiscard]] int ring_size() const { return static_cast<int>(ring_.size()); }
  [[nodiscard]] int after(int index) const { return index + 1 == ring_size() ? 0 : index + 1; }
  [[nodiscard]] int before(int index) const { return index == 0 ? ring_size() - 1 : index - 1; }

  Added fill_block(PlannedBlock& block, const PathLine& line, const AxisSteps& start, AxisSteps& target,
                   AxisValues& direction) const;
  [[nodiscard]] float unit_vector(AxisValues& vector) const;
  [[nodiscard]] float limit_by_axis(const AxisValues& limits, const AxisValues& direction) const;
  [[nodiscard]] float acceleration_along(const AxisValues& direction) const;
  [[nodiscard]] float junction_speed_sqr(const AxisValues& direction) const;
  [[nodiscard]] float nominal_speed(const PlannedBlock& block) const;
  static void limit_entry(PlannedBlock& block, float nominal, float previous_nominal);
  void recalculate();
  void reverse_pass();
  void forward_pass();
  void replan_all();
  void limit_all_entries();

  // For the segment preparer.
  [[nodiscard]] PlannedBlock& front() { return ring_[slot(tail_)]; }
  [[nodiscard]] PlannedBlock& system_block() { return ring_[slot(head_)]; }
  [[nodiscard]] float exit_speed_sqr() const;
  void reread_preparing_block();

  MotionRules rules_;
  MotionSettings settings_;
  /// Acceleration as the firmware stores it: mm/min², or mm/s² where it converts last.
  AxisValues stored_acceleration_{};
  /// One place more than blocks: the free one at `head_` takes system motions.
  std::vector<PlannedBlock> ring_;
  int head_ = 0;
  int tail_ = 0;
  /// First block that later blocks can still change.
  int planned_ = 0;
  int feed_percent_ = 100;
  int rapid_percent_ = 100;
  float spindle_rpm_ = 0;
  AxisSteps position_{};
  AxisValues previous_direction_{};
  float previous_nominal_ = 0;

  /// The block whose segments are being prepared, if its speed profile is up to date; null makes the preparer read it
  /// again.
  PlannedBlock* preparing_ = nullptr;
  /// Speed at the end of the last prepared segment.
  float prepared_speed_ = 0;
  /// The block in preparation was re-planned in mid-block.
  bool profile_changed_ = false;
};

}  // namespace kerf::motion
