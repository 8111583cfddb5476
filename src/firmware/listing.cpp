#include "firmware/listing.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "common/base/text.hpp"

namespace kerf::firmware {

using vocabulary::SettingRow;
using vocabulary::SettingType;

namespace {

std::string letters_of(AxisMask axes, int count) {
  std::string letters;
  for (int axis = 0; axis < count; ++axis) {
    if (((axes >> static_cast<unsigned>(axis)) & 1U) != 0)
      letters += vocabulary::kAxisLetters[static_cast<std::size_t>(axis)];
  }
  return letters;
}

constexpr int kAxesWithNames = 6;

/// As Rabbit prints a value beside its name: On and Off, and letters instead of masks.
std::string named_value(const vocabulary::SettingMatch& match, std::string_view text) {
  switch (match.row->type) {
    case SettingType::Bool: return text == "1" ? "On" : "Off";
    case SettingType::Axes:
      return letters_of(static_cast<AxisMask>(base::parse_int<int>(text).value_or(0)), kAxesWithNames);
    default: return std::string{text};
  }
}

std::string type_words(const SettingRow& row) {
  switch (row.type) {
    case SettingType::Bool: return " as boolean";
    case SettingType::Bitfield: return " as bitfield:";
    case SettingType::ExclusiveBitfield: return " as bitfield where setting bit 0 enables the rest:";
    case SettingType::Radio: return ":";
    case SettingType::Axes: return " as axismask";
    default: return {};
  }
}

std::string range_words(const SettingRow& row) {
  if (row.min.has_value() && row.max.has_value()) {
    return ", range: " + std::string{row.min.text()} + " - " + std::string{row.max.text()};
  }
  if (row.min.has_value()) return ", min: " + std::string{row.min.text()};
  if (row.max.has_value()) return ", max: " + std::string{row.max.text()};
  return {};
}

bool is_list(SettingType type) {
  return type == SettingType::Bitfield || type == SettingType::ExclusiveBitfield || type == SettingType::Radio;
}

/// What a build with a card slot names in `$I` (versions of Plugin_SD_card, June 2026).
constexpr std::array<std::string_view, 2> kCardPlugins = {"SDCARD v1.27", "FS stream v1.12"};

}  // namespace

std::string key_of(const SettingsStore::Slot& slot) {
  const SettingRow& row = *slot.match.row;
  return row.id >= 0 ? std::to_string(row.id + slot.match.axis) : vocabulary::path_of(slot.match);
}

void Listing::line(std::string text) {
  board_.say(protocol::Unrecognized{.line = std::move(text)});
}

void Listing::help() {
  board_.say(protocol::HelpRow{.text = std::string{board_.personality.help}});
}

void Listing::help_on(std::string_view topic) {
  if (topic.empty()) {
    help_topics();
    return;
  }
  if (topic == "COMMANDS") {
    commands();
    return;
  }
  for (const auto& slot : board_.settings.slots()) {
    for (const auto& group : vocabulary::setting_group_rows()) {
      if (group.id == vocabulary::group_of(slot.match) && base::iequals(group.name, topic)) describe_setting(slot);
    }
  }
}

void Listing::help_topics() {
  line("Help topics:");
  line(" Commands");
  line(" Settings");
  std::set<std::string, std::less<>> names;
  const std::set<int> in_use = groups_in_use();
  for (const auto& group : vocabulary::setting_group_rows()) {
    if (group.id != 0 && in_use.contains(group.id)) names.emplace(group.name);
  }
  for (const std::string& name : names) line(" " + name);
}

void Listing::settings() {
  for (const auto& slot : board_.settings.slots()) {
    if (slot.match.row->id >= 0) one_setting(slot);
  }
}

void Listing::one_setting(const SettingsStore::Slot& slot) {
  board_.say(protocol::SettingValue{.id = key_of(slot), .value = slot.text});
}

void Listing::one_named_setting(const SettingsStore::Slot& slot) {
  one_named(vocabulary::path_of(slot.match), named_value(slot.match, slot.text));
}

void Listing::one_named(std::string_view name, std::string_view value) {
  board_.say(protocol::SettingValue{.id = std::string{name}, .value = std::string{value}});
}

std::vector<std::pair<std::string, std::string>> Listing::named() const {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const auto& slot : board_.settings.slots()) {
    rows.emplace_back(vocabulary::path_of(slot.match), named_value(slot.match, slot.text));
  }
  for (std::size_t line = 0; line < board_.stored.startup_lines.size(); ++line) {
    rows.emplace_back("GCode/Line" + std::to_string(line), board_.stored.startup_lines.at(line));
  }
  return rows;
}

