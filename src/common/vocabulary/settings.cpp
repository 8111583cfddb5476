#include "common/vocabulary/settings.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"
#include "common/vocabulary/settings_tables.hpp"

namespace kerf::vocabulary {
namespace {

// The groups of grblHAL (settings.h) that rows of ours lie in. Grbl and Rabbit print none; we sort theirs alike.
constexpr std::array kGroups{
    SettingGroupRow{0, 0, "Root"},
    SettingGroupRow{1, 0, "General"},
    SettingGroupRow{2, 0, "Control signals"},
    SettingGroupRow{3, 0, "Limits"},
    SettingGroupRow{4, 3, "Dual axis"},
    SettingGroupRow{5, 0, "Coolant"},
    SettingGroupRow{6, 0, "Spindle"},
    SettingGroupRow{7, 6, "Spindle sync"},
    SettingGroupRow{8, 6, "Spindle closed loop"},
    SettingGroupRow{9, 0, "Tool change"},
    SettingGroupRow{10, 0, "Plasma"},
    SettingGroupRow{11, 0, "Homing"},
    SettingGroupRow{12, 0, "Probing"},
    SettingGroupRow{13, 0, "Parking/Safety door"},
    SettingGroupRow{14, 0, "Jogging"},
    SettingGroupRow{15, 0, "Networking"},
    SettingGroupRow{16, 15, "WiFi"},
    SettingGroupRow{17, 0, "Bluetooth"},
    SettingGroupRow{18, 0, "Aux ports"},
    SettingGroupRow{19, 0, "ModBus"},
    SettingGroupRow{20, 19, "ModBus unit 0"},
    SettingGroupRow{21, 19, "ModBus unit 1"},
    SettingGroupRow{22, 19, "ModBus unit 2"},
    SettingGroupRow{23, 19, "ModBus unit 3"},
    SettingGroupRow{24, 19, "ModBus unit 4"},
    SettingGroupRow{25, 19, "ModBus unit 5"},
    SettingGroupRow{26, 19, "ModBus unit 6"},
    SettingGroupRow{27, 19, "ModBus unit 7"},
    SettingGroupRow{28, 0, "Encoders"},
    SettingGroupRow{29, 28, "Encoder 0"},
    SettingGroupRow{30, 28, "Encoder 1"},
    SettingGroupRow{31, 28, "Encoder 2"},
    SettingGroupRow{32, 28, "Encoder 3"},
    SettingGroupRow{33, 28, "Encoder 4"},
    SettingGroupRow{34, 0, "User settings"},
    SettingGroupRow{35, 0, "Stepper"},
    SettingGroupRow{36, 0, "Stepper driver"},
    SettingGroupRow{37, 6, "VFD"},
    SettingGroupRow{38, 0, "CAN bus"},
    SettingGroupRow{39, 0, "Embroidery"},
    SettingGroupRow{40, 0, "Panel"},
    SettingGroupRow{41, 0, "Kinematics"},
    SettingGroupRow{42, 0, "Axis"},
    SettingGroupRow{43, 42, "X-axis"},
    SettingGroupRow{44, 42, "Y-axis"},
    SettingGroupRow{45, 42, "Z-axis"},
    SettingGroupRow{46, 42, "A-axis"},
    SettingGroupRow{47, 42, "B-axis"},
    SettingGroupRow{48, 42, "C-axis"},
    SettingGroupRow{49, 42, "U-axis"},
    SettingGroupRow{50, 42, "V-axis"},
    SettingGroupRow{51, 42, "W-axis"},
};

constexpr int kUsualAxes = 3;

}  // namespace

std::span<const SettingGroupRow> setting_group_rows() {
  return kGroups;
}

std::span<const SettingRow> setting_rows(Firmware firmware) {
  switch (firmware) {
    case Firmware::Grbl: return tables::kGrblSettings;
    case Firmware::Rabbit: return tables::kRabbitSettings;
    case Firmware::GrblHal: return tables::kAllGrblHalSettings;
    case Firmware::Unknown: break;
  }
  return {};
}

std::optional<SettingMatch> find_setting(std::span<const SettingRow> rows, int id, int axes) {
  if (id < 0) return std::nullopt;
  for (const SettingRow& row : rows) {
    const int axis = id - row.id;
    if (row.id < 0 || axis < 0 || axis >= (row.per_axis ? axes : 1)) continue;
    return SettingMatch{.row = &row, .axis = axis};
  }
  return std::nullopt;
}

std::optional<SettingMatch> find_setting(std::span<const SettingRow> rows, std::string_view key, int axes) {
  if (const std::optional<int> id = base::parse_int(key)) return find_setting(rows, *id, axes);
  for (const SettingRow& row : rows) {
    if (row.path.empty()) continue;
    if (!row.per_axis) {
      if (base::iequals(row.path, key)) return SettingMatch{.row = &row, .axis = 0};
      continue;
    }
    // X/MaxRate
    if (key.size() < 2 || key[1] != '/' || !base::iequals(row.path, key.substr(2))) continue;
    const std::optional<Axis> axis = axis_of(base::to_upper(key[0]));
    if (!axis || static_cast<int>(index_of(*axis)) >= axes) continue;
    return SettingMatch{.row = &row, .axis = static_cast<int>(index_of(*axis))};
  }
  return std::nullopt;
}

std::string full_name(const SettingMatch& match) {
  std::string name{match.row->name};
  if (!match.row->per_axis) return name;
  return kAxisLetters[static_cast<std::size_t>(match.axis)] + name;
}

int group_of(const SettingMatch& match) {
  return match.row->group + match.axis;
}

std::string format_of(const SettingRow& row, int axes) {
  constexpr std::string_view kAxisItem = "-Axis";
  std::string format;
  const bool wide = axes > kUsualAxes && !row.rotary_format.empty();
  for (const std::string_view item : base::split(wide ? row.rotary_format : row.format, ',')) {
    const bool names_axis = item.size() == kAxisItem.size() + 1 && item.ends_with(kAxisItem);
    const std::optional<Axis> axis = names_axis ? axis_of(item.front()) : std::nullopt;
    if (axis && static_cast<int>(index_of(*axis)) >= axes) continue;
    if (!format.empty()) format += ',';
    format += item;
  }
  return format;
}

std::string unit_of(const SettingMatch& match, AxisMask rotary_axes) {
  constexpr std::string_view kLength = "mm";
  std::string unit{match.row->unit};
  const bool turns = match.row->per_axis && ((rotary_axes >> static_cast<unsigned>(match.axis)) & 1U) != 0;
  if (const auto at = unit.find(kLength); turns && at != std::string::npos) unit.replace(at, kLength.size(), "deg");
  return unit;
}

bool is_built(const SettingRow& row, BuildSet builds, int axes) {
  switch (row.build) {
    case BuildOption::FourAxes: return axes > kUsualAxes;
    case BuildOption::FiveAxes: return axes > kUsualAxes + 1;
    case BuildOption::SixAxes: return axes > kUsualAxes + 2;
    default: return builds.contains(row.build);
  }
}

std::string_view item_of(std::string_view items, int index) {
  for (; index > 0; --index) {
    const std::size_t comma = items.find(',');
    if (comma == std::string_view::npos) return {};
    items.remove_prefix(comma + 1);
  }
  return items.substr(0, items.find(','));
}

std::string_view default_of(const SettingMatch& match) {
  const SettingRow& row = *match.row;
  return row.axis_defaults.empty() ? row.default_value : item_of(row.axis_defaults, match.axis);
}

std::string path_of(const SettingMatch& match) {
  if (!match.row->per_axis || match.row->path.empty()) return std::string{match.row->path};
  return std::string{kAxisLetters[static_cast<std::size_t>(match.axis)], '/'} + std::string{match.row->path};
}

int decimals_of(const SettingRow& row) {
  if (row.type != SettingType::Decimal) return 0;
  // A default shows it best: grblHAL's $33 has the mask "#####0" and prints 5000.0 (transcript 04).
  const std::string_view sample = row.default_value.empty() ? row.format : row.default_value;
  const std::size_t point = sample.find('.');
  return point == std::string_view::npos ? 0 : static_cast<int>(sample.size() - point - 1);
}

}  // namespace kerf::vocabulary
