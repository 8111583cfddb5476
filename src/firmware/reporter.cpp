#include "firmware/reporter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/text.hpp"
#include "common/gcode/modal_words.hpp"

namespace kerf::firmware {

using protocol::StatusReport;
using vocabulary::ReportBit;

namespace {

constexpr double kMmPerInch = 25.4;
constexpr std::array<std::string_view, 9> kWorkOffsets = {"G54", "G55",   "G56",   "G57",  "G58",
                                                          "G59", "G59.1", "G59.2", "G59.3"};

std::vector<std::string> parser_state_words(const Board& board) {
  constexpr int kParking = 41;
  constexpr unsigned kParkingOverride = 2;
  const gcode::ModalWordsStyle style = {.inches = board.settings.flag(setting::kReportInches),
                                        .axes = board.settings.axes(),
                                        .parking_override_control = board.personality.has_extended_settings &&
                                                                    board.settings.flag(kParking, kParkingOverride),
                                        .lathe = board.settings.is_lathe()};
  std::string text;
  gcode::append_modal_words(board.interpreter.state(), board.interpreter.offsets(), board.interpreter.rules(), style,
                            text);
  const auto parts = base::split(text, ' ');
  return {parts.begin(), parts.end()};
}

constexpr std::array kReportFlags = {&ReportDebts::work_offset,
                                     &ReportDebts::work_coordinate_system,
                                     &ReportDebts::overrides,
                                     &ReportDebts::accessories,
                                     &ReportDebts::scaling,
                                     &ReportDebts::mpg,
                                     &ReportDebts::homed,
                                     &ReportDebts::tool,
                                     &ReportDebts::tool_reference,
                                     &ReportDebts::tool_offset,
                                     &ReportDebts::cycle_start_pressed};

bool is_grblhal_like(const Board& board) {
  return board.personality.status.counts_changes;
}

}  // namespace

std::optional<int> substate_of(const Board& board) {
  switch (board.state) {
    case MachineState::Hold: return board.hold_complete ? vocabulary::kHoldComplete : vocabulary::kHoldDecelerating;
    case MachineState::Door:
      switch (board.door) {
        case DoorPhase::Closed: return vocabulary::kDoorClosedReady;
        case DoorPhase::Ajar: return vocabulary::kDoorOpen;
        case DoorPhase::Retracting: return vocabulary::kDoorRetracting;
        case DoorPhase::Resuming: return board.personality.realtime.door_resuming_substate;
      }
      return std::nullopt;
    case MachineState::Alarm:
      if (board.alarm != 0 && (board.report.everything || board.reports(ReportBit::AlarmSubstate))) return board.alarm;
      return std::nullopt;
    case MachineState::Run:
      if (board.probing && board.reports(ReportBit::RunSubstate)) return vocabulary::kRunProbing;
      return std::nullopt;
    default: return std::nullopt;
  }
}

bool Reporter::is_busy() const {
  switch (board_.state) {
    case MachineState::Run:
    case MachineState::Jog:
    case MachineState::Hold:
    case MachineState::Door:
    case MachineState::Home: return true;
    default: return false;
  }
}

std::vector<double> Reporter::in_report_units(const AxisValues& mm) const {
  const double scale = board_.settings.flag(setting::kReportInches) ? 1.0 / kMmPerInch : 1.0;
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(board_.settings.axes()));
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(board_.settings.axes()); ++axis) {
    values.push_back(static_cast<double>(mm.at(axis)) * scale);
  }
  return values;
}

void Reporter::say_status(std::size_t rx_free) {
  const bool pushes_parser_state = is_grblhal_like(board_) && board_.reports(ReportBit::ParserState);
  const bool owes_tool_offset = board_.report.tool_offset;
  if (board_.equipment.pendant) owe_pendant();
  board_.say(status(rx_free));
  if (!pushes_parser_state) return;
  say_changed_parser_state();
  if (owes_tool_offset) say_tool_length_offset();
}

