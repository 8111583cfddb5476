#include "sender/machine/setting_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/base/text.hpp"
#include "common/vocabulary/settings.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::machine {
namespace {

using vocabulary::SettingType;
using Checked = std::expected<std::string, SettingRefusal>;

constexpr std::size_t kMostBits = 32;
constexpr std::string_view kUnavailable = "N/A";
/// grblHAL's own names for two smaller integers, which it prints as integers (grblHAL settings.h).
constexpr int kSmallIntegers = 10;
constexpr int kSmallIntegersEnd = 12;

SettingType type_of(const SettingFact& setting) {
  if (setting.type >= kSmallIntegers && setting.type < kSmallIntegersEnd) return SettingType::Integer;
  return static_cast<SettingType>(setting.type);
}

bool is_known_type(const SettingFact& setting) {
  return setting.type >= 0 && setting.type < kSmallIntegersEnd;
}

bool is_mask(SettingType type) {
  return type == SettingType::Bitfield || type == SettingType::ExclusiveBitfield || type == SettingType::Axes;
}

bool is_text(SettingType type) {
  return type == SettingType::Text || type == SettingType::Password || type == SettingType::Ipv4;
}

/// Names of the bits or choices, in order.
std::vector<std::string> items_of(const SettingFact& setting, const SettingRules& rules) {
  std::vector<std::string> items;
  if (type_of(setting) == SettingType::Axes) {
    for (const char letter : rules.axis_letters) items.emplace_back(1, letter);
    return items;
  }
  if (setting.format.empty()) return items;
  for (const std::string_view item : base::split(setting.format, ',')) items.emplace_back(base::trim(item));
  if (items.size() > kMostBits) items.resize(kMostBits);
  return items;
}

std::string unit_behind(const SettingFact& setting) {
  return setting.unit.empty() ? std::string{} : " " + setting.unit;
}

std::unexpected<SettingRefusal> refuse(const SettingFact& setting, SettingFault fault, std::string_view given,
                                       const SettingRules& rules) {
  const std::string shown = is_password(setting) ? std::string{"that"} : "'" + base::escape(given) + "'";
  return std::unexpected(SettingRefusal{
      .id = setting.id,
      .fault = fault,
      .sentence = label_of(setting) + " cannot be " + shown + ": it takes " + explain_range(setting, rules) + "."});
}

std::unexpected<SettingRefusal> refuse_because(const SettingFact& setting, SettingFault fault, std::string why) {
  return std::unexpected(
      SettingRefusal{.id = setting.id, .fault = fault, .sentence = label_of(setting) + ": " + std::move(why)});
}

std::optional<double> limit(std::string_view text) {
  return base::parse_decimal(base::trim(text));
}

/// Checks against min and max as grblHAL does: without a minimum a number is not negative, and 0 may be allowed below
/// the minimum (settings.c validate_value).
std::optional<SettingFault> range_fault(const SettingFact& setting, double value) {
  const auto least = limit(setting.min);
  const auto most = limit(setting.max);
  if (setting.allow_null && value == 0) return std::nullopt;
  if (!least && value < 0) return SettingFault::Negative;
  if (least && value < *least) return SettingFault::TooSmall;
  if (most && value > *most) return SettingFault::TooLarge;
  return std::nullopt;
}

Checked check_decimal(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  const auto value = base::parse_decimal(text);
  if (!value) return refuse(setting, SettingFault::NotANumber, text, rules);
  if (const auto fault = range_fault(setting, *value)) return refuse(setting, *fault, text, rules);
  return std::string{text};
}

Checked check_integer(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  const auto value = base::parse_int<std::int64_t>(text);
  if (!value) {
    const bool is_number = base::parse_decimal(text).has_value();
    return refuse(setting, is_number ? SettingFault::NotWhole : SettingFault::NotANumber, text, rules);
  }
  constexpr double kLargest = 4294967295.0;
  const auto number = static_cast<double>(*value);
  if (const auto fault = range_fault(setting, number)) return refuse(setting, *fault, text, rules);
  if (number > kLargest) return refuse(setting, SettingFault::TooLarge, text, rules);
  return std::to_string(*value);
}

Checked check_bool(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  constexpr std::array<std::string_view, 5> kOn{"1", "on", "yes", "true", "enable"};
  constexpr std::array<std::string_view, 5> kOff{"0", "off", "no", "false", "disable"};
  const auto spells = [text](std::string_view word) { return base::iequals(text, word); };
  if (std::ranges::any_of(kOn, spells)) return "1";
  if (std::ranges::any_of(kOff, spells)) return "0";
  return refuse(setting, SettingFault::UnknownItem, text, rules);
}

std::optional<std::size_t> find_item(const std::vector<std::string>& items, std::string_view name) {
  const auto at = std::ranges::find_if(items, [name](const std::string& item) { return base::iequals(item, name); });
  if (at == items.end() || *at == kUnavailable) return std::nullopt;
  return static_cast<std::size_t>(at - items.begin());
}

Checked check_choice(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  const auto items = items_of(setting, rules);
  auto number = base::parse_int<std::size_t>(text);
  if (!number) number = find_item(items, text);
  const bool exists = number && (items.empty() || *number < items.size());
  if (!exists) return refuse(setting, SettingFault::UnknownItem, text, rules);
  return std::to_string(*number);
}

/// One name of a mask, as a mask; several letters of axes in one word are fine ("XZ").
std::optional<std::uint64_t> mask_of_name(const std::vector<std::string>& items, std::string_view name,
                                          bool letters_only) {
  if (const auto item = find_item(items, name)) return std::uint64_t{1} << *item;
  if (!letters_only || name.empty()) return std::nullopt;
  std::uint64_t mask = 0;
  for (const char letter : name) {
    const auto item = find_item(items, std::string_view{&letter, 1});
    if (!item) return std::nullopt;
    mask |= std::uint64_t{1} << *item;
  }
  return mask;
}

std::uint64_t current_mask(const SettingFact& setting) {
  return base::parse_int<std::uint64_t>(base::trim(setting.value.value_or("0"))).value_or(0);
}

// Enable,Allow manual   +Allow manual,-Override locks   XZ   none
std::optional<std::uint64_t> mask_of_names(const SettingFact& setting, std::string_view text,
                                           const std::vector<std::string>& items) {
  const bool letters_only = type_of(setting) == SettingType::Axes;
  if (base::iequals(text, "none")) return 0;
  const bool changes = text.starts_with('+') || text.starts_with('-');
  std::uint64_t mask = changes ? current_mask(setting) : 0;
  for (std::string_view name : base::split(text, ',')) {
    name = base::trim(name);
    const char sign = name.empty() ? ' ' : name.front();
    const bool is_signed = sign == '+' || sign == '-';
    if (changes != is_signed) return std::nullopt;
    if (is_signed) name = base::trim(name.substr(1));
    const auto bits = mask_of_name(items, name, letters_only);
    if (!bits) return std::nullopt;
    mask = sign == '-' ? mask & ~*bits : mask | *bits;
  }
  return mask;
}

Checked check_mask(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  const auto items = items_of(setting, rules);
  const SettingType type = type_of(setting);
  auto mask = base::parse_int<std::uint64_t>(text);
  if (!mask) mask = mask_of_names(setting, text, items);
  const SettingFault unknown = type == SettingType::Axes ? SettingFault::UnknownAxis : SettingFault::UnknownItem;
  if (!mask) return refuse(setting, unknown, text, rules);
  const std::size_t bits = items.empty() ? kMostBits : items.size();
  if (*mask >> bits != 0) return refuse(setting, unknown, text, rules);
  // Bit 0 enables the rest (protocol.md 5.2).
  if (type == SettingType::ExclusiveBitfield && (*mask & 1U) == 0) mask = 0;
  return std::to_string(*mask);
}

Checked check_address(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  constexpr std::size_t kParts = 4;
  constexpr int kLargest = 255;
  const auto parts = base::split(text, '.');
  const bool is_address = parts.size() == kParts && std::ranges::all_of(parts, [](std::string_view part) {
                            const auto number = base::parse_int(part);
                            return number && *number >= 0 && *number <= kLargest && part.front() != '-';
                          });
  if (!is_address) return refuse(setting, SettingFault::NotAnAddress, text, rules);
  return std::string{text};
}

Checked check_text(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  const auto length = static_cast<double>(text.size());
  if (text.empty() && setting.allow_null) return std::string{};
  if (const auto least = limit(setting.min); least && length < *least) {
    return refuse(setting, SettingFault::TooShort, text, rules);
  }
  if (const auto most = limit(setting.max); most && length > *most) {
    return refuse(setting, SettingFault::TooLong, text, rules);
  }
  if (type_of(setting) == SettingType::Ipv4) return check_address(setting, text, rules);
  return std::string{text};
}

/// What no line may hold, whatever the setting (protocol.md 2, 11 rule 3).
std::optional<SettingRefusal> check_line(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  for (const char letter : text) {
    if (letter < ' ' || letter > '~') {
      return refuse_because(setting, SettingFault::NotPrintable,
                            "controllers store plain ASCII only; leave out accents and control characters.")
          .error();
    }
    if (rules.legacy_realtime && (letter == '?' || letter == '!' || letter == '~')) {
      return refuse_because(setting, SettingFault::RealtimeCharacter,
                            "the controller obeys ?, ! and ~ at once, in texts too; leave them out, or set $39=0 "
                            "where there is one.")
          .error();
    }
  }
  const std::size_t line = setting.id.size() + text.size() + 2;
  if (line > static_cast<std::size_t>(std::max(rules.line_length, 1))) {
    return refuse_because(setting, SettingFault::TooLong, "the line would be longer than the controller takes.")
        .error();
  }
  return std::nullopt;
}

Checked check_by_type(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  if (!is_known_type(setting)) return std::string{text};
  switch (type_of(setting)) {
    case SettingType::Bool: return check_bool(setting, text, rules);
    case SettingType::Bitfield:
    case SettingType::ExclusiveBitfield:
    case SettingType::Axes: return check_mask(setting, text, rules);
    case SettingType::Radio: return check_choice(setting, text, rules);
    case SettingType::Integer: return check_integer(setting, text, rules);
    case SettingType::Decimal: return check_decimal(setting, text, rules);
    case SettingType::Text:
    case SettingType::Password:
    case SettingType::Ipv4: return check_text(setting, text, rules);
  }
  return std::string{text};
}

std::size_t decimals_in(std::string_view number) {
  const auto point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

bool is_same_number(std::string_view left, std::string_view right) {
  const auto a = base::parse_decimal(left);
  const auto b = base::parse_decimal(right);
  if (!a || !b) return left == right;
  // Controllers keep 32-bit floats and print a fixed number of digits.
  constexpr double kFloatRounding = 2e-7;
  const std::size_t decimals = std::max(decimals_in(left), decimals_in(right));
  const std::size_t coarse = std::min(decimals_in(left), decimals_in(right));
  const double last_digit = decimals == coarse ? 0 : 0.5;
  // `500` says as much as `500.000`: only a number with a point says how many digits it has.
  const double step = coarse == 0 ? 0 : last_digit * std::pow(10.0, -static_cast<double>(coarse));
  return std::abs(*a - *b) <= step + kFloatRounding * std::max(std::abs(*a), std::abs(*b)) + 1e-9;
}

std::string join(std::span<const std::string> parts, std::string_view separator) {
  std::string out;
  for (const std::string& part : parts) {
    if (!out.empty()) out += separator;
    out += part;
  }
  return out;
}

std::string explain_mask(const SettingFact& setting, std::string_view value, const SettingRules& rules) {
  const auto mask = base::parse_int<std::uint64_t>(value);
  if (!mask) return std::string{value};
  const auto items = items_of(setting, rules);
  std::vector<std::string> names;
  for (std::size_t bit = 0; bit < kMostBits; ++bit) {
    if ((*mask >> bit & 1U) == 0) continue;
    names.push_back(bit < items.size() && items[bit] != kUnavailable ? items[bit] : "bit " + std::to_string(bit));
  }
  return names.empty() ? "none" : join(names, ", ");
}

std::string numbered(const std::vector<std::string>& items) {
  std::vector<std::string> parts;
  for (std::size_t index = 0; index < items.size(); ++index) {
    if (items[index] != kUnavailable) parts.push_back(std::to_string(index) + " " + items[index]);
  }
  return join(parts, ", ");
}

std::string explain_limits(const SettingFact& setting, std::string_view noun) {
  const std::string unit = unit_behind(setting);
  std::string text{noun};
  if (!setting.min.empty() && !setting.max.empty()) {
    text += " from " + setting.min + " to " + setting.max + unit;
  } else if (!setting.max.empty()) {
    text += " from 0 to " + setting.max + unit;
  } else if (!setting.min.empty()) {
    text += " of at least " + setting.min + unit;
  } else {
    text += setting.unit.empty() ? ", not negative" : " in " + setting.unit + ", not negative";
  }
  const bool null_is_extra = setting.allow_null && limit(setting.min).value_or(0) > 0;
  return null_is_extra ? text + ", or 0" : text;
}

std::string explain_length(const SettingFact& setting, std::string_view noun) {
  std::string text{noun};
  if (!setting.min.empty() && !setting.max.empty()) {
    text += " of " + setting.min + " to " + setting.max + " characters";
  } else if (!setting.max.empty()) {
    text += " of at most " + setting.max + " characters";
  } else if (!setting.min.empty()) {
    text += " of at least " + setting.min + " characters";
  }
  return setting.allow_null ? text + ", or nothing" : text;
}

}  // namespace

SettingRules setting_rules_of(const Capabilities& machine) {
  return {.axis_letters = machine.axes.letters,
          .legacy_realtime = machine.features.legacy_realtime.available.value_or(true),
          .line_length = std::min(machine.buffers.line_length, machine.buffers.rx_usable - 1)};
}

Checked check_setting(const SettingFact& setting, std::string_view text, const SettingRules& rules) {
  text = base::trim(text);
  const bool may_be_empty = is_known_type(setting) && is_text(type_of(setting));
  if (text.empty() && !may_be_empty) return refuse(setting, SettingFault::Empty, text, rules);
  auto checked = check_by_type(setting, text, rules);
  if (!checked) return checked;
  if (auto refusal = check_line(setting, *checked, rules)) return std::unexpected(*std::move(refusal));
  return checked;
}

bool is_same_value(const SettingFact& setting, std::string_view left, std::string_view right) {
  left = base::trim(left);
  right = base::trim(right);
  if (left == right) return true;
  if (is_startup_line(setting.id)) return stored_form_of(left) == stored_form_of(right);
  if (!is_known_type(setting)) return is_same_number(left, right);
  const SettingType type = type_of(setting);
  if (is_text(type)) return false;
  if (type == SettingType::Radio) {
    const auto items = items_of(setting, {});
    const auto index = [&](std::string_view text) {
      return base::parse_int<std::size_t>(text).value_or(find_item(items, text).value_or(items.size()));
    };
    return index(left) == index(right) && index(left) < items.size();
  }
  return is_same_number(left, right);
}

std::string explain_value(const SettingFact& setting, std::string_view value, const SettingRules& rules) {
  value = base::trim(value);
  if (is_password(setting)) return value.empty() ? std::string{} : std::string{kStars};
  if (!is_known_type(setting)) return std::string{value};
  const SettingType type = type_of(setting);
  if (is_mask(type)) return explain_mask(setting, value, rules);
  if (type == SettingType::Bool) return value == "0" ? "off" : value == "1" ? "on" : std::string{value};
  if (type == SettingType::Radio) {
    const auto items = items_of(setting, rules);
    const auto index = base::parse_int<std::size_t>(value);
    return index && *index < items.size() ? items[*index] : std::string{value};
  }
  return std::string{value} + (value.empty() ? std::string{} : unit_behind(setting));
}

std::string explain_range(const SettingFact& setting, const SettingRules& rules) {
  if (!is_known_type(setting)) return "a value";
  switch (type_of(setting)) {
    case SettingType::Bool: return "0 (off) or 1 (on)";
    case SettingType::Bitfield: return "a sum of bits, or names: " + numbered(items_of(setting, rules));
    case SettingType::ExclusiveBitfield:
      return "a sum of bits, or names, of which bit 0 enables the others: " + numbered(items_of(setting, rules));
    case SettingType::Axes: return "a sum of bits, or letters of the axes " + rules.axis_letters;
    case SettingType::Radio: return "one of " + numbered(items_of(setting, rules));
    case SettingType::Integer: return explain_limits(setting, "a whole number");
    case SettingType::Decimal: return explain_limits(setting, "a number");
    case SettingType::Text: return explain_length(setting, "a text");
    case SettingType::Password: return explain_length(setting, "a password");
    case SettingType::Ipv4: return "an address such as 192.168.1.20";
  }
  return "a value";
}

std::string label_of(const SettingFact& setting) {
  return "$" + setting.id + (setting.name.empty() ? std::string{} : " (" + setting.name + ")");
}

bool is_password(const SettingFact& setting) {
  return setting.type == static_cast<int>(SettingType::Password);
}

Capabilities without_passwords(Capabilities machine) {
  for (SettingFact& setting : machine.settings) {
    if (is_password(setting) && setting.value && !setting.value->empty()) setting.value = std::string{kStars};
  }
  return machine;
}

}  // namespace kerf::machine
