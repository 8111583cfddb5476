#include "firmware/hardware.hpp"

#include <array>

#include "common/base/text.hpp"

namespace kerf::firmware {

std::optional<gcode::PortCounts> parse_port_counts(std::string_view text) {
  std::array<int, 4> counts{};
  const auto words = base::split(text, ',');
  if (words.size() != counts.size()) return std::nullopt;
  for (std::size_t index = 0; index < counts.size(); ++index) {
    const auto count = base::parse_int<int>(base::trim(words[index]));
    if (!count || *count < 0) return std::nullopt;
    counts.at(index) = *count;
  }
  return gcode::PortCounts{.digital_inputs = counts[0],
                           .digital_outputs = counts[1],
                           .analog_inputs = counts[2],
                           .analog_outputs = counts[3]};
}

}  // namespace kerf::firmware
