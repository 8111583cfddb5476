#include "firmware/pendant.hpp"

#include <chrono>

namespace kerf::firmware {

using Byte = vocabulary::Realtime;

namespace {

constexpr std::chrono::milliseconds kReportDelay{5};
constexpr StateSet kMayTakeOver = {MachineState::Idle, MachineState::Alarm};

}  // namespace

bool Pendant::take_unasked(std::uint8_t value) {
  const auto byte = static_cast<Byte>(value);
  switch (byte) {
    case Byte::MpgModeToggle: set_command(true); return true;
    case Byte::StatusQuery:
    case Byte::StatusQueryAlternate:
    case Byte::FullStatus: reporter_.say_status_to_pendant(receiver_.free(), byte == Byte::FullStatus); return true;
    case Byte::ParserReport: reporter_.say_parser_state(Port::Pendant); return true;
    case Byte::CycleStart:
    case Byte::CycleStartAlternate:
      // Shown in the next report, as from the start button.
      if (board_.state == MachineState::Idle) board_.report.cycle_start_pressed = true;
      return false;
    default: return !vocabulary::is_realtime(board_.personality.dialect(), value);
  }
}

void Pendant::set_command(bool on) {
  const bool refused =
      on && (board_.pendant_commands || board_.in_demarcated_program || !kMayTakeOver.contains(board_.state));
  report_at_ = board_.now + kReportDelay;
  reports_everything_ = on || refused;
  if (refused) return;
  const Port port = on ? Port::Pendant : Port::Main;
  board_.pendant_commands = on;
  board_.outbox.put_in_command(port);
  board_.report.mpg = true;
  receiver_.put_in_command(port);
  receiver_.clear();
  if (!on) reporter_.restart_pendant_counters();
}

void Pendant::advance() {
  if (board_.now < report_at_) return;
  report_at_ = kNever;
  if (reports_everything_ || !board_.auto_reporting) foreground_.request_status(reports_everything_);
}

}  // namespace kerf::firmware
