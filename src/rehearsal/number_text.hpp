#pragma once
// Numbers of G-code words: as short as they can be without being somewhere else.

#include <string>

namespace kerf::rehearsal {

/// Firmware looks at this many digits; further ones only shift the number (Grbl: MAX_INT_DIGITS).
inline constexpr int kMostDigits = 8;

/// The shortest decimal number that lies within `tolerance` of `value`, as far as kMostDigits reach; no zeros at the
/// end, no "-0".
[[nodiscard]] std::string number_text(double value, double tolerance);

/// Programs are written to this, mm: a hundredth of a step of most machines.
inline constexpr double kLengthTolerance_mm = 6e-6;

/// A length in the unit of its line. What is a decimal number of some digits stays exactly that; everything else is
/// rounded to kLengthTolerance_mm.
[[nodiscard]] std::string length_text(double value, double mm_per_unit);

/// With at most `decimals` behind the point, rounded.
[[nodiscard]] std::string rounded_text(double value, int decimals);

}  // namespace kerf::rehearsal
