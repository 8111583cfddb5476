#include "sender/session/refusals.hpp"

#include "common/base/text.hpp"
#include "common/vocabulary/realtime.hpp"

namespace kerf::session {

std::string sentence_of(Refused reason) {
  switch (reason) {
    case Refused::NotConnected: return "No controller is connected; open a link first.";
    case Refused::NotIdentified: return "The controller is not known yet; wait until the connection is complete.";
    case Refused::PendantInControl:
      return "A pendant has the machine: release it there, or take control back. Hold, stop and reset still work, as "
             "far as the controller hears this link.";
    case Refused::MachineNotIdle: return "The machine is not idle; wait until it stands still, or stop it.";
    case Refused::MachineInAlarm: return "The machine is in alarm; find the cause, then unlock, home or reset it.";
    case Refused::ForeignMotion: return "The machine is moving and Kerf did not start it; wait until it stands still.";
    case Refused::JobUnderWay: return "A job is under way; stop it first.";
    case Refused::NoJob: return "There is no job to do that with.";
    case Refused::NotAtRest: return "The machine is not in a finished hold; resume when it stands still.";
    case Refused::LineTooLong: return "The line is longer than this controller takes.";
    case Refused::RealtimeInLine:
      return "The line holds a character that a controller would obey at once (?, !, ~) or that is not plain ASCII.";
    case Refused::SettingsUnderWay: return "Settings are being changed; wait until that is done.";
    case Refused::NeverSent: return "This is known to crash or confuse controllers and is never sent.";
    case Refused::NotAnswering:
      return "The machine does not answer; wait until it does, or check cable and power. Hold, stop and reset are sent "
             "all the same.";
    case Refused::NoPendant: return "No pendant has the machine; there is nothing to take back.";
    case Refused::NotAtToolChange: return "The job waits for a tool: this cannot be sent meanwhile.";
    case Refused::ControlNotGiven: return "This controller does not give control back on request.";
  }
  return "The command cannot be obeyed now.";
}

bool crashes_controller(std::string_view line) {
  const std::string_view text = base::trim(line);
  return base::iequals(text, "$RST") || base::iequals(text, "$FF");
}

bool stops_or_asks(unsigned char byte) {
  switch (static_cast<vocabulary::Realtime>(byte)) {
    case vocabulary::Realtime::StatusQuery:
    case vocabulary::Realtime::StatusQueryAlternate:
    case vocabulary::Realtime::FullStatus:
    case vocabulary::Realtime::ParserReport:
    case vocabulary::Realtime::FeedHold:
    case vocabulary::Realtime::FeedHoldAlternate:
    case vocabulary::Realtime::SafetyDoor:
    case vocabulary::Realtime::JogCancel:
    case vocabulary::Realtime::Stop:
    case vocabulary::Realtime::SoftReset: return true;
    default: return false;
  }
}

bool is_never_sent(unsigned char byte) {
  return byte == 0x03 || byte == 0x06 || byte == 0xA2;
}

}  // namespace kerf::session
