#pragma once
// Axes, their letters and order: XYZ first on every firmware, then ABC, then UV (grblHAL only).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace kerf::vocabulary {

enum class Axis : std::uint8_t { X, Y, Z, A, B, C, U, V };

/// Most axes that any of the three firmwares drives (grblHAL; Rabbit has 6, Grbl 3).
inline constexpr std::size_t kMaxAxes = 8;
inline constexpr std::string_view kAxisLetters = "XYZABCUV";

/// One value an axis, in axis order; the unit is said where it is used. Floats, because all three firmwares compute in
/// 32 bits.
using AxisValues = std::array<float, kMaxAxes>;
/// Motor steps from machine zero, in axis order.
using AxisSteps = std::array<std::int32_t, kMaxAxes>;
/// Bit n is axis n.
using AxisMask = std::uint8_t;

[[nodiscard]] constexpr std::size_t index_of(Axis axis) {
  return static_cast<std::size_t>(axis);
}
[[nodiscard]] constexpr char letter_of(Axis axis) {
  return kAxisLetters[index_of(axis)];
}
[[nodiscard]] constexpr AxisMask mask_of(Axis axis) {
  return static_cast<AxisMask>(1U << index_of(axis));
}

/// The axis that an upper-case letter names.
[[nodiscard]] constexpr std::optional<Axis> axis_of(char letter) {
  const auto at = kAxisLetters.find(letter);
  if (at == std::string_view::npos) return std::nullopt;
  return static_cast<Axis>(at);
}

}  // namespace kerf::vocabulary
