#include "apps/setting_text.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "apps/output.hpp"
#include "common/base/text.hpp"
#include "preparation/settings_json.hpp"

namespace kerf::apps {
using preparation::shown_value;

namespace {

using machine::Capabilities;
using machine::SettingFact;
using machine::SettingGroupFact;

/// Settings that have a name only come behind the numbers.
constexpr int kLast = 1'000'000;

const SettingGroupFact* find_group(const Capabilities& machine, int id) {
  const auto found = std::ranges::find(machine.setting_groups, id, &SettingGroupFact::id);
  return found == machine.setting_groups.end() ? nullptr : &*found;
}

/// "Axis, X-axis"; the root has no name of interest.
std::string group_path(const Capabilities& machine, int id) {
  constexpr int kDeepest = 5;
  std::string path;
  for (int depth = 0; depth < kDeepest && id > 0; ++depth) {
    const SettingGroupFact* group = find_group(machine, id);
    if (group == nullptr) break;
    path = path.empty() ? group->name : group->name + ", " + path;
    id = group->parent;
  }
  return path.empty() ? "Other" : path;
}

void print_help(const SettingFact& setting) {
  if (setting.help.empty()) return;
  for (const std::string_view line : base::split(setting.help, '\n')) {
    if (!base::trim(line).empty()) put("      {}\n", base::trim(line));
  }
}

void print_line(const SettingFact& setting, const machine::SettingRules& rules) {
  const std::string value = shown_value(setting);
  const std::string meaning = machine::explain_value(setting, setting.value.value_or(""), rules);
  const std::string words = meaning.empty() || meaning == value ? setting.name : setting.name + ": " + meaning;
  put("  {:<20} {}\n", fmt::format("${}={}", setting.id, value), words);
}

}  // namespace

bool is_in_group(const Capabilities& machine, const SettingFact& setting, std::string_view group) {
  constexpr int kDeepest = 5;
  int id = setting.group_id;
  for (int depth = 0; depth < kDeepest && id > 0; ++depth) {
    const SettingGroupFact* found = find_group(machine, id);
    if (found == nullptr) return false;
    if (base::iequals(found->name, group) || base::parse_int(group) == id) return true;
    id = found->parent;
  }
  return false;
}

void print_settings(const Capabilities& machine, std::vector<SettingFact> settings, bool verbose) {
  const auto rules = machine::setting_rules_of(machine);
  const auto place = [](const SettingFact& setting) {
    return std::tuple{setting.group_id < 0 ? kLast : setting.group_id, base::parse_int(setting.id).value_or(kLast),
                      setting.id};
  };
  std::ranges::sort(settings, {}, place);
  int group = -2;
  for (const SettingFact& setting : settings) {
    if (setting.group_id != group) {
      put("{}{}\n", group == -2 ? "" : "\n", group_path(machine, setting.group_id));
      group = setting.group_id;
    }
    print_line(setting, rules);
    if (!verbose) continue;
    put("      takes {}{}\n", machine::explain_range(setting, rules),
        setting.reboot_required ? "; acts after the controller was switched off and on" : "");
    print_help(setting);
  }
}

void print_setting(const Capabilities& machine, const SettingFact& setting) {
  const auto rules = machine::setting_rules_of(machine);
  print_line(setting, rules);
  put("      {}; takes {}\n", group_path(machine, setting.group_id), machine::explain_range(setting, rules));
  if (setting.reboot_required) put("      Acts after the controller was switched off and on.\n");
  print_help(setting);
}

}  // namespace kerf::apps
