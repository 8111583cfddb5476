#include "sender/machine/settings_plan.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "common/base/text.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::machine {
namespace {

using vocabulary::FirmwareSet;

/// `setting` is written after `needs`; `must_be_on`: and is refused while bit 0 of that is off.
struct Dependency {
  int setting;
  int last;  ///< of a range
  int needs;
  bool must_be_on;
  FirmwareSet known_to;
};

// grblHAL settings.c set_homing_enable, gnea/grbl settings.c: soft limits and clipped jogs need homing; switching
// homing on copies X's homing rates to all axes; what selects a spindle, an axis' kind or how texts are read comes
// before what depends on it. Rabbit takes soft limits without homing.
constexpr auto kGrblAndHal = FirmwareSet::Grbl | FirmwareSet::GrblHal;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr std::array kDependencies{
    Dependency{20, 20, 22, true, kGrblAndHal}, Dependency{40, 40, 22, true, kHal},
    Dependency{24, 25, 22, false, kHal},       Dependency{44, 49, 22, false, kHal},
    Dependency{180, 197, 22, false, kHal},     Dependency{180, 197, 25, false, kHal},
    Dependency{32, 36, 9, false, kHal},        Dependency{30, 36, 395, false, kHal},
    Dependency{100, 139, 376, false, kHal},    Dependency{74, 79, 39, false, kHal},
    Dependency{300, 336, 39, false, kHal},     Dependency{342, 346, 341, false, kHal},
};

bool concerns(const Dependency& row, int id) {
  return id >= row.setting && id <= row.last && id != row.needs;
}

/// True when `earlier` has to be written before `later`.
bool comes_before(vocabulary::Firmware firmware, const std::string& earlier, const std::string& later) {
  // Units, limits and speeds before a line that runs when it is written.
  if (is_startup_line(later)) return !is_startup_line(earlier);
  const int first = base::parse_int(earlier).value_or(-1);
  const int second = base::parse_int(later).value_or(-1);
  return std::ranges::any_of(kDependencies, [&](const Dependency& row) {
    return vocabulary::contains(row.known_to, firmware) && row.needs == first && concerns(row, second);
  });
}

using Values = std::map<std::string, std::string, std::less<>>;

Values values_after(const Capabilities& machine, const std::vector<SettingDifference>& steps) {
  Values values;
  for (const SettingFact& setting : machine.settings) values[setting.id] = setting.value.value_or("");
  for (const SettingDifference& step : steps) values[step.id] = step.after;
  return values;
}

bool is_on(const Values& values, const std::string& id) {
  const auto found = values.find(id);
  return found != values.end() && base::parse_int<unsigned>(found->second).value_or(0) % 2 == 1;
}

/// Settings that would be refused because another one is off after all changes.
void check_needs(const Capabilities& machine, const std::vector<SettingDifference>& steps,
                 std::vector<SettingRefusal>& refusals) {
  const Values values = values_after(machine, steps);
  for (const SettingDifference& step : steps) {
    for (const Dependency& row : kDependencies) {
      const bool concerned = row.must_be_on && vocabulary::contains(row.known_to, machine.family) &&
                             concerns(row, base::parse_int(step.id).value_or(-1));
      const std::string needed = std::to_string(row.needs);
      if (!concerned || step.after == "0" || is_on(values, needed)) continue;
      const SettingFact* other = machine.find_setting(needed);
      const SettingFact* setting = machine.find_setting(step.id);
      refusals.push_back(
          {.id = step.id,
           .fault = SettingFault::NeedsOther,
           .sentence = (setting == nullptr ? "$" + step.id : label_of(*setting)) + " cannot be switched on while " +
                       (other == nullptr ? "$" + needed : label_of(*other)) + " is off: switch that on first."});
    }
  }
}

SettingRefusal unknown_setting(const std::string& id) {
  return {.id = id,
          .fault = SettingFault::UnknownSetting,
          .sentence = "This machine has no setting $" + id + ": 'kerf settings list' shows those that it has."};
}

std::string find_value(const std::vector<SettingAssignment>& settings, const std::string& id) {
  const auto found = std::ranges::find(settings, id, &SettingAssignment::id);
  return found == settings.end() ? std::string{} : found->value;
}

bool has(const std::vector<SettingAssignment>& settings, const std::string& id) {
  return std::ranges::find(settings, id, &SettingAssignment::id) != settings.end();
}

SettingDifference describe(const Capabilities& machine, const std::string& id) {
  SettingDifference row{.id = id};
  if (const SettingFact* setting = machine.find_setting(id)) {
    row.name = setting->name;
    row.unit = setting->unit;
    row.reboot_required = setting->reboot_required;
  }
  return row;
}

bool is_same(const Capabilities& machine, const std::string& id, std::string_view left, std::string_view right) {
  const SettingFact* setting = machine.find_setting(id);
  return is_same_value(setting == nullptr ? SettingFact{.id = id} : *setting, left, right);
}

}  // namespace

