#include "rehearsal/number_text.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

/// Digits that the firmware counts in front of the point: "0.5" has one.
int whole_digits(double value) {
  int digits = 1;
  // More than any number has that is written.
  constexpr int kEnough = 20;
  for (double rest = std::abs(value); rest >= 10.0 && digits < kEnough; rest /= 10.0) ++digits;
  return digits;
}

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

}  // namespace

std::string rounded_text(double value, int decimals) {
  std::string text = base::to_fixed(rounded(value, decimals), decimals);
  if (text.contains('.')) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string number_text(double value, double tolerance) {
  const int most = std::max(kMostDigits - whole_digits(value), 0);
  int decimals = 0;
  while (decimals < most && std::abs(rounded(value, decimals) - value) > tolerance) ++decimals;
  return rounded_text(value, decimals);
}

std::string length_text(double value, double mm_per_unit) {
  // Sums of decimal numbers are decimal numbers, apart from the last bits of a double.
  constexpr double kNothing = 1e-9;
  constexpr int kMostExact = 6;
  const int most = std::min(kMostDigits - whole_digits(value), kMostExact);
  for (int decimals = 0; decimals <= most; ++decimals) {
    if (std::abs(rounded(value, decimals) - value) <= kNothing) return rounded_text(value, decimals);
  }
  return number_text(value, kLengthTolerance_mm / mm_per_unit);
}

}  // namespace kerf::rehearsal
