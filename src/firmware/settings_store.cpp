#include "firmware/settings_store.hpp"

#include <algorithm>

#include "common/base/text.hpp"
#include "firmware/leading_number.hpp"

namespace kerf::firmware {

using vocabulary::SettingMatch;
using vocabulary::SettingRow;
using vocabulary::SettingType;

namespace {

bool is_text(SettingType type) {
  return type == SettingType::Text || type == SettingType::Password || type == SettingType::Ipv4;
}

constexpr unsigned kFirstRotary = 3;
constexpr unsigned kParkingOverrideBit = 2;

/// What a build whose driver has a spindle encoder adds, and how it begins (grblHAL/core config.h; the pulses are those
/// of our driver).
constexpr std::array<std::pair<int, std::string_view>, 6> kEncoderSettings{
    {{setting::kEncoderPulses, "400"},
     {90, "1.000"},
     {91, "0.010"},
     {92, "0.000"},
     {95, "10.000"},
     {setting::kSpindleAtSpeedTolerance, "0.0"}}};

const auto* encoder_setting(const SettingRow& row) {
  return std::ranges::find(kEncoderSettings, row.id, [](const auto& pair) { return pair.first; });
}

bool is_fitted(const SettingRow& row, const Personality& personality, int axes) {
  if (vocabulary::is_built(row, personality.dialect().builds, axes)) return true;
  return personality.hardware.spindle_encoder && encoder_setting(row) != kEncoderSettings.end();
}

/// A mask over all axes is written down for three of them (vocabulary::SettingRow), one over rotary axes for all.
std::string default_text(const SettingMatch& match, int axes) {
  const SettingRow& row = *match.row;
  const bool is_optional = row.default_value.empty() && row.build == vocabulary::BuildOption::Driver;
  if (const auto* encoder = encoder_setting(row); is_optional && encoder != kEncoderSettings.end()) {
    return std::string{encoder->second};
  }
  if (row.id == setting::kRotaryAxes) {
    const auto mask = static_cast<unsigned>(base::parse_int(row.default_value).value_or(0));
    return std::to_string(mask & ((1U << (static_cast<unsigned>(axes) - kFirstRotary)) - 1U));
  }
  if (row.type == SettingType::Axes && row.default_value == "7") return std::to_string((1 << axes) - 1);
  return std::string{vocabulary::default_of(match)};
}

/// Position of a radio's item in its format; the text itself if it is none.
std::string number_text(const SettingRow& row, std::string_view text) {
  if (row.type != SettingType::Radio || row.path.empty()) return std::string{text};
  const auto items = base::split(row.format, ',');
  return std::to_string(std::ranges::find(items, text) - items.begin());
}

}  // namespace

int axes_of(const Personality& personality, const StoredState& stored) {
  int axes = personality.hardware.axes != 0 ? personality.hardware.axes : personality.dialect().axes_default;
  for (int axis = axes; axis < personality.dialect().axes_max; ++axis) {
    if (stored.settings.contains(std::to_string(setting::kStepsPerMm + axis))) axes = axis + 1;
  }
  return axes;
}

SettingsStore::SettingsStore(const Personality& personality, int axes)
    : personality_(personality), rows_(personality.dialect().settings), axes_(axes) {
  for (const SettingRow& row : rows_) {
    first_slot_.push_back(slots_.size());
    if (!is_fitted(row, personality, axes_)) continue;
    const int count = row.per_axis ? axes_with_settings() : 1;
    for (int axis = 0; axis < count; ++axis) {
      slots_.push_back({.match = {.row = &row, .axis = axis}, .format = vocabulary::format_of(row, axes_)});
    }
  }
  restore_defaults();
}

void SettingsStore::restore_defaults() {
  for (Slot& slot : slots_) set(slot.match, default_text(slot.match, axes_));
}

std::vector<std::string> SettingsStore::load(const StoredState& stored) {
  restore_defaults();
  std::vector<std::string> refused;
  for (const auto& [key, text] : stored.settings) {
    if (!write(key, text)) refused.push_back(key);
  }
  // A second pass takes what depended on a later number, such as soft limits on homing.
  std::erase_if(refused, [&](const std::string& key) { return write(key, stored.settings.at(key)).has_value(); });
  return refused;
}

void SettingsStore::save(StoredState& stored) const {
  stored.settings.clear();
  for (const Slot& slot : slots_) {
    const SettingRow& row = *slot.match.row;
    // What is kept of a further axis' steps per mm gives the machine that axis (axes_of).
    if (slot.match.axis >= axes_ || slot.text == default_text(slot.match, axes_)) continue;
    const std::string key = row.id >= 0 ? std::to_string(row.id + slot.match.axis) : vocabulary::path_of(slot.match);
    stored.settings.insert_or_assign(key, slot.text);
  }
}

std::expected<void, ErrorCode> SettingsStore::write(std::string_view key, std::string_view text) {
  const Slot* slot = find(key);
  if (slot == nullptr && key == personality_.obsolete_setting.key) return write_obsolete(text);
  if (slot == nullptr) {
    return std::unexpected(personality_.unknown_setting_error);
  }
  auto checked = personality_.check_setting(*this, slot->match, text);
  if (!checked) return std::unexpected(checked.error());
  const SettingMatch match = slot->match;
  set(match, std::move(*checked));
  // What acts is what was written, not what is left of it in print.
  const auto exact = leading_number(text);
  if (match.row->type == SettingType::Decimal && exact) {
    const auto row = static_cast<std::size_t>(match.row - rows_.data());
    slots_.at(first_slot_.at(row) + static_cast<std::size_t>(match.axis)).number = static_cast<double>(exact->value);
  }
  apply_consequences();
  return {};
}

std::expected<void, ErrorCode> SettingsStore::write_obsolete(std::string_view text) {
  const ObsoleteSetting& obsolete = personality_.obsolete_setting;
  const auto as_flag = vocabulary::find_setting(rows_, setting::kReportInches, axes_);
  const auto target = vocabulary::find_setting(rows_, obsolete.writes, axes_);
  const auto checked = personality_.check_setting(*this, *as_flag, text);
  if (!checked) return std::unexpected(checked.error());
  if (!flag(obsolete.writes)) return {};
  const unsigned others = mask(obsolete.writes) & ~(1U << obsolete.bit);
  set(*target, std::to_string(*checked == "0" ? others : others | 1U << obsolete.bit));
  return {};
}

void SettingsStore::set(const SettingMatch& match, std::string text) {
  auto& slot = slots_.at(first_slot_.at(static_cast<std::size_t>(match.row - rows_.data())) +
                         static_cast<std::size_t>(match.axis));
  slot.number = is_text(match.row->type) ? 0.0 : base::parse_decimal(number_text(*match.row, text)).value_or(0.0);
  slot.text = std::move(text);
}

void SettingsStore::apply_consequences() {
  // Without homing there are no soft limits, nor clipped jogs (gnea/grbl settings.c; grblHAL settings.c).
  if (!personality_.soft_limits_need_homing || flag(setting::kHoming)) return;
  for (const int id : {setting::kSoftLimits, setting::kLimitJogs}) {
    const auto match = vocabulary::find_setting(rows_, id, axes_);
    if (match && match->row->type == SettingType::Bool && slot_of(*match) != nullptr) set(*match, "0");
  }
}

const SettingsStore::Slot* SettingsStore::slot_of(const SettingMatch& match) const {
  if (!is_fitted(*match.row, personality_, axes_)) return nullptr;
  return &slots_.at(first_slot_.at(static_cast<std::size_t>(match.row - rows_.data())) +
                    static_cast<std::size_t>(match.axis));
}

const SettingsStore::Slot* SettingsStore::find(std::string_view key) const {
  const auto match = vocabulary::find_setting(rows_, key, axes_with_settings());
  return match ? slot_of(*match) : nullptr;
}

int SettingsStore::axes_with_settings() const {
  return personality_.names_settings ? personality_.dialect().axes_max : axes_;
}

std::string_view SettingsStore::format_of(const SettingMatch& match) const {
  const Slot* slot = slot_of(match);
  return slot != nullptr ? std::string_view{slot->format} : match.row->format;
}

vocabulary::AxisMask SettingsStore::rotary_axes() const {
  return personality_.has_extended_settings
             ? static_cast<vocabulary::AxisMask>(mask(setting::kRotaryAxes) << kFirstRotary)
             : vocabulary::AxisMask{0};
}

double SettingsStore::number(int id, int axis) const {
  const auto match = vocabulary::find_setting(rows_, id + axis, axes_);
  const Slot* slot = match ? slot_of(*match) : nullptr;
  return slot != nullptr ? slot->number : 0.0;
}

double SettingsStore::number(std::string_view name) const {
  const Slot* slot = find(name);
  return slot != nullptr ? slot->number : 0.0;
}

bool SettingsStore::flag(int id, unsigned bit) const {
  return ((mask(id) >> bit) & 1U) != 0;
}

vocabulary::AxisValues SettingsStore::axis_values(int id) const {
  vocabulary::AxisValues values{};
  for (int axis = 0; axis < axes_; ++axis) {
    values.at(static_cast<std::size_t>(axis)) = static_cast<float>(number(id, axis));
  }
  return values;
}

bool SettingsStore::is_lathe() const {
  return personality_.has_extended_settings && number(setting::kMode) == 2.0;
}

bool SettingsStore::is_laser() const {
  constexpr double kLaserType = 3.0;
  const bool has_laser = personality_.has_laser_spindle || number("Spindle/Type") == kLaserType;
  return has_laser && number(setting::kMode) == 1.0;
}

motion::MotionSettings SettingsStore::motion() const {
  return {
      .axes = axes_,
      .steps_per_mm = axis_values(setting::kStepsPerMm),
      .max_rate_mm_per_min = axis_values(setting::kMaxRate),
      .acceleration_mm_per_s2 = axis_values(setting::kAcceleration),
      .junction_deviation_mm = static_cast<float>(number(setting::kJunctionDeviation)),
      .arc_tolerance_mm = static_cast<float>(number(setting::kArcTolerance)),
      .laser_mode = is_laser(),
      .idle_delay_ms = static_cast<std::uint8_t>(mask(setting::kIdleDelay) & 0xFFU),
      .planner_blocks = static_cast<int>(number(setting::kPlannerBlocks)),
  };
}

bool SettingsStore::has_spindle_encoder() const {
  return personality_.hardware.spindle_encoder && number(setting::kEncoderPulses) > 0;
}

void SettingsStore::configure(gcode::InterpreterSettings& settings) const {
  settings.axes = axes_;
  settings.laser_mode = is_laser();
  settings.report_inches = flag(setting::kReportInches);
  if (!personality_.has_extended_settings) return;
  settings.prints_debug = flag(setting::kDebugMessages);
  settings.ignore_tool_change = number(setting::kToolChangeMode) == 4.0;
  settings.lathe_mode = is_lathe();
  settings.spindle_rpm_max = static_cast<float>(number(setting::kSpindleMax));
  settings.g92_volatile = flag(setting::kG92Volatile);
  settings.restore_overrides_at_end = flag(setting::kRestoreOverrides);
  settings.locked_work_offsets = mask(setting::kLockedOffsets);
  settings.rotary_axes = rotary_axes();
  settings.parking_override_control = flag(setting::kParking) && flag(setting::kParking, kParkingOverrideBit);
  settings.tools = personality_.hardware.tools;
  settings.ports = personality_.hardware.ports;
  settings.spindle_encoder = has_spindle_encoder();
  settings.spindle_rpm_min = static_cast<float>(number(setting::kSpindleMin));
  settings.g73_retract_mm = static_cast<float>(number(setting::kG73Retract));
}

}  // namespace kerf::firmware
