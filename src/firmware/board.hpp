#pragma once
// What the parts of one controller share, as the firmware's global variables do: settings, parser, motion, state.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "common/gcode/interpreter.hpp"
#include "common/motion/executor.hpp"
#include "common/motion/planner.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "common/vocabulary/messages.hpp"
#include "firmware/backlash.hpp"
#include "firmware/board_facts.hpp"
#include "firmware/card_slot.hpp"
#include "firmware/equipment.hpp"
#include "firmware/file_job.hpp"
#include "firmware/motion_log.hpp"
#include "firmware/outbox.hpp"
#include "firmware/personality.hpp"
#include "firmware/ports.hpp"
#include "firmware/settings_store.hpp"
#include "firmware/slow_memory.hpp"
#include "firmware/spindle_encoder.hpp"
#include "firmware/step.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/workcell.hpp"
#include "firmware/ymodem.hpp"

namespace kerf::firmware {

using vocabulary::AxisMask;
using vocabulary::AxisSteps;
using vocabulary::AxisValues;

/// Spindle and coolant outputs as they are switched right now.
struct Accessories {
  gcode::SpindleDirection spindle = gcode::SpindleDirection::Off;
  float programmed_rpm = 0;
  bool flood = false;
  bool mist = false;

  bool operator==(const Accessories&) const = default;
  [[nodiscard]] bool is_spinning() const { return spindle != gcode::SpindleDirection::Off; }
};

/// Override percentages, and which of them the program lets act (grblHAL M48 to M53).
struct OverrideState {
  int feed = 100;
  int rapid = 100;
  int spindle = 100;
  bool feed_acts = true;
  bool spindle_acts = true;
  bool feed_hold_acts = true;
  bool parking_acts = true;
};

/// Switches that a program run looks at (grblHAL).
struct Switches {
  bool block_delete = false;
  bool optional_stop_disabled = false;
  bool single_block = false;
};

/// Fields that the next status report owes, and the counters that bring two of them back (protocol.md 3.4).
struct ReportDebts {
  bool everything = false;
  bool work_offset = false;
  bool work_coordinate_system = false;
  bool overrides = false;
  bool accessories = false;
  bool scaling = false;
  bool mpg = false;
  bool homed = false;
  bool tool = false;
  bool tool_reference = false;
  bool tool_offset = false;
  bool input_result = false;
  bool cycle_start_pressed = false;
  int override_counter = 0;
  int work_offset_counter = 0;
};

enum class DoorPhase : std::uint8_t { Closed, Ajar, Retracting, Resuming };

/// A message that appears when its line's first block begins (grblHAL, T:33).
struct MotionMessage {
  std::uint32_t block = 0;
  std::string text{};
};

/// One controller's shared memory. The parts (Cycle, Foreground, Reporter, ...) change it; it decides nothing itself.
struct Board {
  explicit Board(const Personality& owner, StoredState remembered, Equipment fitted = {});
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  const Personality& personality;
  StoredState stored;
  SettingsStore settings;
  std::vector<std::string> rejected_settings;
  Outbox outbox;
  gcode::Interpreter interpreter;
  BoardFacts facts{*this};
  motion::Planner planner;
  motion::Executor executor;
  Workcell workcell;
  Equipment equipment;
  CardSlot slot;
  FileJob job;
  YModem upload;

  /// The last instant that went in.
  Instant now{};
  unsigned stored_revision = 0;
  int alarm = 0;
  MachineState state = MachineState::Idle;
  DoorPhase door = DoorPhase::Closed;
  AxisMask homed = 0;
  AxisMask tool_reference_axes = 0;
  bool cold_start = true;
  bool hold_complete = false;
  /// Nothing but a reset helps.
  bool critical = false;
  /// The pendant is in command (grblHAL sys.mpg_mode).
  bool pendant_commands = false;
  /// Between two `%` (grblHAL gc_state.file_run).
  bool in_demarcated_program = false;
  bool probing = false;
  bool auto_reporting = false;
  /// An M6 waits for the operator, or moves the machine meanwhile.
  bool changes_tool = false;
  bool tool_acknowledged = false;
  /// grblHAL tells its status at each start of motion in a tool change.
  bool owes_status = false;
  /// Result of the last M66: what it read, -1 if it waited in vain.
  std::optional<int> input_result;
  Ports ports;
  SlowMemory memory;
  SpindleEncoder encoder;
  /// The control inputs and limits that acted last, for `$LEV`.
  std::string last_control;
  AxisMask last_limits = 0;
  bool position_lost = false;
  AxisValues home_position_mm{};
  AxisValues tool_reference_mm{};

  Accessories accessories;
  OverrideState overrides;
  Switches switches;
  ReportDebts report;
  std::deque<MotionMessage> motion_messages;
  /// G51 factors when the status report last told which axes are scaled.
  AxisValues last_scale_factors = gcode::ParserState{}.scale_factor;
  /// Blocks planned so far; a block's number is its motion::PathLine::source_line.
  std::uint32_t blocks_planned = 0;
  /// Targets of the blocks that may still be queued, by number.
  std::vector<AxisValues> block_targets_mm;

