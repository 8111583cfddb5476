#pragma once
// How fast a virtual controller's clock runs beside the real one.

#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::io {

/// Virtual seconds per real second; without a factor the clock jumps from event to event ("max").
struct Speed {
  std::optional<double> factor = 1.0;

  [[nodiscard]] bool is_max() const { return !factor.has_value(); }
  bool operator==(const Speed&) const = default;
};

/// Slowest and fastest factor that makes sense to a person; faster than this is what `max` is for.
inline constexpr double kLeastSpeed = 0.01;
inline constexpr double kMostSpeed = 1000.0;

enum class SpeedFault { NotANumber, OutOfRange };

/// "max", "1", "2.5".
[[nodiscard]] std::expected<Speed, SpeedFault> parse_speed(std::string_view text);

[[nodiscard]] std::string to_string(const Speed& speed);

}  // namespace kerf::io
