#pragma once
// A set of settings as text: lines `$n=value` and remarks, the same text that `kerf virtual --settings` takes.
//
//   file    = *( line LF )            a CR before the LF and blanks at both ends do not count
//   line    = empty | remark | setting
//   remark  = ( "#" | ";" ) text      only at the start of a line: values may hold both characters
//   setting = "$" id "=" value        id is a number, or a name with a slash in it (Rabbit)
//
// The last line of a setting counts. Anything else makes the whole file unusable, so that half a restore never happens.

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "sender/machine/settings_plan.hpp"

namespace kerf::machine {

struct SettingsTextError {
  std::size_t line = 0;
  std::string text{};
  bool operator==(const SettingsTextError&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingsTextError, (), (line, text))

[[nodiscard]] std::expected<std::vector<SettingAssignment>, SettingsTextError> parse_settings_text(
    std::string_view text);

/// One line a setting, with its name and unit as a remark above where `machine` knows them, and `remarks` at the top.
/// Passwords are left out, and a remark says so.
[[nodiscard]] std::string print_settings_text(const Capabilities& machine,
                                              const std::vector<SettingAssignment>& settings,
                                              const std::vector<std::string>& remarks);

/// "110" for "$110" and "110", "Homing/Enable" for either spelling; nothing if it can be no setting.
[[nodiscard]] std::string setting_id_of(std::string_view text);

}  // namespace kerf::machine
