// How each firmware reads a `$` line. The order of the checks is the firmware's, because it decides the error number.

#include <algorithm>

#include "common/base/text.hpp"
#include "common/gcode/numbers.hpp"
#include "firmware/leading_number.hpp"
#include "firmware/system_commands.hpp"

namespace kerf::firmware {

using Parsed = std::expected<ParsedCommand, ErrorCode>;

namespace {

constexpr StateSet kIdleOrAlarm = {MachineState::Idle, MachineState::Alarm};
constexpr float kLargestByte = 255;

const CommandRow* find_row(const Personality& personality, std::string_view name) {
  const auto found = std::ranges::find(personality.commands, name, &CommandRow::name);
  return found == personality.commands.end() ? nullptr : &*found;
}

/// `$HA` is a command on machines with an A axis only.
bool has_its_axis(const Personality& personality, const CommandRow& row) {
  if (row.command != Command::Home || row.prefix.empty()) return true;
  const auto axis = vocabulary::axis_of(row.prefix.front());
  const int built = personality.hardware.axes != 0 ? personality.hardware.axes : personality.dialect().axes_default;
  return axis && static_cast<int>(vocabulary::index_of(*axis)) < built;
}

/// What stands before the first `=`, and what stands behind it.
struct NameAndValue {
  std::string name;
  std::string value;
  bool has_value = false;
};

NameAndValue split_value(std::string_view line) {
  const auto equals = line.find('=');
  NameAndValue parts;
  for (const char letter : line.substr(0, equals)) {
    if (letter != ' ') parts.name += base::to_upper(letter);
  }
  parts.has_value = equals != std::string_view::npos;
  if (parts.has_value) parts.value = line.substr(equals + 1);
  return parts;
}

/// Rabbit: the name ends at the first blank; `[name]value` is the same as `$name=value` but for an empty value
/// (SourceRabbit/RabbitGRBL ProcessSettings.cpp).
std::optional<NameAndValue> name_and_value_rabbit(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\v\f";
  const bool bracketed = line.starts_with('[');
  line.remove_prefix(1);
  const auto end = bracketed ? line.rfind(']') : line.find('=');
  if (bracketed && end == std::string_view::npos) return std::nullopt;
  NameAndValue parts;
  if (end != std::string_view::npos) {
    parts.value = line.substr(end + 1);
    parts.has_value = !bracketed || !parts.value.empty();
  }
  std::string_view name = line.substr(0, end);
  name.remove_prefix(std::min(name.find_first_not_of(kBlanks), name.size()));
  parts.name = name.substr(0, name.find_first_of(kBlanks));
  return parts;
}

ParsedCommand command_of(const CommandRow& row, NameAndValue parts) {
  return {.command = row.command,
          .states = row.states,
          .key = std::string{row.prefix},
          .value = std::move(parts.value),
          .has_value = parts.has_value};
}

/// gnea/grbl system.c: `$N1=...` and `$110=...` both begin with a number.
Parsed numbered_grbl(Command command, std::string_view line) {
  const auto number = leading_number(line);
  if (!number) return std::unexpected(ErrorCode::BadNumberFormat);
  if (!number->rest.starts_with('=')) return std::unexpected(ErrorCode::InvalidStatement);
  const std::string_view value = number->rest.substr(1);
  if (command == Command::WriteSetting) {
    const auto setting = leading_number(value);
    if (!setting) return std::unexpected(ErrorCode::BadNumberFormat);
    if (!setting->rest.empty() || number->value > kLargestByte) return std::unexpected(ErrorCode::InvalidStatement);
    // Before anybody asks whether there is such a setting (gnea/grbl settings.c).
    if (setting->value < 0) return std::unexpected(ErrorCode::NegativeValue);
  }
  return ParsedCommand{.command = command,
                       .key = std::to_string(static_cast<int>(number->value)),
                       .value = std::string{value},
                       .has_value = true};
}

/// The commands that need Idle or Alarm.
Parsed parse_quiet_grbl(const Personality& personality, std::string_view line, MachineState state) {
  switch (line.front()) {
    case 'H': return ParsedCommand{.command = Command::Home, .key = std::string{line.substr(1)}};
    case 'N':
      if (line.size() == 1) return ParsedCommand{.command = Command::ListStartupLines};
      if (state != MachineState::Idle) return std::unexpected(ErrorCode::IdleError);
      return numbered_grbl(Command::StoreStartupLine, line.substr(1));
    case '#':
    case 'S':
    case 'I':
    case 'R': {
      NameAndValue parts = split_value(line);
      const CommandRow* row = find_row(personality, parts.has_value ? parts.name + "=" : parts.name);
      if (row == nullptr) return std::unexpected(ErrorCode::InvalidStatement);
      return command_of(*row, std::move(parts));
    }
    default: return numbered_grbl(Command::WriteSetting, line);
  }
}

}  // namespace

Parsed parse_command_grbl(const Personality& personality, std::string_view line, MachineState state,
                          bool /*critical*/) {
  if (line.empty()) return ParsedCommand{.command = Command::Help};
  if (line.front() == 'J') {
    if (state != MachineState::Idle && state != MachineState::Jog) return std::unexpected(ErrorCode::IdleError);
    if (!line.substr(1).starts_with('=')) return std::unexpected(ErrorCode::InvalidStatement);
    return ParsedCommand{.command = Command::Jog, .value = std::string{line.substr(2)}, .has_value = true};
  }
  if (std::string_view{"$GCX"}.find(line.front()) != std::string_view::npos) {
    const CommandRow* row = find_row(personality, line);
    if (row == nullptr) return std::unexpected(ErrorCode::InvalidStatement);
    return command_of(*row, {});
  }
  if (!kIdleOrAlarm.contains(state)) return std::unexpected(ErrorCode::IdleError);
  return parse_quiet_grbl(personality, line, state);
}

Parsed parse_command_rabbit(const Personality& personality, std::string_view line, MachineState state,
                            bool /*critical*/) {
  std::optional<NameAndValue> read = name_and_value_rabbit(line);
  if (!read) return std::unexpected(ErrorCode::InvalidStatement);
  NameAndValue& parts = *read;
  const auto names = [&](const CommandRow& row) {
    return base::iequals(row.name, parts.name) || (!row.long_name.empty() && base::iequals(row.long_name, parts.name));
  };
  const auto row = std::ranges::find_if(personality.commands, names);
  if (row == personality.commands.end()) {
    return ParsedCommand{.command = parts.has_value ? Command::WriteSetting : Command::ReadSetting,
                         .key = std::move(parts.name),
                         .value = std::move(parts.value),
                         .has_value = parts.has_value};
  }
  if (row->command == Command::StoreStartupLine && !parts.has_value) {
    const bool by_name = base::iequals(row->long_name, parts.name);
    return ParsedCommand{.command = Command::ReadStartupLine,
                         .key = std::string{row->prefix},
                         .value = std::string{by_name ? row->long_name : row->name}};
  }
  if (row->ignores_value) {
    parts.has_value = false;
    parts.value.clear();
  }
  ParsedCommand command = command_of(*row, std::move(parts));
  if (!command.states.contains(state)) return std::unexpected(ErrorCode::IdleError);
  if ((row->needs_value && !command.has_value) || (command.has_value && !row->takes_value)) {
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  return command;
}

Parsed parse_command_grblhal(const Personality& personality, std::string_view line, MachineState state, bool critical) {
  if (line.empty()) return ParsedCommand{.command = Command::Help};
  NameAndValue parts = split_value(line);
  if (parts.name.starts_with("HELP")) {
    return ParsedCommand{.command = Command::HelpTopics, .value = parts.name.substr(4)};
  }
  if (const CommandRow* row = find_row(personality, parts.name); row != nullptr && has_its_axis(personality, *row)) {
    if (critical && !row->works_critically) return std::unexpected(ErrorCode::NotAllowedInCriticalEvent);
    if (row->takes_value || !parts.has_value) {
      if (!row->states.contains(state)) return std::unexpected(ErrorCode::IdleError);
      if (row->needs_value && !parts.has_value) return std::unexpected(ErrorCode::InvalidStatement);
      return command_of(*row, std::move(parts));
    }
  }
  constexpr StateSet kSettingStates = {MachineState::Idle, MachineState::Alarm, MachineState::Check};
  if (!kSettingStates.contains(state)) return std::unexpected(ErrorCode::IdleError);
  std::uint8_t at = 0;
  float number = 0.0F;
  const bool is_number = gcode::read_float(gcode::rules_for(personality.dialect()), parts.name.c_str(), at, number);
  if (!is_number || number < 0.0F || !gcode::is_whole(number)) return std::unexpected(ErrorCode::InvalidStatement);
  // Ids have 32 bits, and what does not fit is cut.
  const std::uint32_t id = gcode::to_uint32(number);
  return ParsedCommand{.command = parts.has_value ? Command::WriteSetting : Command::ReadSetting,
                       .key = std::to_string(id),
                       .value = std::move(parts.value),
                       .has_value = parts.has_value};
}

}  // namespace kerf::firmware
