// How each firmware judges a new value for a setting (protocol.md 5.2, 7.1).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "common/base/text.hpp"
#include "firmware/leading_number.hpp"
#include "firmware/settings_store.hpp"

namespace kerf::firmware {

using vocabulary::SettingMatch;
using vocabulary::SettingRow;
using vocabulary::SettingType;
using Checked = std::expected<std::string, ErrorCode>;

namespace {

constexpr int kGrblShortestPulse = 3;
constexpr std::uint32_t kByte = 0xFF;

/// Digits that the firmware prints behind the point; its defaults show them.
int printed_decimals(const SettingRow& row) {
  const auto point = row.default_value.find('.');
  if (point == std::string_view::npos) return vocabulary::decimals_of(row);
  return static_cast<int>(row.default_value.size() - point - 1);
}

int items_in(std::string_view format) {
  return format.empty() ? 0 : static_cast<int>(std::ranges::count(format, ',')) + 1;
}

std::string print_decimal(const SettingRow& row, double value) {
  return base::to_fixed(value, printed_decimals(row));
}

bool below_minimum(const SettingRow& row, double value) {
  return row.min.has_value() && value < *row.min && !(row.allow_null && value == 0);
}
bool above_maximum(const SettingRow& row, double value) {
  return row.max.has_value() && value > *row.max;
}

/// One more than the largest value of a list or mask; 0 where only min and max count.
std::uint64_t count_of_values(const SettingRow& row, std::string_view format, int axes) {
  switch (row.type) {
    case SettingType::Bool: return 2;
    case SettingType::Bitfield:
    case SettingType::ExclusiveBitfield: return std::uint64_t{1} << static_cast<unsigned>(items_in(format));
    case SettingType::Radio: return static_cast<std::uint64_t>(items_in(format));
    case SettingType::Axes: return std::uint64_t{1} << static_cast<unsigned>(axes);
    default: return 0;
  }
}

Checked check_length(const SettingRow& row, std::string_view text, ErrorCode error) {
  const auto length = static_cast<double>(text.size());
  if (below_minimum(row, length) || above_maximum(row, length)) return std::unexpected(error);
  return std::string{text};
}

Checked check_decimal_grblhal(const SettingRow& row, std::string_view text) {
  const auto number = leading_number(text);
  if (!number) return std::unexpected(ErrorCode::BadNumberFormat);
  const auto value = static_cast<double>(number->value);
  if (!row.min.has_value() && value < 0) return std::unexpected(ErrorCode::NegativeValue);
  if (below_minimum(row, value) || above_maximum(row, value)) return std::unexpected(ErrorCode::SettingOutOfRange);
  return print_decimal(row, value);
}

/// What grblHAL's read_uint makes of a value: one `+`, digits, then anything; a point may only be followed by zeros.
std::optional<std::uint32_t> leading_count(std::string_view text) {
  constexpr std::uint32_t kTen = 10;
  constexpr std::uint32_t kMostBeforeDigit = 429496729;
  constexpr int kSafeDigits = 9;
  constexpr std::uint32_t kLastDigitMax = 4;
  if (text.starts_with('+')) text.remove_prefix(1);
  std::uint32_t value = 0;
  int digits = 0;
  bool behind_point = false;
  bool has_digit = false;
  for (const char letter : text) {
    if (letter == '.' && !behind_point) {
      behind_point = true;
      continue;
    }
    if (!base::is_digit(letter)) break;
    const auto digit = static_cast<std::uint32_t>(letter - '0');
    has_digit = true;
    if (!behind_point && (digit != 0 || value != 0)) ++digits;
    if (behind_point && digit != 0) return std::nullopt;
    // Zeros behind the point count as digits here too.
    if ((digits <= kSafeDigits || digit <= kLastDigitMax) && value <= kMostBeforeDigit) value = value * kTen + digit;
  }
  if (!has_digit) return std::nullopt;
  return value;
}

Checked check_integer_grblhal(const SettingsStore& store, const SettingMatch& match, std::string_view text) {
  const SettingRow& row = *match.row;
  const auto value = leading_count(text);
  if (!value) return std::unexpected(ErrorCode::BadNumberFormat);
  const std::uint64_t values = count_of_values(row, store.format_of(match), store.axes());
  const auto as_number = static_cast<double>(*value);
  if ((values != 0 && *value >= values) || below_minimum(row, as_number) || above_maximum(row, as_number)) {
    return std::unexpected(ErrorCode::SettingOutOfRange);
  }
  const bool all_off = row.type == SettingType::ExclusiveBitfield && (*value & 1U) == 0;
  return std::to_string(all_off ? 0U : *value);
}

bool is_text(SettingType type) {
  return type == SettingType::Text || type == SettingType::Password || type == SettingType::Ipv4;
}

/// A number as C's strtol reads it, cut to 32 bits; nothing may follow it.
std::optional<std::int32_t> whole_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const auto value = base::parse_int<std::int64_t>(text);
  if (!value) return std::nullopt;
  return static_cast<std::int32_t>(*value);
}

/// Rabbit: a mask, or the letters of the axes in any order (SourceRabbit/RabbitGRBL Settings.cpp).
Checked check_axes_rabbit(std::string_view text) {
  if (text.empty()) return "0";
  if (const auto mask = whole_number(text)) return std::to_string(*mask);
  unsigned mask = 0;
  for (const char letter : text) {
    const auto at = std::string_view{"XYZABC"}.find(base::to_upper(letter));
    if (at == std::string_view::npos) return std::unexpected(ErrorCode::BadNumberFormat);
    mask |= 1U << at;
  }
  return std::to_string(mask);
}

/// Rabbit: one of the names, or its number modulo 256.
Checked check_choice_rabbit(const SettingRow& row, std::string_view text) {
  const auto items = base::split(row.format, ',');
  for (const std::string_view item : items) {
    if (base::iequals(item, text)) return std::string{item};
  }
  const auto number = whole_number(text);
  const std::size_t at = number ? static_cast<std::uint32_t>(*number) & kByte : items.size();
  if (at >= items.size()) return std::unexpected(ErrorCode::BadNumberFormat);
  return std::string{items[at]};
}

bool needs_homing(const SettingRow& row) {
  return row.id == setting::kSoftLimits || (row.id == setting::kLimitJogs && row.type == SettingType::Bool);
}

}  // namespace

