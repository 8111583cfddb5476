#include "common/vocabulary/settings.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/text.hpp"

namespace kerf::vocabulary {
namespace {

constexpr std::array kFirmwares{Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

// Every id that `rows` take on a machine with `axes` axes.
std::vector<int> ids_of(std::span<const SettingRow> rows, int axes, bool usual_only) {
  std::vector<int> ids;
  for (const SettingRow& row : rows) {
    if (row.id < 0 || (usual_only && row.build != BuildOption::Usual)) continue;
    for (int axis = 0; axis < (row.per_axis ? axes : 1); ++axis) ids.push_back(row.id + axis);
  }
  return ids;
}

SettingMatch match(Firmware firmware, int id) {
  return find_setting(setting_rows(firmware), id).value();
}

TEST(Settings, IdsAreSortedAndUnique) {
  for (const Firmware firmware : kFirmwares) {
    std::vector<int> ids = ids_of(setting_rows(firmware), 6, false);
    std::ranges::sort(ids);
    EXPECT_EQ(std::ranges::adjacent_find(ids), ids.end()) << *std::ranges::adjacent_find(ids);
    const auto rows = setting_rows(firmware);
    const auto numbered = std::ranges::count_if(rows, [](const SettingRow& row) { return row.id >= 0; });
    EXPECT_TRUE(std::ranges::is_sorted(rows.first(static_cast<std::size_t>(numbered)), {}, &SettingRow::id));
  }
}

TEST(Settings, RowsAreComplete) {
  for (const Firmware firmware : kFirmwares) {
    for (const SettingRow& row : setting_rows(firmware)) {
      EXPECT_FALSE(row.name.empty()) << row.id;
      EXPECT_EQ(row.per_axis, row.name.starts_with('-')) << row.name;
      EXPECT_TRUE(row.id >= 0 || !row.path.empty()) << row.name;
      EXPECT_TRUE(std::ranges::count(setting_group_rows(), row.group, &vocabulary::SettingGroupRow::id) == 1) << row.id;
      for (const std::string_view text : {row.name, row.unit, row.format, row.default_value, row.description}) {
        EXPECT_EQ(text.find_first_of("|]\r\n"), std::string_view::npos) << text;
      }
      if (row.build != BuildOption::Usual) continue;
      EXPECT_FALSE(row.description.empty()) << row.id;
      const bool is_text = row.type == SettingType::Text || row.type == SettingType::Password;
      EXPECT_TRUE(is_text || !row.default_value.empty()) << row.id;
    }
  }
}

// A default must be one that the controller would accept and print.
TEST(Settings, DefaultsAreInRangeAndPrintedAlike) {
  for (const Firmware firmware : kFirmwares) {
    for (const SettingRow& row : setting_rows(firmware)) {
      if (row.type != SettingType::Decimal && row.type != SettingType::Integer) continue;
      if (row.default_value.empty()) continue;
      const std::optional<double> value = base::parse_decimal(row.default_value);
      ASSERT_TRUE(value) << row.name;
      const bool is_null = row.allow_null && *value == 0;
      if (row.min && !is_null) {
        EXPECT_GE(*value, *row.min) << row.name;
      }
      if (row.max) {
        EXPECT_LE(*value, *row.max) << row.name;
      }
      EXPECT_EQ(base::to_fixed(*value, decimals_of(row)), row.default_value) << row.name;
    }
  }
}

// Transcript 05: 83 rows with three axes.
TEST(Settings, ReferenceBuildOfGrblHalHasTheRecordedSettings) {
  const std::vector<int> ids = ids_of(setting_rows(Firmware::GrblHal), 3, true);
  EXPECT_EQ(ids.size(), 83U);
  EXPECT_TRUE(std::ranges::is_sorted(ids));
}

// protocol.md 7.2: 34 settings with three axes.
TEST(Settings, GrblHasItsThirtyFour) {
  EXPECT_EQ(ids_of(setting_rows(Firmware::Grbl), 3, true).size(), 34U);
  EXPECT_EQ(match(Firmware::Grbl, 0).row->default_value, "10");
  EXPECT_EQ(match(Firmware::Grbl, 132).row->default_value, "200.000");
}

// Transcript 06: the groups that settings of the reference build lie in, and their parents.
TEST(Settings, GroupsInUseAreTheRecordedOnes) {
  std::set<int> groups{0};
  for (const int id : ids_of(setting_rows(Firmware::GrblHal), 3, true)) {
    const SettingMatch setting = match(Firmware::GrblHal, id);
    groups.insert(group_of(setting));
    for (const vocabulary::SettingGroupRow& row : setting_group_rows()) {
      if (row.id == group_of(setting)) groups.insert(row.parent);
    }
  }
  EXPECT_EQ(groups, (std::set<int>{0, 1, 2, 3, 5, 6, 9, 11, 12, 13, 14, 35, 42, 43, 44, 45}));
}

TEST(Settings, AxisSettingsAreFoundByNumber) {
  const SettingMatch setting = match(Firmware::GrblHal, 112);
  EXPECT_EQ(setting.axis, 2);
  EXPECT_EQ(full_name(setting), "Z-axis maximum rate");
  EXPECT_EQ(group_of(setting), 45);
  EXPECT_EQ(find_setting(setting_rows(Firmware::Grbl), 103, 3), std::nullopt);
  EXPECT_TRUE(find_setting(setting_rows(Firmware::Rabbit), 105, 6));
  EXPECT_EQ(find_setting(setting_rows(Firmware::Rabbit), -1), std::nullopt);
}

TEST(Settings, RabbitSettingsAreFoundByName) {
  const auto rows = setting_rows(Firmware::Rabbit);
  EXPECT_EQ(find_setting(rows, "Homing/Enable")->row->id, 22);
  EXPECT_EQ(find_setting(rows, "homing/enable")->row->id, 22);
  EXPECT_EQ(find_setting(rows, "110")->row->id, 110);
  EXPECT_EQ(find_setting(rows, "Y/MaxRate")->axis, 1);
  EXPECT_EQ(find_setting(rows, "Y/MaxRate")->row->id, 110);
  EXPECT_EQ(find_setting(rows, "Z/Home/Mpos")->row->id, -1);
  EXPECT_EQ(find_setting(rows, "C/MaxRate", 3), std::nullopt);
  EXPECT_EQ(find_setting(rows, "No/Such"), std::nullopt);
  EXPECT_EQ(find_setting(rows, ""), std::nullopt);
}

// protocol.md 7.5
TEST(Settings, CollidingIdsMeanDifferentThings) {
  EXPECT_EQ(match(Firmware::Rabbit, 37).row->name, "Spindle spin-up delay");
  EXPECT_EQ(match(Firmware::GrblHal, 37).row->name, "Steppers to keep enabled");
  EXPECT_EQ(match(Firmware::Rabbit, 50).row->type, SettingType::Axes);
  EXPECT_EQ(match(Firmware::GrblHal, 50).row->unit, "mm/min");
  EXPECT_EQ(match(Firmware::GrblHal, 4).row->type, SettingType::Axes);
  EXPECT_EQ(match(Firmware::Grbl, 4).row->type, SettingType::Bool);
}

TEST(Settings, LimitsAreNumbersAndTexts) {
  const SettingRow& pulse = *match(Firmware::GrblHal, 0).row;
  EXPECT_EQ(pulse.min.text(), "2.0");
  EXPECT_DOUBLE_EQ(*pulse.min, 2.0);
  EXPECT_FALSE(pulse.max);
  const SettingRow& parking = *match(Firmware::GrblHal, 58).row;
  EXPECT_DOUBLE_EQ(*parking.min, -100000.0);
  const SettingRow& delay = *match(Firmware::GrblHal, 392).row;
  EXPECT_DOUBLE_EQ(*delay.min, 0.5);
  EXPECT_DOUBLE_EQ(*delay.max, 20.0);
  EXPECT_TRUE(delay.allow_null);
  EXPECT_TRUE(match(Firmware::GrblHal, 481).row->reboot);
}

TEST(Settings, ItemsOfBitFields) {
  const SettingRow& homing = *match(Firmware::GrblHal, 22).row;
  EXPECT_EQ(item_of(homing.format, 0), "Enable");
  EXPECT_EQ(item_of(homing.format, 7), "N/A");
  EXPECT_EQ(item_of(homing.format, 10), "Run startup scripts only on homing completed");
  EXPECT_EQ(item_of(homing.format, 11), "");
  EXPECT_EQ(decimals_of(*match(Firmware::GrblHal, 100).row), 5);
  EXPECT_EQ(decimals_of(*match(Firmware::GrblHal, 33).row), 1);
  EXPECT_EQ(decimals_of(*match(Firmware::Grbl, 30).row), 0);
  EXPECT_EQ(decimals_of(*match(Firmware::GrblHal, 160).row), 5);
  EXPECT_EQ(decimals_of(homing), 0);
}

}  // namespace
}  // namespace kerf::vocabulary