void Reporter::say_changed_parser_state() {
  // grblHAL report.c looks at one kind of change after the other, so that two at once are told by two reports.
  const gcode::ParserState& state = board_.interpreter.state();
  const TrackedValues values = {.feed_rate = state.feed_rate, .spindle_rpm = state.spindle_rpm, .tool = state.tool};
  const bool g92_active = std::ranges::any_of(board_.interpreter.offsets().g92, [](float mm) { return mm != 0.0F; });
  if (values != last_values_) {
    last_values_ = values;
  } else if (g92_active != last_g92_active_) {
    last_g92_active_ = g92_active;
  } else if (last_modal_ != state.modal) {
    last_modal_ = state.modal;
  } else {
    return;
  }
  say_parser_state();
  if (board_.equipment.pendant && !board_.pendant_commands) say_parser_state(Port::Pendant);
}

StatusReport Reporter::status(std::size_t rx_free) {
  const bool masked = is_grblhal_like(board_);
  StatusReport report;
  // grblHAL report.c: motion that a pending tool change still waits for is shown as Tool.
  const bool tool_waits = board_.state == MachineState::Run && board_.changes_tool;
  report.state = tool_waits ? MachineState::Tool : board_.state;
  report.substate = substate_of(board_);
  add_position(report);
  if (board_.reports(ReportBit::BufferState)) {
    report.buffer = {.planner_blocks = board_.planner.free_blocks(), .rx_bytes = static_cast<int>(rx_free)};
  }
  if (!masked || board_.reports(ReportBit::FeedAndSpeed)) add_speed(report);
  if (!masked || board_.reports(ReportBit::PinState)) {
    if (std::string letters = pins(); !letters.empty()) report.pins = std::move(letters);
  }
  const bool everything = board_.report.everything;
  add_counted(report);
  add_card(report, everything);
  return report;
}

void Reporter::add_position(StatusReport& report) const {
  AxisValues position = board_.position_mm();
  if (is_grblhal_like(board_) && board_.reports(ReportBit::LineNumbers)) {
    const auto* block = board_.planner.current();
    const std::int32_t line = block != nullptr ? block->feed.line_number : board_.interpreter.state().line_number;
    if (line != 0) report.line_number = line;
  }
  if (const auto* block = board_.planner.current(); block != nullptr && board_.reports(ReportBit::DistanceToGo)) {
    AxisValues left{};
    const AxisValues& target = board_.block_targets_mm.at(block->source_line % board_.block_targets_mm.size());
    for (std::size_t axis = 0; axis < left.size(); ++axis) left.at(axis) = target.at(axis) - position.at(axis);
    report.distance_to_go = in_report_units(left);
  }
  if (board_.reports(ReportBit::MachinePosition)) {
    report.machine_position = in_report_units(position);
    return;
  }
  const AxisValues offset = board_.interpreter.work_coordinate_offset();
  for (std::size_t axis = 0; axis < position.size(); ++axis) position.at(axis) -= offset.at(axis);
  report.work_position = in_report_units(position);
}

void Reporter::add_speed(StatusReport& report) const {
  const double scale = board_.settings.flag(setting::kReportInches) ? 1.0 / kMmPerInch : 1.0;
  report.feed_mm_per_min = static_cast<double>(board_.executor.speed_mm_per_min()) * scale;
  report.spindle_rpm = static_cast<double>(std::round(board_.spindle_rpm()));
  if (board_.settings.has_spindle_encoder()) report.measured_rpm = std::round(board_.encoder.rpm());
}