void Listing::named_settings() {
  for (const auto& [name, value] : named()) one_named(name, value);
}

void Listing::changed_settings() {
  for (const auto& slot : board_.settings.slots()) {
    const std::string_view usual = vocabulary::default_of(slot.match);
    if (slot.text == usual) continue;
    one_named(vocabulary::path_of(slot.match),
              named_value(slot.match, slot.text) + "    (Default=" + named_value(slot.match, usual) + ")");
  }
}

void Listing::one_startup_line(std::string_view index, std::string_view name) {
  const auto line = base::parse_int<std::size_t>(index).value_or(0);
  one_named(name, board_.stored.startup_lines.at(line));
}

void Listing::state() {
  constexpr std::array kOrder = {MachineState::Idle, MachineState::Alarm, MachineState::Check,
                                 MachineState::Home, MachineState::Run,   MachineState::Hold,
                                 MachineState::Jog,  MachineState::Door,  MachineState::Sleep};
  const auto number = std::ranges::find(kOrder, board_.state) - kOrder.begin();
  line("State 0x" + std::to_string(number));
}

void Listing::memory_use() {
  constexpr std::size_t kEntries = 630;
  const std::size_t used = board_.stored.settings.size() + board_.stored.offsets.size();
  line("[MSG: NVS Used: " + std::to_string(used) + " Free: " + std::to_string(kEntries - used) +
       " Total: " + std::to_string(kEntries) + "]");
}

void Listing::setting_names() {
  for (const auto& slot : board_.settings.slots()) {
    if (slot.match.row->id >= 0) line("$" + key_of(slot) + " => $" + vocabulary::path_of(slot.match));
  }
}

void Listing::commands() {
  for (const CommandRow& row : board_.personality.commands) {
    if (!row.long_name.empty()) {
      line("$" + std::string{row.long_name} + " or $" + std::string{row.name});
    } else if (!row.name.empty()) {
      line("$" + std::string{row.name});
    }
  }
}

void Listing::describe_setting(const SettingsStore::Slot& slot) {
  const SettingRow& row = *slot.match.row;
  std::string text = "$" + key_of(slot) + ": " + vocabulary::full_name(slot.match);
  const std::string unit = unit_of(slot);
  if (!unit.empty()) text += " in " + unit;
  text += type_words(row) + range_words(row);
  if (row.reboot) text += ", reboot required";
  line("");
  line(std::move(text));
  if (!is_list(row.type)) return;
  const int items = static_cast<int>(std::ranges::count(slot.format, ',')) + 1;
  for (int index = 0; index < items; ++index) {
    const std::string_view item = vocabulary::item_of(slot.format, index);
    if (item == "N/A") continue;
    std::string entry = "    " + std::to_string(index) + " - " + std::string{item};
    if (row.type != SettingType::Radio) entry += " (" + std::to_string(1U << static_cast<unsigned>(index)) + ")";
    line(std::move(entry));
  }
}

void Listing::setting_description(std::string_view key) {
  const auto* slot = board_.settings.find(key);
  if (slot == nullptr) return;
  board_.say(protocol::SettingDescription{.id = slot->match.row->id + slot->match.axis,
                                          .text = description_of(*slot->match.row)});
}

void Listing::startup_lines() {
  int index = 0;
  for (const std::string& block : board_.stored.startup_lines) {
    board_.say(protocol::StartupLine{.index = index++, .block = block});
  }
}

std::string Listing::option_letters() const {
  const auto& settings = board_.settings;
  if (!board_.personality.options_follow_settings) {
    return std::string{board_.personality.dialect().options};
  }
  // grblHAL report.c report_build_info: most letters follow settings.
  constexpr int kSpindleOptions = 9;
  constexpr int kParking = 41;
  std::string letters = "VNM";
  if (settings.flag(kParking)) letters += 'P';
  if (settings.flag(setting::kHoming, homing_bit::kOriginZero)) letters += 'Z';
  if (settings.flag(setting::kHoming, homing_bit::kSingleAxis)) letters += 'H';
  if (settings.flag(setting::kHoming, 4)) letters += 'T';
  if (settings.flag(setting::kProbeOptions)) letters += 'A';
  if (settings.flag(kSpindleOptions, 1)) letters += '0';
  if (settings.flag(kParking, 2)) letters += 'R';
  if (!settings.flag(setting::kHoming, homing_bit::kRequiredAtStart)) letters += 'L';
  letters += '+';
  if (!board_.reports(vocabulary::ReportBit::SyncOnWorkOffsetChange)) letters += 'W';
  return letters;
}

