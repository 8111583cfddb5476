#pragma once
// Everything that Kerf believes about the machine at one instant, as one value.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/protocol/message.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "common/vocabulary/messages.hpp"

namespace kerf::machine {

/// Override percentages as the controller reports them (`Ov:feed,rapid,spindle`).
struct OverridePercentages {
  int feed = 100;
  int rapid = 100;
  int spindle = 100;
  bool operator==(const OverridePercentages&) const = default;
};
BOOST_DESCRIBE_STRUCT(OverridePercentages, (), (feed, rapid, spindle))

/// Result of the last probing move: where the probe touched (machine coordinates, mm), and whether it touched at all.
struct ProbeContact {
  std::vector<double> position_mm;
  bool touched = false;
  bool operator==(const ProbeContact&) const = default;
};
BOOST_DESCRIBE_STRUCT(ProbeContact, (), (position_mm, touched))

enum class SpindleTurn { Off, Clockwise, Counterclockwise };
BOOST_DESCRIBE_ENUM(SpindleTurn, Off, Clockwise, Counterclockwise)

/// What is switched on (`A:`).
struct Accessories {
  SpindleTurn spindle = SpindleTurn::Off;
  bool flood = false;
  bool mist = false;
  bool encoder_fault = false;
  bool tool_change_pending = false;
  /// Letters that Kerf does not know.
  std::string other{};
  bool operator==(const Accessories&) const = default;
};
BOOST_DESCRIBE_STRUCT(Accessories, (), (spindle, flood, mist, encoder_fault, tool_change_pending, other))

/// The inputs that are active (`Pn:`).
struct Inputs {
  /// Letters of the axes of which a limit switch is pressed: "XZ".
  std::string limits{};
  bool probe = false;
  bool probe_disconnected = false;
  bool door = false;
  bool feed_hold = false;
  bool cycle_start = false;
  bool reset = false;
  bool emergency_stop = false;
  bool motor_fault = false;
  bool motor_warning = false;
  bool block_delete = false;
  bool optional_stop_off = false;
  bool single_block = false;
  /// Letters that Kerf does not know, and Rabbit's macro buttons.
  std::string other{};
  bool operator==(const Inputs&) const = default;
};
BOOST_DESCRIBE_STRUCT(Inputs, (),
                      (limits, probe, probe_disconnected, door, feed_hold, cycle_start, reset, emergency_stop,
                       motor_fault, motor_warning, block_delete, optional_stop_off, single_block, other))

/// The probe in use (`P:`), and whether it is protected against a crash right now.
struct ProbeInUse {
  int number = 0;
  bool is_protected = false;
  bool operator==(const ProbeInUse&) const = default;
};
BOOST_DESCRIBE_STRUCT(ProbeInUse, (), (number, is_protected))

/// A spindle that runs beside the first one (`SPn:`).
struct FurtherSpindle {
  int number = 0;
  double rpm = 0;
  SpindleTurn turns = SpindleTurn::Off;
  std::optional<int> override_percent{};
  bool operator==(const FurtherSpindle&) const = default;
};
BOOST_DESCRIBE_STRUCT(FurtherSpindle, (), (number, rpm, turns, override_percent))

/// The modes in force, read from `[GC:]`. Words as the controller prints them; empty where it printed none.
struct ParserModes {
  std::string motion{};
  std::string work_coordinates{};
  std::string plane{};
  std::string units{};
  std::string distance{};
  std::string feed_mode{};
  std::string tool_length{};
  std::string spindle{};
  /// "M9", or "M7 M8".
  std::string coolant{};
  std::optional<double> feed_mm_per_min{};
  std::optional<double> spindle_rpm{};
  bool operator==(const ParserModes&) const = default;
};
BOOST_DESCRIBE_STRUCT(ParserModes, (),
                      (motion, work_coordinates, plane, units, distance, feed_mode, tool_length, spindle, coolant,
                       feed_mm_per_min, spindle_rpm))

/// Which axes know where they are.
struct Homing {
  /// All axes that have to be homed are. Grbl and Rabbit do not tell: there Kerf keeps account of `$H` and alarms.
  std::optional<bool> all{};
  /// Letters of the axes that are homed.
  std::optional<std::string> axes{};
  /// The controller itself says so.
  bool is_told = false;
  std::optional<std::vector<double>> home_position_mm{};
  bool operator==(const Homing&) const = default;
};
BOOST_DESCRIBE_STRUCT(Homing, (), (all, axes, is_told, home_position_mm))

struct ToolLength {
  /// One number, or one for each axis.
  std::optional<std::vector<double>> offset_mm{};
  /// A reference is set (`TLR:`), and its value where `$#` told it.
  std::optional<bool> reference_set{};
  std::optional<std::vector<double>> reference_mm{};
  bool operator==(const ToolLength&) const = default;
};
BOOST_DESCRIBE_STRUCT(ToolLength, (), (offset_mm, reference_set, reference_mm))

/// The controller's own card, and how far it is with the file that it runs.
struct Card {
  std::optional<bool> mounted{};
  std::optional<bool> detected{};
  std::optional<double> file_percent{};
  /// The file waits for a cycle start to run again (`SD:Pending`).
  bool file_waits = false;
  bool operator==(const Card&) const = default;
};
BOOST_DESCRIBE_STRUCT(Card, (), (mounted, detected, file_percent, file_waits))

/// `[MSG:...]`: what the controller or the program (`(MSG,...)`, `(PRINT,...)`) said to the operator.
struct OperatorMessage {
  vocabulary::FeedbackKind kind = vocabulary::FeedbackKind::Plain;
  /// The message, where it is one of the firmware's own.
  std::optional<vocabulary::FeedbackText> id{};
  std::string text{};
  Instant at{};
  bool operator==(const OperatorMessage&) const = default;
};
BOOST_DESCRIBE_STRUCT(OperatorMessage, (), (kind, id, text, at))

/// A value of the machine's state as last told. An empty optional means "never told", not zero. Positions hold one
/// number for each axis that the controller prints, always in mm (`$13` is undone by MachineModel).
struct Snapshot {
  vocabulary::MachineState state = vocabulary::MachineState::Unknown;
  std::optional<int> substate;
  /// The state as printed, where Kerf does not know it.
  std::string odd_state;

