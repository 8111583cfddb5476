// The settings of each firmware.

#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/settings.hpp"
#include "markdown.hpp"

namespace kerf::tools {

using vocabulary::BuildOption;
using vocabulary::SettingRow;
using vocabulary::SettingType;

namespace {

std::string_view type_name(SettingType type) {
  switch (type) {
    case SettingType::Bool: return "0 or 1";
    case SettingType::Bitfield: return "bits";
    case SettingType::ExclusiveBitfield: return "bits, bit 0 enables";
    case SettingType::Radio: return "choice";
    case SettingType::Axes: return "axes";
    case SettingType::Integer: return "whole number";
    case SettingType::Decimal: return "number";
    case SettingType::Text: return "text";
    case SettingType::Password: return "password";
    case SettingType::Ipv4: return "IPv4 address";
  }
  return "";
}

std::string number_of(const SettingRow& row) {
  if (row.id < 0) return "$" + std::string{row.path};
  return "$" + std::to_string(row.id) + (row.per_axis ? " + axis" : "");
}

std::string range_of(const SettingRow& row) {
  const bool is_length = row.type == SettingType::Text || row.type == SettingType::Password;
  const std::string unit = is_length ? " characters" : "";
  if (row.min && row.max) return std::string{row.min.text()} + " to " + std::string{row.max.text()} + unit;
  if (row.min) return "from " + std::string{row.min.text()} + unit;
  return row.max ? "up to " + std::string{row.max.text()} + unit : "";
}

/// Items of a bit field or radio with their numbers; the mask of a number is left out.
std::string items_of(const SettingRow& row) {
  const bool has_items =
      row.type == SettingType::Bitfield || row.type == SettingType::ExclusiveBitfield || row.type == SettingType::Radio;
  if (!has_items) return "";
  std::string text;
  for (int index = 0; index < 32; ++index) {
    const std::string_view item = vocabulary::item_of(row.format, index);
    if (item.empty()) break;
    if (item == "N/A") continue;
    if (!text.empty()) text += ", ";
    text.append(std::to_string(index)).append(" ").append(item);
  }
  return text;
}

std::string remarks_of(const SettingRow& row) {
  std::string text{row.description};
  const std::string items = items_of(row);
  if (!items.empty()) text = items + (text.empty() ? "." : ". " + text);
  if (row.reboot) text += text.empty() ? "After a power cycle." : " After a power cycle.";
  return text;
}

std::string presence_of(const SettingRow& row) {
  switch (row.build) {
    case BuildOption::Usual: return "";
    case BuildOption::FourAxes: return "4 axes";
    case BuildOption::FiveAxes: return "5 axes";
    case BuildOption::SixAxes: return "6 axes";
    default: return "option";
  }
}

std::string group_name(int id) {
  for (const auto& group : vocabulary::setting_group_rows()) {
    if (group.id == id) return std::string{group.name};
  }
  return "";
}

Page settings_page(const vocabulary::Dialect& dialect, std::string_view file) {
  Table table({"setting", "name", "unit", "type", "range", "default", "group", "build", "remarks"});
  for (const SettingRow& row : dialect.settings) {
    const std::string name = row.per_axis ? "(axis)" + std::string{row.name} : std::string{row.name};
    table.row({code(number_of(row)), name, std::string{row.unit}, std::string{type_name(row.type)}, range_of(row),
               code(row.default_value), group_name(row.group), presence_of(row), remarks_of(row)});
  }
  std::string introduction = "The settings of ";
  introduction.append(dialect.name)
      .append(
          " as `$$` lists them, with names, units and ranges as the firmware enumerates them. An empty *build* is the "
          "reference build; *option* needs a driver, a plugin or a build option. Rows with *+ axis* have one setting "
          "an axis: X first. Every controller may have been built with other defaults and ranges: where it enumerates "
          "(`$ES`), believe it.");
  return {.name = file, .text = page_head("Settings of " + std::string{dialect.name}, introduction) + table.text()};
}

}  // namespace

std::vector<Page> settings_pages() {
  return {settings_page(vocabulary::dialect_of(vocabulary::Firmware::Grbl), "settings-grbl.md"),
          settings_page(vocabulary::dialect_of(vocabulary::Firmware::Rabbit), "settings-rabbit.md"),
          settings_page(vocabulary::dialect_of(vocabulary::Firmware::GrblHal), "settings-grblhal.md")};
}

}  // namespace kerf::tools