  /// Lines that were read since power-on, or since the motion log began.
  std::uint32_t lines_read = 0;
  /// The same without `$` lines and empty ones.
  std::uint32_t blocks_begun = 0;
  Backlash backlash;
  /// Kept only if the owner asked for it.
  std::optional<MotionLog> motion_log;

  /// The main loop has no time for anything new before.
  Instant busy_until{};

  /// A busy wait holds the main loop until then.
  Instant locked_until{};
  [[nodiscard]] bool is_locked() const { return executor.is_locking() || now < locked_until; }

  /// From now to the `passes`-th pass of the main loop after the one that sees what is now. Passes lie on a grid from
  /// time zero.
  [[nodiscard]] Duration until_pass(int passes) const;

  void be_busy(int passes) { busy_until = std::max(busy_until, now) + passes * personality.loop.pass; }
  /// Queues one line; the planner must have room.
  void plan(const AxisValues& target_mm, const gcode::Feed& feed);
  /// Where the move ends that takes up the play of axes that turn round on the way to `target_mm`, if there is any.
  [[nodiscard]] std::optional<AxisValues> note_turn(const AxisValues& target_mm);
  /// Queues that move; it is not counted as a change of position.
  void plan_take_up(const AxisValues& target_mm, const gcode::Feed& feed);
  void say(const protocol::Message& message);
  void say(vocabulary::FeedbackText text);
  /// State Alarm; false if this alarm was in force already and is not printed again.
  bool raise_alarm(vocabulary::AlarmCode code);

  /// How long the firmware stands still after the outputs were switched from what they were to `wanted`.
  [[nodiscard]] Duration switching_pause(const Accessories& wanted, bool coolant_word) const;
  [[nodiscard]] bool reports(vocabulary::ReportBit bit) const;
  [[nodiscard]] AxisSteps steps() const { return executor.steps_at(now); }
  [[nodiscard]] AxisValues position_mm() const;
  /// Motor steps nearest to a place in mm.
  [[nodiscard]] AxisSteps to_steps(const AxisValues& mm) const;
  [[nodiscard]] AxisValues to_mm(const AxisSteps& steps) const;
  [[nodiscard]] const Workcell::Geometry& geometry() const { return geometry_; }
  [[nodiscard]] bool guards_hard_limits() const { return guards_hard_limits_; }
  /// `$20`; asked for each block, so it is not looked up then.
  [[nodiscard]] bool guards_soft_limits() const { return guards_soft_limits_; }
  [[nodiscard]] AxisMask limits() const;
  [[nodiscard]] bool probe_triggered() const;
  [[nodiscard]] AxisMask all_axes() const { return static_cast<AxisMask>((1U << settings.axes()) - 1U); }
  /// Axes that some homing cycle homes.
  [[nodiscard]] AxisMask homing_axes() const;
  [[nodiscard]] std::vector<AxisMask> homing_cycles() const;
  /// False if `target` leaves the travel that `$20` guards.
  [[nodiscard]] bool is_within_travel(const AxisValues& target_mm) const;
  /// Where an axis' homing switch is: zero, or where its setting says (Rabbit).
  [[nodiscard]] float switch_position_mm(int axis) const;
  /// The nearest target within travel (grblHAL `$40`).
  [[nodiscard]] AxisValues clipped_to_travel(const AxisValues& target_mm) const;
  /// `mm` on an axis, cut to its travel if it is homed.
  [[nodiscard]] float within_travel(int axis, float mm) const;
  /// A wait as long as a setting says.
  [[nodiscard]] Dwell delay_step(int delay_setting) const;
  /// Spindle speed with override and limits; 0 when off.
  [[nodiscard]] float spindle_rpm() const;

  /// Speeds, overrides or the spindle's load may have changed: the encoder and what follows it take notice.
  void follow_spindle();
  /// The encoder measures the speed that is asked for, as closely as `$340` wants it.
  [[nodiscard]] bool is_spindle_at_speed() const;

  /// Parser and planner continue from where the machine stands.
  void sync_position();
  /// Drops all motion and stops dead where the machine stands.
  void flush_motion();
  /// Motion and interpreter follow the settings.
  void apply_settings();
  void apply_overrides();
  void set_accessories(const Accessories& wanted);

  /// Status fields that a change makes due.
  void owe_work_offset();
  void owe_overrides();
  void owe_accessories();

  /// Writes settings and offsets into `stored`.
  void store_settings(int bytes = kWholeMemory);
  void store_offset(gcode::StoredOffset which);
  void store_tool(int tool);
  /// Offsets and tool table as stored.
  void load_offsets();

 private:
  static constexpr int kWholeMemory = 80;

  void plan_line(const motion::PathLine& line);

  Workcell::Geometry geometry_;
  bool guards_hard_limits_ = false;
  bool guards_soft_limits_ = false;
};

/// "G54" for the first offset, and so on.
[[nodiscard]] std::string_view name_of(gcode::StoredOffset which);

}  // namespace kerf::firmware
