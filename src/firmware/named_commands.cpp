// The `$` commands of a firmware whose settings have names (SourceRabbit/RabbitGRBL ProcessSettings.cpp).

#include <chrono>

#include "common/base/text.hpp"
#include "firmware/name_pattern.hpp"
#include "firmware/system_commands.hpp"

namespace kerf::firmware {

namespace {

constexpr StateSet kWriting = {MachineState::Idle, MachineState::Alarm};
constexpr int kSpindleGroup = 6;

}  // namespace

SystemCommands::Result SystemCommands::read_named_setting(const ParsedCommand& command) {
  if (const auto* slot = board_.settings.find(command.key)) {
    if (base::parse_int<int>(command.key)) {
      listing_.one_setting(*slot);
    } else {
      listing_.one_named_setting(*slot);
    }
    return {};
  }
  bool found = false;
  for (const auto& [name, value] : listing_.named()) {
    if (!matches_pattern(command.key, name)) continue;
    listing_.one_named(name, value);
    found = true;
  }
  if (!found) return std::unexpected(ErrorCode::InvalidStatement);
  return {};
}

SystemCommands::Result SystemCommands::may_write(const ParsedCommand& command) const {
  if (!board_.personality.names_settings || kWriting.contains(board_.state)) return {};
  if (board_.settings.find(command.key) == nullptr) return {};
  return std::unexpected(ErrorCode::IdleError);
}

SystemCommands::Result SystemCommands::release_motors(const ParsedCommand& command) {
  const std::string_view text = base::trim(command.value);
  if (text.empty() || base::parse_int<int>(text)) return {};
  for (const char letter : text) {
    if (!std::string_view{"XYZABC"}.contains(base::to_upper(letter))) {
      return std::unexpected(ErrorCode::BadNumberFormat);
    }
  }
  return {};
}

void SystemCommands::restart_spindle_after(const ParsedCommand& command, Steps& steps) {
  const auto* slot = board_.settings.find(command.key);
  if (slot == nullptr || slot->match.row->group != kSpindleGroup || slot->match.row->id == setting::kMode) return;
  if (board_.interpreter.state().modal.spindle != gcode::SpindleDirection::Off) {
    const std::chrono::duration<double> wait{board_.settings.number(setting::kSpindleDownDelay)};
    if (wait.count() > 0) steps.emplace_back(Freeze{.duration = std::chrono::duration_cast<Duration>(wait)});
    board_.say(protocol::Feedback{.text = "Spindle turned off with setting change"});
  }
  board_.interpreter.stop_spindle();
  Accessories wanted = board_.accessories;
  wanted.spindle = gcode::SpindleDirection::Off;
  wanted.programmed_rpm = 0;
  board_.set_accessories(wanted);
}

}  // namespace kerf::firmware
