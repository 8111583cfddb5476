#include "sender/machine/settings_text.hpp"

#include <algorithm>

#include "common/base/text.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::machine {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool may_be_in_name(char letter) {
  const char upper = base::to_upper(letter);
  return base::is_digit(letter) || (upper >= 'A' && upper <= 'Z') || letter == '/' || letter == '_' || letter == '-';
}

bool is_setting_id(std::string_view id) {
  if (id.empty()) return false;
  if (std::ranges::all_of(id, base::is_digit) || is_startup_line(id)) return true;
  return id.contains('/') && std::ranges::all_of(id, may_be_in_name);
}

void append_remark(std::string& out, std::string_view text) {
  for (const std::string_view line : base::split(text, '\n')) out.append("; ").append(base::trim(line)).append("\n");
}

}  // namespace

std::string setting_id_of(std::string_view text) {
  text = base::trim(text);
  if (text.starts_with('$')) text.remove_prefix(1);
  return is_setting_id(text) ? std::string{text} : std::string{};
}

std::expected<std::vector<SettingAssignment>, SettingsTextError> parse_settings_text(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<SettingAssignment> settings;
  std::size_t number = 0;
  for (std::string_view line : base::split(text, '\n')) {
    ++number;
    line = base::trim(line);
    if (line.empty() || line.starts_with('#') || line.starts_with(';')) continue;
    const auto equals = line.find('=');
    const bool is_setting = line.starts_with('$') && equals != std::string_view::npos &&
                            is_setting_id(base::trim(line.substr(1, equals - 1)));
    if (!is_setting) return std::unexpected(SettingsTextError{.line = number, .text = std::string{line}});
    const std::string id{base::trim(line.substr(1, equals - 1))};
    std::erase_if(settings, [&](const SettingAssignment& known) { return known.id == id; });
    settings.push_back({.id = id, .value = std::string{base::trim(line.substr(equals + 1))}});
  }
  return settings;
}

std::string print_settings_text(const Capabilities& machine, const std::vector<SettingAssignment>& settings,
                                const std::vector<std::string>& remarks) {
  std::string out;
  for (const std::string& remark : remarks) append_remark(out, remark);
  for (const SettingAssignment& assignment : settings) {
    const SettingFact* setting = machine.find_setting(assignment.id);
    if (setting != nullptr && !setting->name.empty()) {
      append_remark(out, setting->name + (setting->unit.empty() ? "" : ", " + setting->unit));
    }
    if (setting != nullptr && is_password(*setting)) {
      append_remark(out, "$" + assignment.id + " is a password and is not written down.");
      continue;
    }
    out.append("$").append(assignment.id).append("=").append(assignment.value).append("\n");
  }
  return out;
}

}  // namespace kerf::machine