std::string Reporter::pins() const {
  std::string limits;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(board_.settings.axes()); ++axis) {
    if (((board_.limits() >> axis) & 1U) != 0) limits += vocabulary::kAxisLetters[axis];
  }
  const bool probe = board_.probe_triggered();
  const auto letter = [&](Input input, char name) {
    return board_.workcell.is_active(input) ? std::string(1, name) : std::string{};
  };
  if (!is_grblhal_like(board_)) {
    // gnea/grbl report.c: P, axes, D, R, H, S
    return (probe ? "P" : "") + limits + letter(Input::Door, 'D') + letter(Input::Reset, 'R') +
           letter(Input::FeedHold, 'H') + letter(Input::CycleStart, 'S');
  }
  // grblHAL report.c control_signals_tostring
  std::string text = limits + letter(Input::Reset, 'R') + letter(Input::FeedHold, 'H');
  if (board_.report.cycle_start_pressed || board_.workcell.is_active(Input::CycleStart)) text += 'S';
  text += letter(Input::Door, 'D');
  if (board_.switches.block_delete) text += 'L';
  if (board_.switches.optional_stop_disabled) text += 'T';
  text += letter(Input::EmergencyStop, 'E') + letter(Input::ProbeDisconnected, 'O');
  if (board_.switches.single_block) text += 'Q';
  if (probe) text += 'P';
  return text;
}

std::string Reporter::accessory_letters(bool with_tool_change) const {
  std::string letters;
  if (board_.accessories.spindle == gcode::SpindleDirection::Clockwise) letters += 'S';
  if (board_.accessories.spindle == gcode::SpindleDirection::Counterclockwise) letters += 'C';
  if (board_.accessories.flood) letters += 'F';
  if (board_.accessories.mist) letters += 'M';
  if (with_tool_change) letters += 'T';
  return letters;
}

void Reporter::add_counted(StatusReport& report) {
  if (is_grblhal_like(board_)) {
    add_counted_grblhal(report);
  } else {
    add_counted_grbl(report);
  }
}

void Reporter::add_counted_grbl(StatusReport& report) {
  // gnea/grbl report.c report_realtime_status: WCO first; a report has one of the two, as WCO puts Ov off by one.
  const vocabulary::Dialect& dialect = board_.personality.dialect();
  ReportDebts& debts = board_.report;
  if (debts.work_offset_counter > 0) {
    --debts.work_offset_counter;
  } else {
    debts.work_offset_counter = (is_busy() ? dialect.work_offset_refresh.busy : dialect.work_offset_refresh.idle) - 1;
    if (debts.override_counter == 0) debts.override_counter = 1;
    report.work_offset = in_report_units(board_.interpreter.work_coordinate_offset());
  }
  if (debts.override_counter > 0) {
    --debts.override_counter;
    return;
  }
  debts.override_counter = (is_busy() ? dialect.override_refresh.busy : dialect.override_refresh.idle) - 1;
  report.overrides = protocol::Overrides{.feed_percent = board_.overrides.feed,
                                         .rapid_percent = board_.overrides.rapid,
                                         .spindle_percent = board_.overrides.spindle};
  if (std::string letters = accessory_letters(false); !letters.empty()) report.accessories = std::move(letters);
}