  /// Machine position, work position and the offset between them: work = machine - offset (protocol.md 11, rule 9).
  std::optional<std::vector<double>> machine_position_mm;
  std::optional<std::vector<double>> work_position_mm;
  std::optional<std::vector<double>> work_offset_mm;
  /// What is left of the block that is executing; empty when none is.
  std::optional<std::vector<double>> distance_to_go_mm;

  std::optional<int> planner_blocks_free;
  std::optional<int> rx_bytes_free;
  std::optional<long> line_number;
  std::optional<double> feed_mm_per_min;
  std::optional<double> spindle_rpm;
  std::optional<double> measured_rpm;
  std::optional<int> active_spindle;
  std::vector<FurtherSpindle> further_spindles;

  /// Letters of the active inputs (`Pn:`); empty when none is active.
  std::string pins;
  /// The same, by name; empty where this controller is set not to report them (`$10`), because then their absence means
  /// nothing.
  std::optional<Inputs> inputs;
  std::optional<OverridePercentages> overrides;
  std::optional<Accessories> accessories;
  /// Letters of the axes that G51 scales.
  std::string scaled_axes;
  std::optional<bool> diameter_mode;
  /// Result of the last M66; -1 on time-out.
  std::optional<int> input_result;

  std::optional<std::string> work_coordinate_system;
  std::optional<int> tool;
  ToolLength tool_length;
  Homing homing;

  /// A pendant has the machine (`MPG:1`): Kerf may read but sends no lines (protocol.md 1.5).
  bool pendant_in_control = false;
  /// File that the controller itself is running, as it says (`SD:`); empty when none.
  std::string controller_file;
  Card card;
  /// Period of reports that come unasked (`AR:`), ms; 0 when they are set up but switched off; empty when not offered.
  std::optional<int> auto_report_ms;

  /// Words of `[GC:]`, in printed order, and what they mean.
  std::vector<std::string> parser_words;
  ParserModes modes;
  /// A line was accepted since that may have changed them.
  bool parser_state_is_old = false;
  /// `[G54:]` … `[G59.3:]`, `[G28:]`, `[G30:]`, `[G92:]` in mm.
  std::map<std::string, std::vector<double>> offsets_mm;
  /// A line was accepted since that may have changed offsets, tool length or reference.
  bool offsets_are_old = false;
  std::optional<ProbeContact> probe;
  std::optional<ProbeInUse> probe_in_use;

  /// Last alarm that has not been cleared.
  std::optional<int> alarm_code;
  /// Only a reset helps (protocol.md 6.6).
  bool reset_required = false;
  /// `$13` is known; before that every `…_mm` is empty.
  bool units_are_known = false;
  /// The positions as they were told while their unit is not known; empty afterwards.
  std::optional<std::vector<double>> machine_position_unitless;
  std::optional<std::vector<double>> work_position_unitless;
  /// Positions are reported in inches (`$13=1`); Kerf has already converted them.
  bool reports_inches = false;

  /// `?`, `!` and `~` stay in `$` lines and comments (grblHAL `$39`=0, `RT-`); empty where nobody has said.
  std::optional<bool> texts_keep_realtime;

  /// Last messages for the operator, newest last, at most kMessagesKept.
  std::vector<OperatorMessage> messages;
  /// What the controller asks the operator to do, as long as it waits for it.
  std::string prompt;
  /// Fields of the last report that Kerf does not know.
  std::vector<protocol::UnknownField> other_fields;

  /// When the last status report came in. How stale the rest is, is now minus this.
  std::optional<Instant> reported_at;
  /// Number of status reports so far.
  std::uint64_t reports = 0;

  bool operator==(const Snapshot&) const = default;
};
BOOST_DESCRIBE_STRUCT(Snapshot, (),
                      (state, substate, odd_state, machine_position_mm, work_position_mm, work_offset_mm,
                       distance_to_go_mm, planner_blocks_free, rx_bytes_free, line_number, feed_mm_per_min, spindle_rpm,
                       measured_rpm, active_spindle, further_spindles, pins, inputs, overrides, accessories,
                       scaled_axes, diameter_mode, input_result, work_coordinate_system, tool, tool_length, homing,
                       pendant_in_control, controller_file, card, auto_report_ms, parser_words, modes,
                       parser_state_is_old, offsets_mm, offsets_are_old, probe, probe_in_use, alarm_code,
                       reset_required, units_are_known, machine_position_unitless, work_position_unitless,
                       reports_inches, texts_keep_realtime, messages, prompt, other_fields, reported_at, reports))

inline constexpr std::size_t kMessagesKept = 20;

}  // namespace kerf::machine
