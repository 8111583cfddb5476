#pragma once
// Scanning and printing text without locale, exceptions or surprises. All of it is ASCII: bytes above 0x7F are left
// alone.

#include <charconv>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace kerf::base {

[[nodiscard]] constexpr bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

[[nodiscard]] constexpr bool is_blank(char letter) {
  return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\n' || letter == '\v' || letter == '\f';
}

[[nodiscard]] constexpr char to_upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

/// `text` without blanks at both ends; a view into the same bytes.
[[nodiscard]] std::string_view trim(std::string_view text);

/// The parts of `text` between `separator`s: at least one, at most `most` (which is at least 1). The last part keeps
/// whatever separators are left, so a free text at the end of a row may contain them.
[[nodiscard]] std::vector<std::string_view> split_at_most(std::string_view text, char separator, std::size_t most);

/// Every part of `text` between `separator`s; the empty text has one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

[[nodiscard]] bool iequals(std::string_view left, std::string_view right);

[[nodiscard]] bool starts_with_ignoring_case(std::string_view text, std::string_view prefix);

/// The integer that `text` spells from its first to its last character: no blanks, no `+`, no overflow.
template <std::integral Integer = int>
[[nodiscard]] std::optional<Integer> parse_int(std::string_view text, int radix = 10) {
  Integer value{};
  const char* const end = text.data() + text.size();
  const auto [stopped_at, error] = std::from_chars(text.data(), end, value, radix);
  if (error != std::errc{} || stopped_at != end) return std::nullopt;
  return value;
}

/// The finite number that `text` spells from its first to its last character, such as `-12.5`, `.5` or `3.`:
/// no blanks, `+`, exponent, `inf` or `nan`.
[[nodiscard]] std::optional<double> parse_decimal(std::string_view text);

/// Appends `value` with exactly `decimals` digits (0 to 9) after the point; no point when there are none.
///
/// Signs and ties follow Grbl's printFloat and grblHAL's ftoa (gnea/grbl print.c, grblHAL nuts_bolts.c), which both
/// test `n < 0` and then add half a digit: a tiny negative prints as `-0.000`, negative zero as `0.000`, and an exact
/// tie goes away from zero (0.0625 is `0.063`). Rabbit GRBL prints with printf, which differs in exactly these two
/// cases
/// (`-0.000` for negative zero, `0.062`). All firmware does it in float arithmetic, so for a value within a float's
/// rounding of a tie the last digit may differ.
void append_fixed(std::string& out, double value, int decimals);

/// `append_fixed` into a new string.
[[nodiscard]] std::string to_fixed(double value, int decimals);

/// How the bytes that have no letter and no name are written, and whether the text stands in quotes.
struct EscapeStyle {
  std::string_view code_prefix = "\\x";
  std::string_view hex_digits = "0123456789ABCDEF";
  bool in_quotes = false;
};

/// Appends `bytes` so that a person can read them: printable ASCII as it is, backslash doubled, `\r`, `\n` and `\t` by
/// name, every other byte as `\x1B`.
void append_escaped(std::string& out, std::string_view bytes, const EscapeStyle& style = {});

/// `append_escaped` into a new string.
[[nodiscard]] std::string escape(std::string_view bytes);

/// The bytes that `escape` shows as `text`; nothing when an escape is unknown or incomplete.
[[nodiscard]] std::optional<std::string> unescape(std::string_view text);

}  // namespace kerf::base
