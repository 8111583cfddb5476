#include "firmware/system_commands.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/base/text.hpp"
#include "common/gcode/numbers.hpp"
#include "common/gcode/print_format.hpp"
#include "firmware/block_steps.hpp"
#include "firmware/leading_number.hpp"

namespace kerf::firmware {

using vocabulary::FeedbackText;

namespace {

constexpr std::chrono::milliseconds kRabbitListPause{100};
constexpr std::chrono::milliseconds kHomingAnnouncement{100};
constexpr unsigned kLimitsStrictBit = 1;

/// The number behind `$$=`, `$SED=` and `$#=`: what follows it does not matter (grblHAL system.c).
std::expected<std::int32_t, ErrorCode> read_id(std::string_view text) {
  const auto number = leading_number(text);
  if (!number) return std::unexpected(ErrorCode::BadNumberFormat);
  if (number->value != std::trunc(number->value)) return std::unexpected(ErrorCode::InvalidStatement);
  return gcode::to_int32(number->value);
}

}  // namespace

bool homing_is_required(const Board& board) {
  const auto& settings = board.settings;
  const AxisMask wanted = board.homing_axes();
  return board.personality.start.has_homing_alarm && settings.flag(setting::kHoming) &&
         settings.flag(setting::kHoming, homing_bit::kRequiredAtStart) &&
         (board.cold_start || !settings.flag(setting::kHoming, homing_bit::kOverrideLocks)) && wanted != 0 &&
         (wanted & board.homed) != wanted;
}

std::expected<void, ErrorCode> SystemCommands::execute(std::string_view line, Steps& steps) {
  Steps added;
  if (const Result result = understand(line, added); !result) return result;
  const bool answers = std::ranges::any_of(added, [](const Step& step) {
    return std::holds_alternative<Answer>(step) || std::holds_alternative<ContinueToolChange>(step);
  });
  if (!answers) added.emplace_back(Answer{});
  steps.insert(steps.end(), added.begin(), added.end());
  return {};
}

SystemCommands::Result SystemCommands::understand(std::string_view line, Steps& steps) {
  if (const auto handled = card_commands_.execute(line, steps)) return *handled;
  const auto command = board_.personality.parse_command(board_.personality, line, board_.state, board_.critical);
  if (!command) return std::unexpected(command.error());
  if (!command->states.contains(board_.state)) return std::unexpected(ErrorCode::IdleError);
  return dispatch(*command, steps);
}

SystemCommands::Result SystemCommands::dispatch(const ParsedCommand& command, Steps& steps) {
  switch (command.command) {
    case Command::WriteSetting: return write_setting(command, steps);
    case Command::ReadSetting: return read_setting(command);
    case Command::DescribeSetting: return describe_setting(command);
    case Command::CheckMode: return check_mode(steps);
    case Command::Unlock: return unlock();
    case Command::Home: return home(command, steps);
    case Command::Jog: return jog(command, steps);
    case Command::StoreUserText: return store_user_text(command);
    case Command::BuildInformation:
      if (command.has_value && board_.personality.names_settings) return std::unexpected(ErrorCode::InvalidStatement);
      if (command.has_value) return store_user_text(command);
      listing_.build_information(board_.personality.tells_build_at_length);
      return {};
    case Command::StoreStartupLine: return store_startup_line(command, steps);
    case Command::ReleaseMotors: return release_motors(command);
    case Command::EraseMemory: board_.stored = {}; return {};
    case Command::Restore: return restore(command, steps);
    case Command::Sleep: return sleep(steps);
    case Command::BlockDelete:
    case Command::SingleBlock:
    case Command::OptionalStop: return toggle(command.command);
    case Command::SetToolReference: return set_tool_reference();
    case Command::ProbeToolPlate: return probe_tool_plate(steps);
    case Command::Parameters:
      if (command.has_value && board_.personality.tells_parameters) return tell_parameter(command.value);
      if (command.has_value) return std::unexpected(ErrorCode::InvalidStatement);
      reporter_.say_parameters();
      if (board_.personality.parameters_pause) steps.emplace_back(Freeze{.duration = kRabbitListPause});
      return {};
    case Command::ListAlarms:
    case Command::ListErrors:
      if (board_.personality.parameters_pause) steps.emplace_back(Freeze{.duration = kRabbitListPause});
      return list_codes(command);
    default: return dispatch_listing(command);
  }
}

SystemCommands::Result SystemCommands::dispatch_listing(const ParsedCommand& command) {
  switch (command.command) {
    case Command::Help: listing_.help(); break;
    case Command::HelpTopics: listing_.help_on(command.value); break;
    case Command::ListSettings: listing_.settings(); break;
    case Command::ListNamedSettings: listing_.named_settings(); break;
    case Command::ListChangedSettings: listing_.changed_settings(); break;
    case Command::ListSettingNames: listing_.setting_names(); break;
    case Command::ListCommands: listing_.commands(); break;
    case Command::ParserState:
      reporter_.say_parser_state();
      board_.report.homed = true;  // grblHAL system.c output_parser_state
      break;
    case Command::ExtendedBuildInformation: listing_.build_information(true); break;
    case Command::ListStartupLines: listing_.startup_lines(); break;
    case Command::ReadStartupLine: listing_.one_startup_line(command.key, command.value); break;
    case Command::ListState: listing_.state(); break;
    case Command::MemoryUse: listing_.memory_use(); break;
    case Command::ListSettingGroups: listing_.setting_groups(); break;
    case Command::ListSettingDefinitions: listing_.setting_definitions(); break;
    case Command::ListAlarmsAsCsv: listing_.alarms_as_csv(); break;
    case Command::ListErrorsAsCsv: listing_.errors_as_csv(); break;
    case Command::ListSettingsAsCsv: listing_.settings_as_csv(); break;
    case Command::ListSettingsAsTabs: listing_.settings_as_tabs(); break;
    case Command::ListEverything:
      listing_.alarms();
      listing_.errors();
      listing_.setting_groups();
      listing_.setting_definitions();
      break;
    case Command::NotAvailable: return std::unexpected(ErrorCode::InvalidStatement);
    case Command::SettingDescription: {
      const auto id = read_id(command.value);
      if (!id) return std::unexpected(id.error());
      if (*id >= 0) listing_.setting_description(std::to_string(*id));
      break;
    }
    case Command::ReportLimits: listing_.limits(); break;
    case Command::ReportHomeSwitches: listing_.home_switches(); break;
    case Command::ReportLastEvents: listing_.last_events(); break;
    case Command::ListSpindles: listing_.spindles(false); break;
    case Command::ListSpindlesForMachines: listing_.spindles(true); break;
    default: break;
  }
  return {};
}

// `$#=5` by number, anything else is a name.
SystemCommands::Result SystemCommands::tell_parameter(std::string_view text) {
  const std::string name{text};
  const auto number = read_id(text);
  const bool is_number = number && *number >= 0;
  const auto id = static_cast<std::uint16_t>(number.value_or(0));
  const auto value = is_number ? board_.interpreter.parameter(id) : board_.interpreter.parameter(text);
  board_.say(protocol::NamedParameter{
      .name = is_number ? std::to_string(id) : name,
      .value =
          value ? gcode::trimmed_number(*value, gcode::parameter_decimals(board_.interpreter.settings())) : "N/A"});
  return {};
}

SystemCommands::Result SystemCommands::describe_setting(const ParsedCommand& command) {
  if (!command.has_value) {
    if (board_.state == MachineState::Run || board_.state == MachineState::Hold) {
      return std::unexpected(ErrorCode::IdleError);
    }
    listing_.settings();
    return {};
  }
  const auto id = read_id(command.value);
  if (!id) return std::unexpected(id.error());
  if (*id < 0) return {};
  const auto* slot = board_.settings.find(std::to_string(*id));
  if (slot == nullptr) return std::unexpected(ErrorCode::SettingDisabled);
  listing_.describe_setting(*slot);
  return {};
}

SystemCommands::Result SystemCommands::read_setting(const ParsedCommand& command) {
  if (board_.personality.names_settings) return read_named_setting(command);
  const auto* slot = board_.settings.find(command.key);
  if (slot == nullptr) {
    return std::unexpected(board_.personality.unknown_setting_error);
  }
  board_.say(protocol::SettingValue{.id = command.key, .value = slot->text});
  return {};
}

SystemCommands::Result SystemCommands::write_setting(const ParsedCommand& command, Steps& added) {
  const AxisValues position = board_.position_mm();
  const AxisValues steps_before = board_.planner.settings().steps_per_mm;
  const AxisValues travel_before = board_.settings.axis_values(setting::kMaxTravel);
  if (const Result may = may_write(command); !may) return may;
  if (const Result written = board_.settings.write(command.key, command.value); !written) return written;
  board_.apply_settings();
  // The value and a check sum.
  const auto* slot = board_.settings.find(command.key);
  board_.store_settings(slot != nullptr && slot->match.row->type == vocabulary::SettingType::Decimal ? 5 : 2);
  if (command.key == std::to_string(setting::kReportInches)) board_.owe_work_offset();
  if (board_.personality.names_settings) restart_spindle_after(command, added);
  if (!board_.personality.has_extended_settings) return {};
  if (board_.settings.number(setting::kAutoReport) == 0.0) board_.auto_reporting = false;

  // grblHAL settings.c: a position keeps its millimetres, a new travel makes its axis unhomed, and a new tool change
  // mode starts tool changes anew.
  if (const AxisValues& now = board_.planner.settings().steps_per_mm; now != steps_before) {
    AxisSteps steps = board_.steps();
    for (std::size_t axis = 0; axis < steps.size(); ++axis) {
      if (now.at(axis) != steps_before.at(axis)) {
        steps.at(axis) = static_cast<std::int32_t>(std::lround(position.at(axis) * now.at(axis)));
      }
    }
    board_.executor.set_position(steps);
    board_.sync_position();
  }
  const AxisValues travel = board_.settings.axis_values(setting::kMaxTravel);
  for (std::size_t axis = 0; axis < travel.size(); ++axis) {
    if (travel.at(axis) == travel_before.at(axis)) continue;
    board_.homed = static_cast<AxisMask>(board_.homed & ~(1U << axis));
    board_.report.homed = true;
  }
  if (command.key == std::to_string(setting::kToolChangeMode)) board_.report.tool_reference = true;
  return {};
}

SystemCommands::Result SystemCommands::check_mode(Steps& steps) {
  const bool silent = board_.personality.check_mode_is_silent;
  if (board_.state == MachineState::Check) {
    if (!silent) board_.say(FeedbackText::Disabled);
    steps.insert(steps.end(), {Answer{}, Restart{}});
    return {};
  }
  if (board_.state != MachineState::Idle) return std::unexpected(ErrorCode::IdleError);
  board_.state = MachineState::Check;
  board_.interpreter.settings().check_mode = true;
  if (!silent) board_.say(FeedbackText::Enabled);
  return {};
}

std::optional<ErrorCode> SystemCommands::lock_reason(bool homing) const {
  if (!board_.personality.has_extended_settings) return std::nullopt;
  const Workcell& cell = board_.workcell;
  if (cell.is_active(Input::EmergencyStop)) return ErrorCode::EmergencyStop;
  if (cell.is_active(Input::Door) && !board_.settings.flag(setting::kDoorOptions)) return ErrorCode::CheckDoor;
  if (cell.is_active(Input::Reset)) return ErrorCode::ResetAsserted;
  if (homing) return std::nullopt;
  const bool strict =
      board_.settings.flag(setting::kHardLimits) && board_.settings.flag(setting::kHardLimits, kLimitsStrictBit);
  if (strict && board_.limits() != 0) return ErrorCode::LimitsEngaged;
  if (homing_is_required(board_)) return ErrorCode::HomingRequired;
  return std::nullopt;
}

SystemCommands::Result SystemCommands::unlock() {
  if (board_.state != MachineState::Alarm) return {};
  if (const auto reason = lock_reason(false)) return std::unexpected(*reason);
  board_.state = MachineState::Idle;
  board_.alarm = 0;
  board_.say(FeedbackText::Unlocked);
  return {};
}

SystemCommands::Result SystemCommands::home(const ParsedCommand& command, Steps& steps) {
  const auto& settings = board_.settings;
  AxisMask asked = 0;
  if (!command.key.empty()) {
    const auto named = vocabulary::axis_of(command.key.front());
    const bool lacks_axis = !named || static_cast<int>(vocabulary::index_of(*named)) >= settings.axes();
    if (board_.personality.has_extended_settings && lacks_axis) return std::unexpected(ErrorCode::InvalidStatement);
    if (board_.personality.has_extended_settings && !settings.flag(setting::kHoming, homing_bit::kSingleAxis)) {
      return std::unexpected(ErrorCode::HomingDisabled);
    }
    const auto axis = vocabulary::axis_of(command.key.front());
    asked = axis ? static_cast<AxisMask>(vocabulary::mask_of(*axis) & board_.all_axes()) : AxisMask{0};
  }
  if (board_.state != MachineState::Idle && board_.state != MachineState::Alarm) {
    return std::unexpected(ErrorCode::IdleError);
  }
  if (const auto reason = lock_reason(true)) return std::unexpected(*reason);
  if (!settings.flag(setting::kHoming)) return std::unexpected(ErrorCode::HomingDisabled);
  const bool single_axis_unknown = !board_.personality.homing.homes_single_axes;
  if (!command.key.empty() && (asked == 0 || single_axis_unknown)) {
    // Grbl counts as homing before it reads on, and stays so until a reset (gnea/grbl system.c).
    if (single_axis_unknown) board_.state = MachineState::Home;
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  std::vector<AxisMask> cycles = board_.homing_cycles();
  if (asked != 0) cycles = {asked};
  if (cycles.empty()) {
    return std::unexpected(board_.personality.homing.no_cycle_error);
  }

  board_.state = MachineState::Home;
  board_.alarm = 0;
  if (board_.personality.homing.announces) {
    // grblHAL switches off and its parser knows: M3 in the next line starts the spindle again (motion_control.c).
    if (board_.accessories.spindle != gcode::SpindleDirection::Off) board_.interpreter.stop_spindle();
    board_.interpreter.set_coolant({});
    board_.set_accessories({});
    if (asked == 0) board_.homed = static_cast<AxisMask>(board_.homed & ~board_.homing_axes());
    if (!board_.reports(vocabulary::ReportBit::ReportWhenHoming)) {
      // The delay prepares what is queued, and homing then goes on from there (grblHAL/core protocol.c).
      board_.executor.prepare_at_rest();
      steps.insert(steps.end(), {SayStatus{}, Freeze{.duration = kHomingAnnouncement}});
    }
  }
  steps.insert(steps.end(),
               {HomeAxes{.cycles = {cycles.begin(), cycles.end()}}, FinishHoming{.asked = asked}, Answer{}});
  return {};
}

SystemCommands::Result SystemCommands::jog(const ParsedCommand& command, Steps& steps) {
  if (const Result added = add_jog_steps(board_, command.value, steps); !added) return added;
  steps.emplace_back(Answer{});
  return {};
}

SystemCommands::Result SystemCommands::store_user_text(const ParsedCommand& command) {
  if (command.value.size() > static_cast<std::size_t>(board_.personality.dialect().stored_line_length)) {
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  board_.stored.user_text = command.value;
  board_.store_settings();
  return {};
}

SystemCommands::Result SystemCommands::store_startup_line(const ParsedCommand& command, Steps& steps) {
  const std::size_t lines = board_.stored.startup_lines.size();
  const auto index = base::parse_int<int>(command.key);
  const bool exists = index && *index >= 0 && static_cast<std::size_t>(*index) < lines;
  if (!exists && !board_.personality.start.runs_lines_it_cannot_store) {
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  constexpr StateSet kStoring = {MachineState::Idle, MachineState::Alarm, MachineState::Check};
  if (!command.value.empty() && !kStoring.contains(board_.state)) return std::unexpected(ErrorCode::IdleError);
  const bool says_invalid = board_.personality.names_settings;
  if (says_invalid && board_.state != MachineState::Idle) return std::unexpected(ErrorCode::SettingTextInvalid);

  const std::string line = normalised_block(command.value);
  if (line.size() > static_cast<std::size_t>(board_.personality.dialect().stored_line_length)) {
    return std::unexpected(ErrorCode::LineTooLong);
  }
  // The line is carried out once, to see that it is valid (gnea/grbl system.c; grblHAL system.c).
  const auto blocks =
      board_.personality.start.startup_blocks_split ? base::split(line, '|') : std::vector<std::string_view>{line};
  for (const std::string_view block : blocks) {
    if (block.empty()) continue;
    if (const Result added = add_block_steps(board_, block, steps); !added) {
      return says_invalid ? std::unexpected(ErrorCode::SettingTextInvalid) : added;
    }
  }
  // Rabbit waits for the motion when it stores offsets only.
  const bool waits = board_.personality.stored_writes_synchronise && !board_.personality.names_settings;
  if (waits) steps.emplace_back(Synchronize{});
  if (exists) steps.emplace_back(KeepStartupLine{.index = static_cast<std::size_t>(*index), .line = line});
  return {};
}

SystemCommands::Result SystemCommands::restore(const ParsedCommand& command, Steps& steps) {
  // grblHAL looks at the first letter only.
  const bool one_letter = board_.personality.has_extended_settings;
  const std::string_view what = std::string_view{command.value}.substr(0, one_letter ? 1 : std::string_view::npos);
  const bool names = board_.personality.restores_network;
  const bool everything = what == "*" || (names && base::iequals(what, "all"));
  const bool settings = everything || what == "$" || (names && base::iequals(what, "settings"));
  const bool offsets = everything || what == "#" || (names && base::iequals(what, "gcode"));
  const bool driver = (board_.personality.has_extended_settings && what == "&") ||
                      (names && (what == "@" || base::iequals(what, "wifi")));
  if (!settings && !offsets && !driver) return std::unexpected(ErrorCode::InvalidStatement);

  if (settings) board_.settings.restore_defaults();
  if (offsets) {
    board_.stored.offsets.clear();
    board_.stored.tools.clear();
    const auto tool_length = board_.interpreter.offsets().tool_length;
    board_.load_offsets();
    board_.interpreter.offsets().tool_length = tool_length;
  }
  // Rabbit counts the startup lines among its settings.
  if (everything || (settings && names)) {
    board_.stored.startup_lines = {};
    board_.stored.user_text.clear();
  }
  board_.apply_settings();
  board_.store_settings();
  if (names) {
    if (settings) board_.say(protocol::Feedback{.text = "Settings reset done"});
    board_.say(protocol::Feedback{.text = "Position offsets reset done"});
  } else {
    board_.say(FeedbackText::RestoringDefaults);
  }
  steps.emplace_back(Answer{});
  if (board_.personality.restore_resets) steps.emplace_back(Restart{});
  return {};
}

SystemCommands::Result SystemCommands::sleep(Steps& steps) {
  if (board_.personality.sleep_needs_setting && !board_.settings.flag(setting::kSleepEnable)) {
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  if (board_.state != MachineState::Idle && board_.state != MachineState::Alarm) {
    return std::unexpected(ErrorCode::IdleError);
  }
  steps.insert(steps.end(), {Answer{}, EnterSleep{}});
  return {};
}

SystemCommands::Result SystemCommands::toggle(Command command) {
  Switches& switches = board_.switches;
  bool& flag = command == Command::BlockDelete   ? switches.block_delete
               : command == Command::SingleBlock ? switches.single_block
                                                 : switches.optional_stop_disabled;
  flag = !flag;
  board_.apply_settings();
  board_.say(flag ? FeedbackText::Enabled : FeedbackText::Disabled);
  return {};
}

SystemCommands::Result SystemCommands::list_codes(const ParsedCommand& command) {
  const bool alarms = command.command == Command::ListAlarms;
  if (!command.has_value) {
    if (alarms) {
      listing_.alarms();
    } else {
      listing_.errors();
    }
    return {};
  }
  const std::string_view kind = alarms ? "alarm" : "error";
  // An empty text is 0, as C's strtol reads it.
  const auto code = command.value.empty() ? 0 : base::parse_int<int>(command.value);
  if (code && (alarms ? listing_.one_alarm(*code) : listing_.one_error(*code))) return {};
  std::string text = code ? "Unknown " : "Malformed ";
  text.append(kind).append(" number: ").append(command.value);
  board_.say(protocol::Unrecognized{.line = std::move(text)});
  return std::unexpected(ErrorCode::SettingTextInvalid);
}

SystemCommands::Result SystemCommands::set_tool_reference() {
  const gcode::Offsets& offsets = board_.interpreter.offsets();
  const auto linear = gcode::axes_of(board_.interpreter.state().modal.plane).linear;
  if (offsets.probe_succeeded) {
    board_.tool_reference_axes = static_cast<AxisMask>(board_.tool_reference_axes | (1U << linear));
    board_.tool_reference_mm.at(linear) = offsets.probe.at(linear);
  } else {
    board_.tool_reference_axes = 0;
  }
  board_.report.tool_reference = true;
  return {};
}

SystemCommands::Result SystemCommands::probe_tool_plate(Steps& steps) {
  auto planned = tool_change_.probe_plate();
  if (!planned) return std::unexpected(planned.error());
  steps = *std::move(planned);
  return {};
}

}  // namespace kerf::firmware