Checked check_setting_grblhal(const SettingsStore& store, const SettingMatch& match, std::string_view text) {
  const SettingRow& row = *match.row;
  while (text.starts_with(' ')) text.remove_prefix(1);
  Checked checked;
  switch (row.type) {
    case SettingType::Text:
    case SettingType::Password:
    case SettingType::Ipv4: return check_length(row, text, ErrorCode::SettingOutOfRange);
    case SettingType::Decimal: checked = check_decimal_grblhal(row, text); break;
    default: checked = check_integer_grblhal(store, match, text); break;
  }
  if (checked && needs_homing(row) && *checked != "0" && !store.flag(setting::kHoming)) {
    return std::unexpected(ErrorCode::SoftLimitNeedsHoming);
  }
  return checked;
}

Checked check_setting_grbl(const SettingsStore& store, const SettingMatch& match, std::string_view text) {
  const SettingRow& row = *match.row;
  const auto number = leading_number(text);
  if (!number) return std::unexpected(ErrorCode::BadNumberFormat);
  if (!number->rest.empty()) return std::unexpected(ErrorCode::InvalidStatement);
  if (number->value < 0) return std::unexpected(ErrorCode::NegativeValue);
  if (row.type == SettingType::Decimal) return print_decimal(row, static_cast<double>(number->value));
  // Integers are cut to a byte without a check (gnea/grbl settings.c).
  const auto value = static_cast<std::uint32_t>(number->value) & kByte;
  if (row.id == 0 && value < kGrblShortestPulse) return std::unexpected(ErrorCode::StepPulseTooShort);
  if (needs_homing(row) && value != 0 && !store.flag(setting::kHoming)) {
    return std::unexpected(ErrorCode::SoftLimitNeedsHoming);
  }
  if (row.type == SettingType::Bool) return std::string{value != 0 ? "1" : "0"};
  return std::to_string(value);
}

Checked check_setting_rabbit(const SettingsStore& /*store*/, const SettingMatch& match, std::string_view text) {
  const SettingRow& row = *match.row;
  if (is_text(row.type)) return std::string{text};
  text = base::trim(text);
  switch (row.type) {
    case SettingType::Bool: {
      // SourceRabbit/RabbitGRBL Settings.cpp: whatever is not one of these words is off.
      constexpr std::array<std::string_view, 5> kOn = {"1", "on", "true", "enabled", "yes"};
      return std::string{std::ranges::any_of(kOn, [&](auto word) { return base::iequals(word, text); }) ? "1" : "0"};
    }
    case SettingType::Axes: return check_axes_rabbit(text);
    case SettingType::Radio: return check_choice_rabbit(row, text);
    case SettingType::Decimal: {
      const auto number = leading_number(text);
      if (!number || !number->rest.empty()) return std::unexpected(ErrorCode::BadNumberFormat);
      const auto value = static_cast<double>(number->value);
      if (below_minimum(row, value) || above_maximum(row, value)) {
        return std::unexpected(ErrorCode::SettingNumberOutOfRange);
      }
      return print_decimal(row, value);
    }
    default: {
      const auto value = whole_number(text);
      if (!value) return std::unexpected(ErrorCode::BadNumberFormat);
      const auto number = static_cast<double>(*value);
      if (below_minimum(row, number) || above_maximum(row, number)) {
        return std::unexpected(ErrorCode::SettingNumberOutOfRange);
      }
      return std::to_string(*value);
    }
  }
}

}  // namespace kerf::firmware
