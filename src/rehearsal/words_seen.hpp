#pragma once
// Which words stand in a line, for questions that the interpreter's actions do not answer.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/vocabulary/axis.hpp"

namespace kerf::rehearsal {

using vocabulary::AxisMask;

[[nodiscard]] constexpr bool has_axis(AxisMask mask, std::size_t axis) {
  return ((mask >> axis) & 1U) != 0;
}
[[nodiscard]] constexpr AxisMask axis_bit(std::size_t axis) {
  return static_cast<AxisMask>(1U << axis);
}

struct WordsSeen {
  /// Bit n: the letter is there, A the first. G and M are looked at one by one.
  std::uint32_t letters = 0;
  bool machine_place = false;  ///< G28, G30, G53
  bool sets_zero = false;      ///< G10, G92
  bool inches = false;         ///< G20
  bool millimetres = false;    ///< G21
  bool has_lower_case = false;

  [[nodiscard]] bool has(char letter) const { return ((letters >> static_cast<unsigned>(letter - 'A')) & 1U) != 0; }
  /// Axes with a word of their own.
  [[nodiscard]] AxisMask axes() const;
};

/// Of a line in wire form.
[[nodiscard]] WordsSeen words_seen_in(std::string_view wire);

}  // namespace kerf::rehearsal
