#pragma once
// A short form for the rows of settings that depend on driver and plugins.

#include "common/vocabulary/settings.hpp"

namespace kerf::vocabulary::tables {

[[nodiscard]] constexpr SettingRow optional_setting(int id, int group, std::string_view name, SettingType type,
                                                    std::string_view unit = {}, std::string_view format = {},
                                                    SettingLimit min = {}, SettingLimit max = {}) {
  return {.id = id,
          .group = group,
          .name = name,
          .unit = unit,
          .type = type,
          .format = format,
          .min = min,
          .max = max,
          .build = BuildOption::Driver};
}

}  // namespace kerf::vocabulary::tables
