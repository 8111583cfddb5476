// What a controller tells of itself, row by row: alarms, errors, groups and settings, in the forms that senders and
// spreadsheets read (protocol.md 5). All of it comes from the tables that the settings are kept in.

#include <algorithm>

#include "common/base/text.hpp"
#include "firmware/listing.hpp"

namespace kerf::firmware {

using vocabulary::SettingRow;
using vocabulary::SettingType;

namespace {

bool is_compiled_in(const vocabulary::CodeRow& row, const Board& board) {
  return board.personality.dialect().builds.contains(row.build) ||
         (row.build == vocabulary::BuildOption::FileSystem && board.slot.exists());
}

std::string quoted(std::string_view text) {
  return "\"" + std::string{text} + "\"";
}

/// `$ESH` names the kind of a value where it has no unit.
std::string_view unit_or_kind(std::string_view unit, SettingType type) {
  if (!unit.empty()) return unit;
  switch (type) {
    case SettingType::Axes:
    case SettingType::Bitfield:
    case SettingType::ExclusiveBitfield: return "mask";
    case SettingType::Bool: return "boolean";
    case SettingType::Radio: return "integer";
    default: return {};
  }
}

std::string_view name_of_type(SettingType type) {
  switch (type) {
    case SettingType::Bool: return "bool";
    case SettingType::Axes:
    case SettingType::Bitfield: return "bitfield";
    case SettingType::ExclusiveBitfield: return "xbitfield";
    case SettingType::Radio: return "radiobuttons";
    case SettingType::Integer: return "integer";
    case SettingType::Decimal: return "float";
    case SettingType::Text: return "string";
    case SettingType::Password: return "password";
    case SettingType::Ipv4: return "ipv4";
  }
  return {};
}

}  // namespace

std::string description_of(const SettingRow& row) {
  std::string text{row.description};
  if (!row.reboot) return text;
  if (!text.empty()) text += "\\n\\n";
  return text + "Acts after a power cycle only.";
}

void Listing::alarms() {
  if (titles()) board_.say(protocol::AlarmCodeRow{.id = 0, .title = "None", .text = "No alarm is active."});
  for (const auto& row : board_.personality.dialect().alarms) {
    if (row.code != 0 && is_compiled_in(row, board_)) one_alarm(row.code);
  }
}

bool Listing::one_alarm(int code) {
  const auto* row = vocabulary::find_code(board_.personality.dialect().alarms, code);
  if (row == nullptr) return false;
  board_.say(protocol::AlarmCodeRow{
      .id = code, .title = titles() ? std::string{row->title} : std::string{}, .text = std::string{row->text}});
  return true;
}

void Listing::errors() {
  board_.say(titles() ? protocol::ErrorCodeRow{.id = 0, .title = "None", .text = "No error occurred."}
                      : protocol::ErrorCodeRow{});
  for (const auto& row : board_.personality.dialect().errors) {
    if (row.code != 0 && is_compiled_in(row, board_)) one_error(row.code);
  }
}

bool Listing::one_error(int code) {
  const auto* row = vocabulary::find_code(board_.personality.dialect().errors, code);
  if (row == nullptr) return false;
  board_.say(protocol::ErrorCodeRow{
      .id = code, .title = titles() ? std::string{row->title} : std::string{}, .text = std::string{row->text}});
  return true;
}

std::set<int> Listing::groups_in_use() const {
  std::set<int> in_use = {0};
  for (const auto& slot : board_.settings.slots()) in_use.insert(vocabulary::group_of(slot.match));
  for (const auto& group : vocabulary::setting_group_rows()) {
    if (in_use.contains(group.id)) in_use.insert(group.parent);
  }
  return in_use;
}

void Listing::setting_groups() {
  const std::set<int> in_use = groups_in_use();
  for (const auto& group : vocabulary::setting_group_rows()) {
    if (!in_use.contains(group.id)) continue;
    board_.say(protocol::SettingGroupRow{.id = group.id, .parent = group.parent, .name = std::string{group.name}});
  }
}

void Listing::setting_definitions() {
  for (const auto& slot : board_.settings.slots()) {
    const SettingRow& row = *slot.match.row;
    if (row.id < 0) continue;
    board_.say(protocol::SettingDefinition{.id = row.id + slot.match.axis,
                                           .group = vocabulary::group_of(slot.match),
                                           .name = vocabulary::full_name(slot.match),
                                           .unit = unit_of(slot),
                                           .type = static_cast<int>(row.type),
                                           .format = slot.format,
                                           .min = std::string{row.min.text()},
                                           .max = std::string{row.max.text()},
                                           .reboot = row.reboot,
                                           .allow_null = row.allow_null});
  }
}

void Listing::codes_as_csv(std::span<const vocabulary::CodeRow> rows) {
  for (const auto& row : rows) {
    if (is_compiled_in(row, board_)) line(quoted(std::to_string(row.code)) + ",\"N/A\"," + quoted(row.text));
  }
}

void Listing::alarms_as_csv() {
  line(R"("Alarm Code in v1.1+"," Alarm Message in v1.0-"," Alarm Description")");
  auto rows = board_.personality.dialect().alarms;
  if (!rows.empty() && rows.front().code == 0) rows = rows.subspan(1);
  codes_as_csv(rows);
}

void Listing::errors_as_csv() {
  line(R"("Error Code in v1.1+","Error Message in v1.0-","Error Description")");
  codes_as_csv(board_.personality.dialect().errors);
}

void Listing::settings_as_csv() {
  line(R"("$-Code"," Setting"," Units"," Setting Description")");
  for (const auto& slot : board_.settings.slots()) {
    std::string text = quoted(key_of(slot));
    for (const std::string& column :
         {vocabulary::full_name(slot.match), unit_of(slot), std::string{slot.match.row->description}}) {
      text.append(",").append(quoted(column));
    }
    line(text + ",");
  }
}

void Listing::settings_as_tabs() {
  line("$-Code\tSetting\tUnits\tDatatype\tData format\tSetting Description\tMin\tMax");
  for (const auto& slot : board_.settings.slots()) {
    const SettingRow& row = *slot.match.row;
    std::string text = key_of(slot);
    const bool masks_axes = slot.format.empty() && row.type == SettingType::Axes;
    for (const std::string& column :
         {vocabulary::full_name(slot.match), std::string{unit_or_kind(unit_of(slot), row.type)},
          std::string{name_of_type(row.type)}, masks_axes ? std::string{"axes"} : slot.format, description_of(row),
          std::string{row.min.text()}, std::string{row.max.text()}, std::string{row.reboot ? "1" : "0"},
          std::string{row.allow_null ? "1" : "0"}}) {
      text.append("\t").append(column);
    }
    line(std::move(text));
  }
}

}  // namespace kerf::firmware
