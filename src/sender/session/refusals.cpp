#include "sender/session/refusals.hpp"

#include <algorithm>

#include "common/base/text.hpp"

namespace kerf::session {

std::string sentence_of(Refused reason) {
  switch (reason) {
    case Refused::NotConnected: return "No controller is connected; open a link first.";
    case Refused::NotIdentified: return "The controller is not known yet; wait until the connection is complete.";
    case Refused::PendantInControl: return "A pendant has the machine; release it there first.";
    case Refused::MachineNotIdle: return "The machine is not idle; wait until it stands still, or stop it.";
    case Refused::MachineInAlarm: return "The machine is in alarm; find the cause, then unlock, home or reset it.";
    case Refused::JobUnderWay: return "A job is under way; stop it first.";
    case Refused::NoJob: return "There is no job to do that with.";
    case Refused::NotAtRest: return "The machine is not in a finished hold; resume when it stands still.";
    case Refused::LineTooLong: return "The line is longer than this controller takes.";
    case Refused::RealtimeInLine:
      return "The line holds a character that a controller would obey at once (?, !, ~) or that is not plain ASCII.";
    case Refused::SettingsUnderWay: return "Settings are being changed; wait until that is done.";
    case Refused::NeverSent: return "This is known to crash or confuse controllers and is never sent.";
  }
  return "The command cannot be obeyed now.";
}

bool holds_realtime_bytes(std::string_view line) {
  return std::ranges::any_of(line, [](char letter) {
    const bool printable = letter >= ' ' && letter <= '~';
    return !printable || letter == '?' || letter == '!' || letter == '~';
  });
}

bool crashes_controller(std::string_view line) {
  const std::string_view text = base::trim(line);
  return base::iequals(text, "$RST") || base::iequals(text, "$FF");
}

bool is_never_sent(unsigned char byte) {
  return byte == 0x03 || byte == 0x06 || byte == 0xA2;
}

}  // namespace kerf::session
