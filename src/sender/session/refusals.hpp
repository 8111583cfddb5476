#pragma once
// Why a command was not obeyed, in words, and which lines are never sent.

#include <string>
#include <string_view>

#include "sender/session/command.hpp"

namespace kerf::session {

/// One sentence: what was refused and what to do.
[[nodiscard]] std::string sentence_of(Refused reason);

/// A realtime byte that makes nothing move and switches nothing on: allowed while a pendant has the machine.
[[nodiscard]] bool stops_or_asks(unsigned char byte);

/// `$RST` and `$FF` without a value crash grblHAL (protocol.md 11, rule 15).
[[nodiscard]] bool crashes_controller(std::string_view line);

/// 0x03, 0x06 and 0xA2 desynchronise or end a controller (protocol.md 11, rule 15).
[[nodiscard]] bool is_never_sent(unsigned char byte);

}  // namespace kerf::session