// As they came, except that each follows what it needs.
std::vector<SettingDifference> in_writing_order(vocabulary::Firmware firmware, std::vector<SettingDifference> steps) {
  std::vector<SettingDifference> ordered;
  ordered.reserve(steps.size());
  while (!steps.empty()) {
    const auto is_free = [&](const SettingDifference& step) {
      return std::ranges::none_of(
          steps, [&](const SettingDifference& other) { return comes_before(firmware, other.id, step.id); });
    };
    auto next = std::ranges::find_if(steps, is_free);
    if (next == steps.end()) next = steps.begin();  // rows that need each other: the order of the file
    ordered.push_back(std::move(*next));
    steps.erase(next);
  }
  return ordered;
}

std::expected<SettingsPlan, std::vector<SettingRefusal>> plan_settings(const Capabilities& machine,
                                                                       const std::vector<SettingAssignment>& wanted) {
  const SettingRules rules = setting_rules_of(machine);
  std::vector<SettingRefusal> refusals;
  std::vector<SettingDifference> steps;
  for (const SettingAssignment& assignment : wanted) {
    const SettingFact* setting = machine.find_setting(assignment.id);
    if (setting == nullptr) {
      refusals.push_back(unknown_setting(assignment.id));
      continue;
    }
    std::erase_if(steps, [&](const SettingDifference& step) { return step.id == setting->id; });
    // What the machine has, it may keep, even if it is out of the range that it gives.
    if (setting->value && is_same_value(*setting, *setting->value, assignment.value)) continue;
    auto value = check_setting(*setting, assignment.value, rules);
    if (!value) {
      refusals.push_back(std::move(value.error()));
      continue;
    }
    if (setting->value && is_same_value(*setting, *setting->value, *value)) continue;
    SettingDifference step = describe(machine, setting->id);
    step.before = setting->value.value_or("");
    step.known_before = setting->value.has_value();
    step.after = *std::move(value);
    steps.push_back(std::move(step));
  }
  check_needs(machine, steps, refusals);
  if (!refusals.empty()) return std::unexpected(std::move(refusals));
  return SettingsPlan{.steps = in_writing_order(machine.family, std::move(steps))};
}

std::vector<SettingAssignment> settings_of(const Capabilities& machine) {
  std::vector<SettingAssignment> settings;
  for (const SettingFact& setting : machine.settings) {
    if (setting.value) settings.push_back({.id = setting.id, .value = *setting.value});
  }
  return settings;
}

std::vector<SettingDifference> differences(const Capabilities& machine, const std::vector<SettingAssignment>& before,
                                           const std::vector<SettingAssignment>& after) {
  std::vector<SettingDifference> found;
  const auto add = [&](const std::string& id) {
    const SettingFact* setting = machine.find_setting(id);
    if (setting != nullptr && is_password(*setting)) return;
    SettingDifference row = describe(machine, id);
    row.before = find_value(before, id);
    row.after = find_value(after, id);
    row.known_before = has(before, id);
    row.known_after = has(after, id);
    const bool same = row.known_before == row.known_after && is_same(machine, id, row.before, row.after);
    if (!same) found.push_back(std::move(row));
  };
  for (const SettingAssignment& setting : before) add(setting.id);
  for (const SettingAssignment& setting : after) {
    if (!has(before, setting.id)) add(setting.id);
  }
  return found;
}

std::string sentence_of(const SettingDifference& difference) {
  const std::string unit = difference.unit.empty() ? "" : " " + difference.unit;
  std::string text = "$" + difference.id;
  if (!difference.name.empty()) text += " (" + difference.name + ")";
  text += ": ";
  if (!difference.known_before) return text + "new, " + difference.after + unit;
  if (!difference.known_after) return text + difference.before + unit + " -> not there any more";
  return text + difference.before + " -> " + difference.after + unit;
}

}  // namespace kerf::machine
