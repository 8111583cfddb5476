#pragma once
// Two ways to say `?`, `!` and `~`, and what becomes of them inside a line (protocol.md 2).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/realtime.hpp"

namespace kerf::machine {

/// A line whose characters may be text: `$` and `[` lines, and comments.
[[nodiscard]] bool carries_text(std::string_view line);

/// The byte for `command`. While a line that carries text may be on its way, the top-bit-set twin where the firmware
/// has one, because the printable one could end up in the text.
[[nodiscard]] std::uint8_t byte_for(vocabulary::Realtime command, const vocabulary::Dialect& dialect,
                                    bool text_under_way);

/// Why `line` cannot be sent: one sentence about the first byte that the controller would obey or drop instead of
/// storing it. `texts_keep` where the controller is set to keep `?`, `!` and `~` in texts (grblHAL `$39`=0, `RT-`).
[[nodiscard]] std::optional<std::string> why_eaten(std::string_view line, const vocabulary::Dialect& dialect,
                                                   bool texts_keep);

}  // namespace kerf::machine
