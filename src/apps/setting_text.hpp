#pragma once
// Settings for people.

#include <string_view>
#include <vector>

#include "sender/machine/setting_value.hpp"

namespace kerf::apps {

/// `group` is the name or number of the setting's group or of one above it, in any case.
[[nodiscard]] bool is_in_group(const machine::Capabilities& machine, const machine::SettingFact& setting,
                               std::string_view group);

/// One line a setting under the heading of its group; with `verbose` also range and help.
void print_settings(const machine::Capabilities& machine, std::vector<machine::SettingFact> settings, bool verbose);

/// Everything about one.
void print_setting(const machine::Capabilities& machine, const machine::SettingFact& setting);

}  // namespace kerf::apps
