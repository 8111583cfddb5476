#include "common/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kerf::base {

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split_at_most(std::string_view text, char separator, std::size_t most) {
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < most) {
    const std::size_t at = text.find(separator);
    if (at == std::string_view::npos) break;
    parts.push_back(text.substr(0, at));
    text.remove_prefix(at + 1);
  }
  parts.push_back(text);
  return parts;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  return split_at_most(text, separator, text.size() + 1);
}

bool iequals(std::string_view left, std::string_view right) {
  return std::ranges::equal(left, right, {}, to_upper, to_upper);
}

bool starts_with_ignoring_case(std::string_view text, std::string_view prefix) {
  return text.size() >= prefix.size() && iequals(text.substr(0, prefix.size()), prefix);
}

std::optional<double> parse_decimal(std::string_view text) {
  const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
  // from_chars would read `inf` and `nan`.
  if (digits.empty() || (!is_digit(digits.front()) && digits.front() != '.')) return std::nullopt;
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped_at, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (error != std::errc{} || stopped_at != end) return std::nullopt;
  return value;
}

void append_fixed(std::string& out, double value, int decimals) {
  static constexpr std::array kPowers{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  const auto places = static_cast<std::size_t>(std::clamp(decimals, 0, 9));
  const double scaled = std::abs(value) * kPowers[places];

  // Beyond 2^53 (and for infinities) a double has no digits after the point that could need rounding.
  constexpr double kExactIntegers = 9007199254740992.0;
  std::array<char, 400> digits{};
  if (!(scaled < kExactIntegers)) {
    const auto result =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals);
    out.append(digits.data(), result.ptr);
    return;
  }

  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), std::llround(scaled));
  const auto count = static_cast<std::size_t>(result.ptr - digits.data());
  if (value < 0) out += '-';
  const std::size_t whole = count > places ? count - places : 0;
  if (whole == 0) out += '0';
  out.append(digits.data(), whole);
  if (places == 0) return;
  out += '.';
  if (count < places) out.append(places - count, '0');
  out.append(digits.data() + whole, count - whole);
}

std::string to_fixed(double value, int decimals) {
  std::string out;
  append_fixed(out, value, decimals);
  return out;
}

void append_escaped(std::string& out, std::string_view bytes, const EscapeStyle& style) {
  for (const char byte : bytes) {
    switch (byte) {
      case '\\': out += "\\\\"; continue;
      case '\r': out += "\\r"; continue;
      case '\n': out += "\\n"; continue;
      case '\t': out += "\\t"; continue;
      default: break;
    }
    if (byte == '"' && style.in_quotes) out += '\\';
    if (byte >= ' ' && byte <= '~') {
      out += byte;
      continue;
    }
    const auto code = static_cast<unsigned char>(byte);
    out += style.code_prefix;
    out += style.hex_digits[code >> 4U];
    out += style.hex_digits[code & 0xFU];
  }
}

std::string escape(std::string_view bytes) {
  std::string out;
  append_escaped(out, bytes);
  return out;
}

std::optional<std::string> unescape(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    if (text.front() != '\\') {
      out += text.front();
      text.remove_prefix(1);
      continue;
    }
    if (text.size() < 2) return std::nullopt;
    std::size_t used = 2;
    switch (text[1]) {
      case '\\': out += '\\'; break;
      case 'r': out += '\r'; break;
      case 'n': out += '\n'; break;
      case 't': out += '\t'; break;
      case 'x': {
        const auto code = parse_int<std::uint8_t>(text.substr(2, 2), 16);
        if (!code || text.size() < 4) return std::nullopt;
        out += static_cast<char>(*code);
        used = 4;
        break;
      }
      default: return std::nullopt;
    }
    text.remove_prefix(used);
  }
  return out;
}

}  // namespace kerf::base
