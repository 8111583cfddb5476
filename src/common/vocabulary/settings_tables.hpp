#pragma once
// The settings of each firmware as one sorted table.

#include <algorithm>
#include <array>

#include "common/vocabulary/settings_grbl.hpp"
#include "common/vocabulary/settings_grblhal.hpp"
#include "common/vocabulary/settings_grblhal_axes.hpp"
#include "common/vocabulary/settings_grblhal_core_extra.hpp"
#include "common/vocabulary/settings_grblhal_plugins.hpp"
#include "common/vocabulary/settings_rabbit.hpp"

namespace kerf::vocabulary::tables {

inline constexpr auto kAllGrblHalSettings = [] {
  constexpr std::size_t kCount = kGrblHalSettings.size() + kGrblHalAxisSettings.size() + kGrblHalExtraSettings.size() +
                                 kGrblHalPluginSettings.size();
  std::array<SettingRow, kCount> rows{};
  auto at = std::ranges::copy(kGrblHalSettings, rows.begin()).out;
  at = std::ranges::copy(kGrblHalAxisSettings, at).out;
  at = std::ranges::copy(kGrblHalExtraSettings, at).out;
  std::ranges::copy(kGrblHalPluginSettings, at);
  std::ranges::sort(rows, {}, &SettingRow::id);
  return rows;
}();

}  // namespace kerf::vocabulary::tables
