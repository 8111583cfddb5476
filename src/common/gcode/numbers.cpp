#include "common/gcode/numbers.hpp"

#include <cmath>
#include <limits>

namespace kerf::gcode {

using vocabulary::ErrorCode;

namespace {

constexpr double kTwoTo63 = 9223372036854775808.0;

/// Digits read so far. The exponent wraps at eight bits as in the firmwares, for absurd lengths.
struct Digits {
  std::uint32_t whole = 0;
  int exponent = 0;
  std::uint8_t count = 0;
  bool seen = false;

  void step_exponent(int by) { exponent = ((exponent + by + 128) & 0xFF) - 128; }
};

/// Scales by powers of ten in the firmwares' order: hundredths, a last tenth, or tens.
float scaled(FloatRule rule, const Digits& digits) {
  auto value = static_cast<float>(digits.whole);
  int exponent = digits.exponent;
  if (digits.whole == 0) return value;
  for (; exponent <= -2; exponent += 2) value = times_literal(rule, value, 0.01);
  if (exponent < 0) value = times_literal(rule, value, 0.1);
  for (; exponent > 0; --exponent) value = times_literal(rule, value, 10.0);
  return value;
}

}  // namespace

std::int32_t to_int32(double value) {
  if (value > -2147483649.0 && value < 2147483648.0) return static_cast<std::int32_t>(value);
  return std::numeric_limits<std::int32_t>::min();
}

std::uint8_t to_uint8(double value) {
  return static_cast<std::uint8_t>(to_int32(value));
}

std::uint16_t to_uint16(double value) {
  return static_cast<std::uint16_t>(to_int32(value));
}

std::uint32_t to_uint32(double value) {
  if (value >= -kTwoTo63 && value < kTwoTo63) return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
  return 0;
}

std::uint64_t to_uint64(double value) {
  if (value >= -kTwoTo63 && value < kTwoTo63) return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
  if (value >= kTwoTo63 && value < 2.0 * kTwoTo63) return static_cast<std::uint64_t>(value);
  return 0;
}

bool read_float(const GcodeRules& rules, const char* text, std::uint8_t& at, float& value) {
  std::uint8_t next = at;
  const bool negative = text[next] == '-';
  if (negative || text[next] == '+') ++next;

  Digits digits;
  bool in_decimals = false;
  for (;; ++next) {
    const char c = text[next];
    if (c >= '0' && c <= '9') {
      digits.seen = true;
      if (rules.counts_leading_zeros || c != '0' || digits.whole != 0) ++digits.count;
      if (digits.count <= rules.digits_max) {
        if (in_decimals) digits.step_exponent(-1);
        digits.whole = digits.whole * 10 + static_cast<std::uint32_t>(c - '0');
      } else if (!in_decimals) {
        digits.step_exponent(1);
      }
    } else if (c == '.' && !in_decimals) {
      in_decimals = true;
    } else {
      break;
    }
  }
  if (!digits.seen) return false;

  value = scaled(rules.floats, digits);
  if (negative) value = -value;
  at = next;
  return true;
}

ErrorCode read_whole(const char* text, std::uint8_t& at, std::uint32_t& value) {
  std::uint8_t next = at;
  if (text[next] == '-') return ErrorCode::NegativeValue;
  if (text[next] == '+') ++next;

  std::uint32_t whole = 0;
  int count = 0;
  bool seen = false;
  bool in_decimals = false;
  for (;; ++next) {
    const char c = text[next];
    if (c >= '0' && c <= '9') {
      const auto digit = static_cast<std::uint32_t>(c - '0');
      seen = true;
      if (in_decimals && digit != 0) return ErrorCode::CommandValueNotInteger;
      if (!in_decimals && (digit != 0 || whole != 0)) ++count;
      if ((count <= 9 || digit <= 4) && whole <= 429496729U) whole = whole * 10 + digit;
    } else if (c == '.' && !in_decimals) {
      in_decimals = true;
    } else {
      break;
    }
  }
  if (!seen) return ErrorCode::BadNumberFormat;
  value = whole;
  at = next;
  return ErrorCode::Ok;
}

bool is_whole(float value) {
  return !std::isnan(value) && std::fabs(value - std::trunc(value)) < 0.001F;
}

}  // namespace kerf::gcode
