#pragma once
// The time of day in files and on screens: UTC, to the millisecond. Any thread.

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::io {

using WallClock = std::chrono::sys_time<std::chrono::milliseconds>;

[[nodiscard]] WallClock wall_clock_now();

/// "2026-11-22T13:05:01.250Z"
[[nodiscard]] std::string to_string(WallClock moment);

/// Reads what to_string() writes; fraction and Z may be missing.
[[nodiscard]] std::optional<WallClock> parse_wall_clock(std::string_view text);

}  // namespace kerf::io
