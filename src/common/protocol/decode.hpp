#pragma once
// One line of a controller to a message. Total: whatever cannot be read is `Unrecognized`, with the line in it.

#include <string_view>

#include "common/protocol/message.hpp"

namespace kerf::protocol {

/// The message that `line` (without line ends) is. Never throws but for memory; looks at nothing but `line`.
[[nodiscard]] Message decode(std::string_view line);

/// `<...>` with the fields in any order; nothing if it is not a status report. Unknown fields are kept.
[[nodiscard]] std::optional<StatusReport> decode_status(std::string_view line);

/// Greetings of the whole family: `Grbl 1.1h [...`, `GrblHAL ...`, `Rabbit GRBL v1.6.0 ...`, `Grbl 3.7 [FluidNC ...`.
[[nodiscard]] std::optional<Welcome> decode_welcome(std::string_view line);

}  // namespace kerf::protocol
