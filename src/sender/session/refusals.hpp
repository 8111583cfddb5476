#pragma once
// Why a command was not obeyed, in words, and which lines are never sent.

#include <string>
#include <string_view>

#include "sender/session/command.hpp"

namespace kerf::session {

/// One sentence: what was refused and what to do.
[[nodiscard]] std::string sentence_of(Refused reason);

/// A line that would be taken for realtime commands or holds bytes that no controller stores (protocol.md 2, 11 rule
/// 3).
[[nodiscard]] bool holds_realtime_bytes(std::string_view line);

/// `$RST` and `$FF` without a value crash grblHAL (protocol.md 11, rule 15).
[[nodiscard]] bool crashes_controller(std::string_view line);

/// 0x03, 0x06 and 0xA2 desynchronise or end a controller (protocol.md 11, rule 15).
[[nodiscard]] bool is_never_sent(unsigned char byte);

}  // namespace kerf::session
