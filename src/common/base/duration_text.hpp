#pragma once
// Durations as people write them.

#include <optional>
#include <string>
#include <string_view>

#include "common/base/time.hpp"

namespace kerf::base {

/// `200ms`, `1.5s` or `2min`, from the first to the last character; nothing for a negative one.
[[nodiscard]] std::optional<Duration> parse_duration(std::string_view text);

/// "4:05", "1:02:09"; seconds are cut, not rounded.
[[nodiscard]] std::string clock_text(double seconds);

}  // namespace kerf::base
