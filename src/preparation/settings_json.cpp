#include "preparation/settings_json.hpp"

#include <utility>

namespace kerf::preparation {

using machine::Capabilities;
using machine::SettingFact;

std::string shown_value(const SettingFact& setting) {
  if (!setting.value) return "(not told)";
  if (machine::is_password(setting)) return setting.value->empty() ? "" : std::string{machine::kStars};
  return *setting.value;
}

io::Json settings_json(const Capabilities& machine, const std::vector<SettingFact>& settings) {
  const auto rules = machine::setting_rules_of(machine);
  io::Json list = io::Json::array();
  for (const SettingFact& setting : settings) {
    SettingFact shown = setting;
    if (shown.value) shown.value = shown_value(setting);
    io::Json row = io::to_json(shown);
    row["meaning"] = machine::explain_value(setting, setting.value.value_or(""), rules);
    row["range"] = machine::explain_range(setting, rules);
    list.push_back(std::move(row));
  }
  io::Json object = io::Json::object();
  object["settings"] = std::move(list);
  object["groups"] = io::to_json(machine.setting_groups);
  return object;
}

}  // namespace kerf::preparation
