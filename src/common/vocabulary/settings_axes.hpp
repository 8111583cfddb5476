#pragma once
// The settings that each axis has on every firmware. Grbl and grblHAL share all but the first row's digits; Rabbit has
// ranges and defaults of its own (settings_rabbit.hpp).

#include "common/vocabulary/settings.hpp"
#include "common/vocabulary/settings_texts.hpp"

namespace kerf::vocabulary::tables {

/// `$100`: Grbl prints three decimals, grblHAL up to five.
constexpr SettingRow steps_per_mm_row(std::string_view format, std::string_view default_value) {
  return per_axis({100,
                   43,
                   "-axis travel resolution",
                   "step/mm",
                   SettingType::Decimal,
                   format,
                   {},
                   {},
                   default_value,
                   texts::kStepsPerMm});
}

inline constexpr SettingRow kMaxRateRow = per_axis(
    {110, 43, "-axis maximum rate", "mm/min", SettingType::Decimal, "#####0.000", {}, {}, "500.000", texts::kMaxRate});

inline constexpr SettingRow kAccelerationRow = per_axis({120,
                                                         43,
                                                         "-axis acceleration",
                                                         "mm/sec^2",
                                                         SettingType::Decimal,
                                                         "#####0.000",
                                                         {},
                                                         {},
                                                         "10.000",
                                                         texts::kAcceleration});

inline constexpr SettingRow kMaxTravelRow = per_axis(
    {130, 43, "-axis maximum travel", "mm", SettingType::Decimal, "#####0.000", {}, {}, "200.000", texts::kMaxTravel});

}  // namespace kerf::vocabulary::tables
