#include "common/base/duration_text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::base {

std::optional<Duration> parse_duration(std::string_view text) {
  // `ms` before `s`, which it ends in.
  static constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{{{"min", 60.0}, {"ms", 1e-3}, {"s", 1.0}}};
  for (const auto& [unit, seconds] : kUnits) {
    if (!text.ends_with(unit)) continue;
    const auto number = parse_decimal(text.substr(0, text.size() - unit.size()));
    if (!number || *number < 0) return std::nullopt;
    return from_seconds(*number * seconds);
  }
  return std::nullopt;
}

std::string clock_text(double seconds) {
  constexpr std::int64_t kMinute = 60;
  constexpr std::int64_t kHour = 3600;
  // Longer than any job, and within the range of the integer.
  constexpr double kMost = 1e12;
  const auto whole = static_cast<std::int64_t>(std::clamp(seconds, 0.0, kMost));
  const auto two_digits = [](std::int64_t value) { return (value < 10 ? "0" : "") + std::to_string(value); };
  const std::string minutes = whole >= kHour
                                  ? std::to_string(whole / kHour) + ":" + two_digits(whole / kMinute % kMinute)
                                  : std::to_string(whole / kMinute);
  return minutes + ":" + two_digits(whole % kMinute);
}

}  // namespace kerf::base
