#include "io/speed.hpp"

#include <charconv>

#include <fmt/format.h>

namespace kerf::io {

std::expected<Speed, SpeedFault> parse_speed(std::string_view text) {
  if (text == "max") return Speed{.factor = std::nullopt};
  double factor = 0;
  const char* end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, factor, std::chars_format::fixed);
  if (fault != std::errc{} || stop != end) return std::unexpected(SpeedFault::NotANumber);
  if (!(factor >= kLeastSpeed && factor <= kMostSpeed)) return std::unexpected(SpeedFault::OutOfRange);
  return Speed{.factor = factor};
}

std::string to_string(const Speed& speed) {
  return speed.is_max() ? "max" : fmt::format("{}", *speed.factor);
}

}  // namespace kerf::io
