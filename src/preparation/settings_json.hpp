#pragma once
// Settings as programs read them.

#include <string>
#include <vector>

#include "io/json.hpp"
#include "sender/machine/setting_value.hpp"

namespace kerf::preparation {

/// The value, or stars.
[[nodiscard]] std::string shown_value(const machine::SettingFact& setting);

/// {"settings":[…],"groups":[…]}: each setting with its `meaning` and `range` in words. No passwords.
[[nodiscard]] io::Json settings_json(const machine::Capabilities& machine,
                                     const std::vector<machine::SettingFact>& settings);

}  // namespace kerf::preparation
