#pragma once
// Numbers as the firmwares read and convert them: at most eight or nine digits count, no exponent, float steps whose
// rounding shows.

#include <cstdint>

#include "common/gcode/rules.hpp"

namespace kerf::gcode {

/// C's conversions without a range check as the recorded firmware performs them: what does not fit becomes the lowest
/// value, of which the narrow types keep the low bits.
[[nodiscard]] std::int32_t to_int32(double value);
[[nodiscard]] std::uint8_t to_uint8(double value);
[[nodiscard]] std::uint16_t to_uint16(double value);
[[nodiscard]] std::uint32_t to_uint32(double value);
[[nodiscard]] std::uint64_t to_uint64(double value);

/// `value * factor` where the factor is a literal of the source: in float or in double.
[[nodiscard]] inline float times_literal(FloatRule rule, float value, double factor) {
  if (rule == FloatRule::PromotedLiterals) return static_cast<float>(static_cast<double>(value) * factor);
  return value * static_cast<float>(factor);
}

[[nodiscard]] inline float inches_to_mm(FloatRule rule, float inches) {
  return times_literal(rule, inches, 25.4);
}

/// Reads a number at `text[at]` of a NUL-terminated text and moves `at` behind it; false, with `at` unmoved, if there
/// is no digit. `at` wraps at 256 like the firmwares' 8-bit counters.
[[nodiscard]] bool read_float(const GcodeRules& rules, const char* text, std::uint8_t& at, float& value);

/// grblHAL's reader for O: whole, not negative.
[[nodiscard]] vocabulary::ErrorCode read_whole(const char* text, std::uint8_t& at, std::uint32_t& value);

/// Closer to a whole number than 0.001 (grblHAL).
[[nodiscard]] bool is_whole(float value);

}  // namespace kerf::gcode
