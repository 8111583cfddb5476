#include "sender/job/audit_plan.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/travel.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::job {
namespace {

using machine::Capabilities;
using machine::setting_number;
using machine::SettingAssignment;
using machine::Snapshot;
using vocabulary::Firmware;
using vocabulary::MachineState;

constexpr int kHoming = 22;
constexpr int kLocateRate = 24;
constexpr int kSeekRate = 25;
constexpr int kPullOff = 27;
constexpr int kStepsPerMm = 100;
constexpr std::size_t kZ = 2;

/// Each of them acts at or before a switch: soft and hard limits, and grblHAL's limits for jogs.
constexpr std::array<std::string_view, 3> kProtections{"20", "21", "40"};

/// Settings of the axes that home together (protocol.md 7). Grbl's are compiled in: all axes.
struct CyclesRow {
  Firmware firmware;
  int first_setting;
};
constexpr CyclesRow kCycles[] = {{Firmware::Rabbit, 50}, {Firmware::GrblHal, 44}};
constexpr int kMostCycles = 6;

bool homes(const Capabilities& machine, std::size_t axis) {
  const auto* const row = std::ranges::find(kCycles, machine.family, &CyclesRow::firmware);
  if (row == std::end(kCycles)) return true;
  for (int id = row->first_setting; id < row->first_setting + kMostCycles; ++id) {
    if (machine::is_setting_on(machine, id, static_cast<unsigned>(axis))) return true;
  }
  return false;
}

/// Why no machine in this state can be audited; empty if it can.
std::string why_not_now(const Snapshot& now) {
  if (now.pendant_in_control) return "A pendant has the machine: audit it once the pendant has given it back.";
  if (now.state == MachineState::Alarm) {
    return "The machine is in alarm, and does not know where it is: home it ($H). The next audit then tells what it "
           "lost since.";
  }
  if (now.state != MachineState::Idle) return "The machine is not idle: audit it when it stands still.";
  if (now.homing.all && !*now.homing.all) {
    return "The machine is not homed, so there is no position to compare with: home it ($H), work, and audit then.";
  }
  if (!now.machine_position_mm) return "The machine does not tell its machine position.";
  if (!now.inputs) {
    return "The controller is set not to report its limit switches ($10): without them nothing can be measured.";
  }
  if (!now.inputs->limits.empty()) {
    return "A limit switch is closed (" + now.inputs->limits + "): jog the machine off it, or mend it, then audit.";
  }
  return {};
}

std::optional<AuditAxis> axis_of(const Capabilities& machine, const Snapshot& now, std::size_t index) {
  const auto facts = machine::travel_facts(index, machine);
  const auto steps = setting_number(machine, kStepsPerMm + static_cast<int>(index));
  if (!facts || !steps || *steps <= 0 || index >= now.machine_position_mm->size()) return std::nullopt;
  AuditAxis axis{.letter = vocabulary::kAxisLetters.at(index),
                 .index = index,
                 .direction = facts->homes_to_minus ? -1 : 1,
                 .steps_per_mm = *steps,
                 .home_mm = static_cast<double>(home_of(vocabulary::travel_rule_of(machine.family), *facts))};
  const auto& told = now.homing.home_position_mm;
  if (told && index < told->size() && now.homing.axes.value_or("").contains(axis.letter)) axis.home_mm = (*told)[index];
  return axis;
}

void add_protections(AuditPlan& plan, const Capabilities& machine, const std::vector<SettingAssignment>& left_off) {
  for (const std::string_view id : kProtections) {
    const auto* const fact = machine.find_setting(id);
    if (fact == nullptr || !fact->value) continue;
    const bool is_on = base::parse_decimal(base::trim(*fact->value)).value_or(0) != 0;
    if (is_on) {
      plan.protections_off.push_back({.id = fact->id, .value = "0"});
      plan.protections.push_back({.id = fact->id, .value = *fact->value});
    } else if (const auto before = std::ranges::find(left_off, fact->id, &SettingAssignment::id);
               before != left_off.end()) {
      plan.protections.push_back(*before);
    }
  }
}

}  // namespace

std::expected<AuditPlan, std::string> plan_audit(const Capabilities& machine, const Snapshot& now,
                                                 std::string_view letters,
                                                 const std::vector<SettingAssignment>& left_off) {
  if (!machine::is_setting_on(machine, kHoming)) {
    return std::unexpected{
        "Homing is off ($22=0), so there is nothing to measure the position against. Where the machine has homing "
        "switches, set it up to home ($22=1), and home it ($H)."};
  }
  if (std::string why = why_not_now(now); !why.empty()) return std::unexpected{std::move(why)};
  AuditPlan plan{.pull_off_mm = setting_number(machine, kPullOff).value_or(0),
                 .seek_mm_per_min = setting_number(machine, kSeekRate).value_or(0),
                 .locate_mm_per_min = setting_number(machine, kLocateRate).value_or(0),
                 .is_known_homed = now.homing.all.value_or(false)};
  if (plan.pull_off_mm <= 0 || plan.seek_mm_per_min <= 0 || plan.locate_mm_per_min <= 0) {
    return std::unexpected{"The settings of homing are not known ($24, $25, $27)."};
  }
  // Z is brought out of the way whatever is asked for.
  const auto wants = [&](char letter) { return letters.empty() || letters.contains(letter) || letter == 'Z'; };
  for (std::size_t index = 0; index < static_cast<std::size_t>(machine.axes.count); ++index) {
    if (!wants(vocabulary::kAxisLetters.at(index)) || !homes(machine, index)) continue;
    if (const auto axis = axis_of(machine, now, index)) plan.axes.push_back(*axis);
  }
  for (const char letter : letters) {
    if (std::ranges::find(plan.axes, letter, &AuditAxis::letter) == plan.axes.end()) {
      return std::unexpected{std::string{letter} + " is no axis of this machine that homes."};
    }
  }
  if (plan.axes.empty()) return std::unexpected{"No axis of this machine is set up to home."};
  const auto z = std::ranges::find(plan.axes, kZ, &AuditAxis::index);
  if (z != plan.axes.end() && z->direction < 0) {
    return std::unexpected{
        "Z homes downwards: it would go into the work before the other axes could move. Such a machine is not "
        "audited."};
  }
  if (z == plan.axes.end() && letters.empty()) {
    return std::unexpected{
        "Z does not home, so it cannot be brought out of the way first. Bring it up yourself, and name the axes "
        "(--axes "
        "XY)."};
  }
  if (z != plan.axes.end()) std::rotate(plan.axes.begin(), z, z + 1);
  add_protections(plan, machine, left_off);
  return plan;
}

}  // namespace kerf::job