std::vector<std::string> Listing::new_options() const {
  const auto& settings = board_.settings;
  std::vector<std::string> flags = {"ENUMS", settings.flag(setting::kLegacyRealtime) ? "RT+" : "RT-"};
  if (settings.flag(setting::kHoming)) flags.emplace_back("HOME");
  if (board_.equipment.pendant) flags.emplace_back("MPG");
  if (settings.is_lathe()) flags.emplace_back("LATHE");
  if (board_.personality.dialect().builds.contains(vocabulary::BuildOption::Expressions)) flags.emplace_back("EXPR");
  if (settings.number(setting::kToolChangeMode) != 4.0) flags.emplace_back("TC");
  if (settings.has_spindle_encoder()) flags.emplace_back("SS");
  flags.emplace_back("SED");
  if (board_.slot.exists()) flags.insert(flags.end(), {"SD", "YM"});
  return flags;
}

void Listing::build_information(bool extended) {
  const vocabulary::Dialect& dialect = board_.personality.dialect();
  const bool has_text = board_.personality.version_has_user_text;
  board_.say(protocol::Version{.version = std::string{dialect.version},
                               .build = std::string{dialect.build},
                               .user_text = board_.stored.user_text,
                               .has_user_text = has_text});
  protocol::BuildOptions options{.letters = option_letters()};
  if (dialect.planner_blocks.printed != 0) options.planner_blocks = dialect.planner_blocks.printed;
  if (dialect.rx_bytes.printed != 0) options.rx_bytes = dialect.rx_bytes.printed;
  if (extended) {
    options.planner_blocks = board_.planner.free_blocks() + board_.planner.block_count();
    options.axes = board_.settings.axes();
    options.tools = board_.personality.hardware.tools;
  }
  board_.say(options);
  if (!extended) return;
  board_.say(protocol::AxisNames{.count = board_.settings.axes(),
                                 .letters = letters_of(board_.all_axes(), board_.settings.axes())});
  board_.say(protocol::NewOptions{.flags = new_options()});
  board_.say(protocol::FirmwareName{.name = std::string{dialect.firmware_field}});
  if (const auto& ports = board_.personality.hardware.ports; ports != gcode::PortCounts{}) {
    const std::string inputs = std::to_string(ports.digital_inputs) + "," + std::to_string(ports.digital_outputs);
    const std::string outputs = std::to_string(ports.analog_inputs) + "," + std::to_string(ports.analog_outputs);
    board_.say(protocol::BuildRow{.key = "AUX IO", .value = inputs + "," + outputs});
  }
  for (const auto& [key, value] : board_.personality.build_rows) {
    board_.say(protocol::BuildRow{.key = std::string{key}, .value = std::string{value}});
  }
  if (!board_.slot.exists()) return;
  for (const std::string_view plugin : kCardPlugins) {
    board_.say(protocol::BuildRow{.key = "PLUGIN", .value = std::string{plugin}});
  }
}

void Listing::limits() {
  board_.say(protocol::BuildRow{.key = "LIMITS", .value = letters_of(board_.limits(), board_.settings.axes()) + ",,,"});
}

void Listing::home_switches() {
  board_.say(protocol::BuildRow{.key = "HOMES", .value = letters_of(board_.limits(), board_.settings.axes()) + ",:L"});
}

void Listing::last_events() {
  board_.say(protocol::BuildRow{
      .key = "LASTEVENTS",
      .value = board_.last_control + "," + letters_of(board_.last_limits, board_.settings.axes()) + ",,,"});
}

void Listing::spindles(bool for_machines) {
  if (!for_machines) {
    line("0 - simulated PWM spindle");
    return;
  }
  board_.say(protocol::BuildRow{
      .key = "SPINDLE",
      .value = std::string{"0|0|0|"} + (board_.settings.has_spindle_encoder() ? "*SDRVE" : "*DRV") +
               "|simulated PWM spindle|" + base::to_fixed(board_.settings.number(setting::kSpindleMin), 1) + "," +
               base::to_fixed(board_.settings.number(setting::kSpindleMax), 1)});
}

}  // namespace kerf::firmware
