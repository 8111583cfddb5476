#pragma once
// Which rate a controller speaks, guessed from what its words look like at the wrong one.

#include <optional>
#include <string>
#include <string_view>

namespace kerf::machine {

/// What becomes of a byte without its stop bit: drivers differ (Linux serial_core, IGNPAR).
enum class BadFrames { Kept, Dropped };

/// What a receiver at `read_baud` makes of `text` sent without pauses at `sent_baud` (8N1).
[[nodiscard]] std::string heard_at(std::string_view text, int sent_baud, int read_baud, BadFrames bad);

/// The rate at which a Grbl, Rabbit or grblHAL would have been heard as `heard` by a port set to `read_baud`; empty
/// when no rate explains it clearly better than the others. Never `read_baud` itself.
[[nodiscard]] std::optional<int> guess_baud(std::string_view heard, int read_baud);

}  // namespace kerf::machine
