#pragma once
// The value of one setting: whether the controller would take it, how it is written, what it means.

#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include <boost/describe.hpp>

#include "sender/machine/capabilities.hpp"

namespace kerf::machine {

/// Why a value is not sent.
enum class SettingFault {
  UnknownSetting,     ///< the controller does not list it
  Empty,              ///< nothing given, and the setting needs something
  NotANumber,         ///< no plain decimal number
  NotWhole,           ///< a whole number is needed
  Negative,           ///< below zero, and no minimum allows it
  TooSmall,           ///< below the minimum
  TooLarge,           ///< above the maximum
  TooShort,           ///< a text of too few characters
  TooLong,            ///< a text of too many characters, or a line that the controller would not take
  UnknownItem,        ///< no such bit or choice
  UnknownAxis,        ///< a letter that is no axis of this machine
  NotAnAddress,       ///< no IPv4 address
  RealtimeCharacter,  ///< `?`, `!` or `~`, which the controller would obey at once
  NotPrintable,       ///< not plain ASCII
  NeedsOther,         ///< another setting must be on first
  NotTaken,           ///< sent, and the controller refused or altered it
};
BOOST_DESCRIBE_ENUM(SettingFault, UnknownSetting, Empty, NotANumber, NotWhole, Negative, TooSmall, TooLarge, TooShort,
                    TooLong, UnknownItem, UnknownAxis, NotAnAddress, RealtimeCharacter, NotPrintable, NeedsOther,
                    NotTaken)

/// A value that is not sent; the sentence says which setting, what was given and what is allowed.
struct SettingRefusal {
  std::string id{};
  SettingFault fault{};
  std::string sentence{};
  bool operator==(const SettingRefusal&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingRefusal, (), (id, fault, sentence))

/// What the machine at hand says about all values.
struct SettingRules {
  std::string axis_letters = "XYZ";
  /// `?`, `!` and `~` act at once, in texts too.
  bool legacy_realtime = true;
  /// Most characters of a line.
  int line_length = 70;
};

[[nodiscard]] SettingRules setting_rules_of(const Capabilities& machine);

/// The text to send for `text`, which a person or a file gave: numbers, `on`/`off`, names of bits, choices and axes,
/// `+Name` and `-Name` to change single bits of the value that is set now.
[[nodiscard]] std::expected<std::string, SettingRefusal> check_setting(const SettingFact& setting,
                                                                       std::string_view text,
                                                                       const SettingRules& rules);

/// Both mean the same to the controller: `500` and `500.000`, `PWM` and `1`. The coarser number of digits decides.
[[nodiscard]] bool is_same_value(const SettingFact& setting, std::string_view left, std::string_view right);

/// What a value means, in words: "X, Z", "Laser mode", "500.000 mm/min"; a password is stars.
[[nodiscard]] std::string explain_value(const SettingFact& setting, std::string_view value, const SettingRules& rules);

/// What is allowed, in words: "a number from 0.5 to 20 s, or 0".
[[nodiscard]] std::string explain_range(const SettingFact& setting, const SettingRules& rules);

/// "$110 (X-axis maximum rate)"
[[nodiscard]] std::string label_of(const SettingFact& setting);

[[nodiscard]] bool is_password(const SettingFact& setting);

/// What stands in place of a password everywhere.
inline constexpr std::string_view kStars = "********";

/// As `machine`, with stars in place of passwords.
[[nodiscard]] Capabilities without_passwords(Capabilities machine);

}  // namespace kerf::machine