void Reporter::add_counted_grblhal(StatusReport& report) {
  // grblHAL report.c: what is due by change or counter; WCO by counter waits for a report without Ov.
  const vocabulary::Dialect& dialect = board_.personality.dialect();
  ReportDebts& debts = board_.report;
  const int idle_overrides = dialect.override_refresh.idle - 1;
  const int idle_offset = dialect.work_offset_refresh.idle - 1;
  bool sends_overrides = false;
  if (board_.reports(ReportBit::Overrides)) {
    sends_overrides = debts.everything || debts.overrides || debts.override_counter == 0;
    if (sends_overrides) {
      debts.override_counter = is_busy() ? dialect.override_refresh.busy - 1 : idle_overrides;
      const Accessories& on = board_.accessories;
      if (on.spindle != gcode::SpindleDirection::Off || on.flood || on.mist) debts.accessories = true;
    } else {
      --debts.override_counter;
    }
    if (debts.override_counter > idle_overrides && board_.state == MachineState::Idle) {
      debts.override_counter = idle_overrides;
    }
  }
  bool sends_offset = false;
  bool offset_delayed = false;
  if (board_.reports(ReportBit::WorkOffset)) {
    const bool forced = debts.everything || debts.work_coordinate_system;
    if (forced || debts.work_offset || debts.work_offset_counter == 0) {
      debts.work_offset_counter = is_busy() ? dialect.work_offset_refresh.busy - 1 : idle_offset;
      sends_offset = forced || !sends_overrides;
      offset_delayed = !sends_offset;
    } else {
      --debts.work_offset_counter;
    }
    if (debts.work_offset_counter > idle_offset && board_.state == MachineState::Idle) {
      debts.work_offset_counter = idle_offset;
    }
  }
  if (sends_offset) report.work_offset = in_report_units(board_.interpreter.work_coordinate_offset());
  if (sends_overrides) {
    report.overrides = protocol::Overrides{.feed_percent = board_.overrides.feed,
                                           .rapid_percent = board_.overrides.rapid,
                                           .spindle_percent = board_.overrides.spindle};
  }
  add_changed(report);
  const int override_counter = debts.override_counter;
  const int offset_counter = debts.work_offset_counter;
  debts = {.work_offset = offset_delayed, .override_counter = override_counter, .work_offset_counter = offset_counter};
}

void Reporter::add_changed(StatusReport& report) const {
  const ReportDebts& debts = board_.report;
  const gcode::ParserState& state = board_.interpreter.state();
  const bool all = debts.everything;
  const bool tool_changes = board_.changes_tool;
  if (all || debts.work_coordinate_system) report.wcs = kWorkOffsets.at(state.modal.work_offset);
  if (all || debts.accessories || debts.tool || tool_changes) {
    report.accessories = accessory_letters(tool_changes && !(all || debts.tool));
  }
  if (all || debts.scaling) {
    std::string axes;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(board_.settings.axes()); ++axis) {
      if (state.scale_factor.at(axis) != 1.0F) axes += vocabulary::kAxisLetters[axis];
    }
    report.scaled_axes = std::move(axes);
  }
  const auto interval = static_cast<int>(board_.settings.number(setting::kAutoReport));
  if ((all || debts.mpg) && interval > 0) report.auto_report_ms = board_.auto_reporting ? interval : 0;
  if (all || debts.mpg) report.mpg = board_.pendant_commands;
  const AxisMask homing = board_.homing_axes();
  const bool single = board_.settings.flag(setting::kHoming, homing_bit::kSingleAxis);
  if ((all || debts.homed) && (homing != 0 || single)) {
    const AxisMask wanted = homing != 0 ? homing : board_.all_axes();
    report.homed = protocol::Homed{.homed = (wanted & board_.homed) == wanted, .axis_mask = std::nullopt};
    if (single) report.homed->axis_mask = board_.homed;
  }
  if (all || debts.tool) report.tool = static_cast<int>(state.tool);
  if ((all || debts.input_result) && board_.input_result) report.input_result = board_.input_result;
  if (all) report.probe = protocol::ProbeState{};
  if (all || debts.tool_reference) report.tlr = board_.tool_reference_axes != 0;
  if (!all) return;
  report.firmware = std::string{board_.personality.dialect().firmware_field};
  if (board_.critical) report.critical = true;
}

void Reporter::add_card(StatusReport& report, bool everything) {
  // grblHAL fs_stream.c, then sdcard.c: both stand behind the fields of the core.
  if (const FileJob& job = board_.job; job.is_read() && !everything) {
    std::string percent = base::to_fixed(job.percent(), 1);
    if (percent == "100.0" && board_.state != MachineState::Idle) percent = "99.9";
    report.unknown.push_back({.name = "SD", .value = percent + "," + job.name()});
  }
  CardSlot& slot = board_.slot;
  if (slot.mount_changed || (everything && slot.is_reported)) {
    report.unknown.push_back({.name = "SD", .value = slot.mounted ? "1" : "0"});
    slot.mount_changed = false;
  }
}

