#include "common/gcode/print_number.hpp"

#include <array>
#include <charconv>

#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

/// grblHAL core nuts_bolts.c.
constexpr std::array<float, 10> kHalfOfLastPlace = {0.5F,      0.05F,      0.005F,      0.0005F,      0.00005F,
                                                    0.000005F, 0.0000005F, 0.00000005F, 0.000000005F, 0.0000000005F};

float shifted(float value, int decimals) {
  for (; decimals >= 2; decimals -= 2) value *= 100.0F;
  return decimals > 0 ? value * 10.0F : value;
}

/// `digits` with leading zeros up to `width`; more digits than that stay.
void append_padded(std::uint32_t digits, std::size_t width, std::string& out) {
  const std::string text = std::to_string(digits);
  if (text.size() < width) out.append(width - text.size(), '0');
  out += text;
}

void append_scaled(float value, int decimals, std::string& out) {
  const auto places = static_cast<std::size_t>(decimals);
  const std::size_t start = out.size();
  append_padded(to_uint32(static_cast<double>(shifted(value, decimals) + 0.5F)), places + 1, out);
  if (places > 0) out.insert(start + (out.size() - start) - places, 1, '.');
}

void append_split(float value, int decimals, std::string& out) {
  value += kHalfOfLastPlace[static_cast<std::size_t>(decimals)];
  const std::uint32_t whole = to_uint32(static_cast<double>(value));
  out += std::to_string(whole);
  out += '.';
  if (decimals == 0) return;
  const auto fraction = to_uint32(static_cast<double>(shifted(value - static_cast<float>(whole), decimals)));
  std::string digits;
  append_padded(fraction, static_cast<std::size_t>(decimals), digits);
  out += digits.substr(digits.size() - static_cast<std::size_t>(decimals));
}

void append_printed(float value, int decimals, std::string& out) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  out.append(text.data(), end.ptr);
}

}  // namespace

void append_number(NumberPrinter printer, float value, int decimals, std::string& out) {
  if (printer == NumberPrinter::Printf) return append_printed(value, decimals, out);
  if (value < 0.0F) {
    out += '-';
    value = -value;
  }
  if (printer == NumberPrinter::ScaleThenCut) {
    append_scaled(value, decimals, out);
  } else {
    append_split(value, decimals, out);
  }
}

}  // namespace kerf::gcode
