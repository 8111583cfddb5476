#include "common/base/duration_text.hpp"

#include <array>
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

}  // namespace kerf::base
