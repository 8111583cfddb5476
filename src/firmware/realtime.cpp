#include "firmware/realtime.hpp"

#include <algorithm>

namespace kerf::firmware {

using Byte = vocabulary::Realtime;

namespace {

constexpr int kCoarse = 10;
constexpr int kFine = 1;
constexpr int kRapidMedium = 50;
constexpr int kRapidLow = 25;
constexpr int kRapidExtraLow = 5;

bool is_override(std::uint8_t byte) {
  return byte >= static_cast<std::uint8_t>(Byte::FeedOverrideReset) &&
         byte <= static_cast<std::uint8_t>(Byte::MistToggle);
}

/// `percent` after one press, or nothing if `byte` is about another override.
std::optional<int> pressed(Byte byte, Byte reset, int percent) {
  switch (static_cast<int>(byte) - static_cast<int>(reset)) {
    case 0: return 100;
    case 1: return percent + kCoarse;
    case 2: return percent - kCoarse;
    case 3: return percent + kFine;
    case 4: return percent - kFine;
    default: return std::nullopt;
  }
}

std::optional<int> rapid_of(Byte byte) {
  switch (byte) {
    case Byte::RapidOverrideReset: return 100;
    case Byte::RapidOverrideMedium: return kRapidMedium;
    case Byte::RapidOverrideLow: return kRapidLow;
    case Byte::RapidOverrideExtraLow: return kRapidExtraLow;
    default: return std::nullopt;
  }
}

}  // namespace

void Realtime::act(std::uint8_t value) {
  const auto byte = static_cast<Byte>(value);
  if (!vocabulary::acts_on(board_.personality.firmware, byte)) return;
  if (is_override(value)) {
    if (!is_repeated(value)) act_on_overrides(byte);
    return;
  }
  if (act_on_motion(byte) || act_on_reports(byte)) return;
  act_on_switches(byte);
}

bool Realtime::is_repeated(std::uint8_t byte) {
  // Grbl notes an override byte as a flag, so a second one before the main loop looks is lost (motion.md 1.5).
  if (!board_.personality.realtime.same_instant_collapses) return false;
  if (overridden_at_ != board_.now) overridden_ = {};
  overridden_at_ = board_.now;
  if (overridden_.contains(byte)) return true;
  overridden_.add(byte);
  return false;
}

void Realtime::reset() {
  const bool stop_pressed = board_.workcell.is_active(Input::EmergencyStop);
  if (stop_pressed && board_.personality.start.has_homing_alarm) return;
  foreground_.reset();
}

bool Realtime::act_on_motion(Byte byte) {
  switch (byte) {
    case Byte::SoftReset:
    case Byte::Exit: reset(); return true;
    case Byte::Stop:
      if (board_.state == MachineState::Home || board_.critical) return true;
      foreground_.abandon_line();
      cycle_.stop();
      return true;
    case Byte::CycleStart:
    case Byte::CycleStartAlternate:
      if (board_.state == MachineState::Tool) {
        foreground_.go_on_with_tool_change();
      } else {
        cycle_.cycle_start();
      }
      return true;
    case Byte::FeedHold:
    case Byte::FeedHoldAlternate: cycle_.feed_hold(); return true;
    case Byte::SafetyDoor: foreground_.open_door(); return true;
    case Byte::JogCancel:
      if (board_.personality.dialect().jog_cancel_flushes_rx) {
        receiver_.cancel();
      } else {
        cycle_.jog_cancel();
      }
      return true;
    case Byte::ToolChangeAcknowledge: foreground_.acknowledge_tool_change(); return true;
    default: return false;
  }
}

bool Realtime::act_on_reports(Byte byte) {
  switch (byte) {
    case Byte::StatusQuery: foreground_.request_status(false); return true;
    case Byte::StatusQueryAlternate:
    case Byte::Enquiry:
      if (!board_.auto_reporting) foreground_.request_status(false);
      return true;
    case Byte::FullStatus: foreground_.request_status(true); return true;
    case Byte::ParserReport: reporter_.say_parser_state(); return true;
    case Byte::PidReport:
      // grblHAL protocol.c: answered although nobody asked by line, as the core logs no PID values.
      board_.say(protocol::ErrorAnswer{.code = vocabulary::number_of(ErrorCode::UnsupportedCommand)});
      return true;
    case Byte::AutoReportToggle:
      if (board_.settings.number(setting::kAutoReport) > 0) board_.auto_reporting = !board_.auto_reporting;
      return true;
    default: return false;
  }
}

void Realtime::act_on_switches(Byte byte) {
  switch (byte) {
    case Byte::OptionalStopToggle:
      board_.switches.optional_stop_disabled = !board_.switches.optional_stop_disabled;
      board_.apply_settings();
      break;
    case Byte::SingleBlockToggle: board_.switches.single_block = !board_.switches.single_block; break;
    default: break;
  }
}

void Realtime::act_on_overrides(Byte byte) {
  const vocabulary::Dialect& dialect = board_.personality.dialect();
  const auto limited = [&](int percent) {
    return std::clamp(percent, dialect.override_min_percent, dialect.override_max_percent);
  };
  const OverrideState before = board_.overrides;
  if (const auto feed = pressed(byte, Byte::FeedOverrideReset, before.feed)) {
    board_.overrides.feed = limited(*feed);
  } else if (const auto rapid = rapid_of(byte)) {
    board_.overrides.rapid = *rapid;
  } else if (const auto spindle = pressed(byte, Byte::SpindleOverrideReset, before.spindle)) {
    board_.overrides.spindle = limited(*spindle);
  } else if (byte == Byte::SpindleStopToggle) {
    cycle_.toggle_spindle_stop();
    return;
  } else {
    toggle_coolant(byte == Byte::FloodToggle);
    return;
  }
  const OverrideState& now = board_.overrides;
  if (now.feed != before.feed || now.rapid != before.rapid) board_.apply_overrides();
  if (now.feed != before.feed || now.rapid != before.rapid || now.spindle != before.spindle) board_.owe_overrides();
}

void Realtime::toggle_coolant(bool flood) {
  const RealtimeRules& rules = board_.personality.realtime;
  switch (board_.state) {
    case MachineState::Idle:
    case MachineState::Run:
    case MachineState::Hold: break;
    case MachineState::Jog:
      if (rules.toggles_coolant_in_jog) break;
      return;
    default: return;
  }
  if (!flood && !rules.mist_toggle) return;
  Accessories wanted = board_.accessories;
  bool& output = flood ? wanted.flood : wanted.mist;
  output = !output;
  board_.set_accessories(wanted);
  board_.interpreter.set_coolant({.flood = wanted.flood, .mist = wanted.mist});
}

}  // namespace kerf::firmware