void Reporter::say_parser_state() {
  board_.say(protocol::ParserState{.words = parser_state_words(board_)});
}

void Reporter::say_parser_state(Port port) {
  board_.outbox.say_to(port, protocol::ParserState{.words = parser_state_words(board_)});
}

void Reporter::owe_pendant() {
  for (const auto flag : kReportFlags) {
    pendant_debts_.*flag = pendant_debts_.*flag || (board_.report.*flag && !(told_pendant_.*flag));
  }
  told_pendant_ = {};
}

void Reporter::say_status_to_pendant(std::size_t rx_free, bool everything) {
  const ReportDebts debts = board_.report;
  owe_pendant();
  told_pendant_ = debts;
  board_.report = pendant_debts_;
  board_.report.everything = everything;
  const StatusReport report = status(rx_free);
  pendant_debts_ = board_.report;
  board_.report = debts;
  board_.outbox.say_to(Port::Pendant, report);
}

void Reporter::say_tool_length_offset() {
  if (board_.personality.tool_length_stays_metric) {
    constexpr int kDecimals = 3;
    const auto length = static_cast<double>(board_.interpreter.offsets().tool_length.at(2));
    board_.say(protocol::Unrecognized{.line = "[TLO:" + base::to_fixed(length, kDecimals) + "]"});
    return;
  }
  std::vector<double> values = in_report_units(board_.interpreter.offsets().tool_length);
  if (!board_.personality.dialect().tool_length_offset_per_axis) values = {values.at(2)};
  board_.say(protocol::ToolLengthOffset{.values = std::move(values)});
}

void Reporter::say_probe() {
  const gcode::Offsets& offsets = board_.interpreter.offsets();
  board_.say(protocol::ProbeResult{.values = in_report_units(offsets.probe), .success = offsets.probe_succeeded});
}

void Reporter::say_parameters() {
  const gcode::Offsets& offsets = board_.interpreter.offsets();
  const auto say_offset = [&](std::string_view name, const AxisValues& values) {
    board_.say(protocol::StoredOffset{.name = std::string{name}, .values = in_report_units(values)});
  };
  const gcode::ParserState& state = board_.interpreter.state();
  if (state.modal.scaling) {
    // The firmware prints them like lengths, in inches too.
    board_.say(protocol::ScaledAxes{.factors = in_report_units(state.scale_factor)});
  }
  for (std::size_t index = 0; index < static_cast<std::size_t>(board_.interpreter.rules().work_offsets); ++index) {
    say_offset(kWorkOffsets.at(index), offsets.work.at(index));
  }
  say_offset("G28", offsets.g28);
  say_offset("G30", offsets.g30);
  say_offset("G92", offsets.g92);
  const double scale = board_.settings.flag(setting::kReportInches) ? 1.0 / kMmPerInch : 1.0;
  for (int tool = 1; tool <= board_.personality.hardware.tools; ++tool) {
    const gcode::Tool& entry = offsets.tools.at(static_cast<std::size_t>(tool));
    board_.say(protocol::ToolRow{.tool = tool,
                                 .offsets = in_report_units(entry.length_mm),
                                 .radius = static_cast<double>(entry.radius_mm) * scale,
                                 .geometry = "6,0,0",
                                 .pocket = std::to_string(tool)});
  }
  if (board_.personality.homing.tracks_axes && board_.settings.flag(setting::kHoming)) {
    board_.say(protocol::HomePosition{.values = in_report_units(board_.home_position_mm),
                                      .axis_mask = static_cast<int>(board_.homed)});
  }
  say_tool_length_offset();
  say_probe();
  if (board_.tool_reference_axes != 0) {
    const auto linear = gcode::axes_of(board_.interpreter.state().modal.plane).linear;
    board_.say(protocol::ToolLengthReference{.values = {in_report_units(board_.tool_reference_mm).at(linear)}});
  }
}

}  // namespace kerf::firmware
