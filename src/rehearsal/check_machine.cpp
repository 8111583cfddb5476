#include "rehearsal/check_machine.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/base/text.hpp"
#include "firmware/settings_store.hpp"
#include "rehearsal/program_walk.hpp"
#include "rehearsal/sent_lines.hpp"
#include "sender/machine/controller_rules.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "sender/machine/line_tracker.hpp"

namespace kerf::rehearsal {
namespace {

namespace setting = firmware::setting;

AxisMask all_axes(int axes) {
  return static_cast<AxisMask>((1U << static_cast<unsigned>(axes)) - 1U);
}

AxisValues axis_values(const std::vector<double>& values) {
  AxisValues result{};
  for (std::size_t axis = 0; axis < std::min(values.size(), result.size()); ++axis) {
    result.at(axis) = static_cast<float>(values[axis]);
  }
  return result;
}

/// Axes of which `letters` has the letter.
AxisMask mask_of(std::string_view letters) {
  AxisMask mask = 0;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (letters.contains(vocabulary::kAxisLetters[axis])) mask = static_cast<AxisMask>(mask | 1U << axis);
  }
  return mask;
}

/// On grblHAL limits guard homed axes only (machine_limits.c).
AxisMask guarded_axes(const CheckMachine& machine) {
  const bool homed_only =
      vocabulary::travel_rule_of(machine.dialect->firmware) == vocabulary::TravelRule::HomedEnvelope;
  return homed_only ? machine.homed_axes : all_axes(machine.motion.axes);
}

/// The build that was compiled with expressions, where the controller says so.
const vocabulary::Dialect& dialect_for(const machine::Capabilities& known) {
  const vocabulary::Dialect& usual = vocabulary::dialect_of(known.family);
  if (!known.features.expressions.available.value_or(false)) return usual;
  const auto* const build = vocabulary::find_dialect(std::string{usual.key} + "-expr");
  return build != nullptr ? *build : usual;
}

/// Travel of one axis, as board and machine compute it.
vocabulary::TravelFacts travel_facts(const firmware::SettingsStore& store, int axis) {
  const std::string switch_name =
      std::string(1, vocabulary::kAxisLetters[static_cast<std::size_t>(axis)]) + "/Home/Mpos";
  return {.length_mm = static_cast<float>(store.number(setting::kMaxTravel, axis)),
          .homes_to_minus = store.flag(setting::kHomingDirection, static_cast<unsigned>(axis)),
          .switch_at_mm = static_cast<float>(store.number(switch_name)),
          .pull_off_mm = static_cast<float>(store.number(setting::kHomingPullOff)),
          .zero_at_switch = store.flag(setting::kHoming, firmware::homing_bit::kOriginZero)};
}

/// Where homing leaves the machine.
AxisValues home_position(const firmware::SettingsStore& store, vocabulary::TravelRule rule) {
  AxisValues home{};
  for (int axis = 0; axis < store.axes(); ++axis) {
    home.at(static_cast<std::size_t>(axis)) = vocabulary::home_of(rule, travel_facts(store, axis));
  }
  return home;
}

}  // namespace

CheckMachine check_machine_of(const simulation::CaseMachine& described, const CheckPlace& place) {
  const firmware::Personality& personality = described.personality;
  firmware::SettingsStore store(personality, firmware::axes_of(personality, described.stored));
  static_cast<void>(store.load(described.stored));
  CheckMachine machine{.dialect = &personality.dialect()};
  machine.reader = interpreter_of(described);
  machine.tool_changes = tool_changes_on(*machine.dialect);
  machine.motion = store.motion();
  const bool homes = store.flag(setting::kHoming);
  // Who says where the work zero lies trusts machine coordinates.
  machine.is_homed = homes || place.zero_mm.has_value();
  machine.homed_axes = homes ? all_axes(store.axes()) : AxisMask{0};
  const auto rule = vocabulary::travel_rule_of(machine.dialect->firmware);
  for (int axis = 0; axis < store.axes(); ++axis) {
    vocabulary::TravelFacts facts = travel_facts(store, axis);
    if (!store.flag(setting::kHardLimits)) facts.pull_off_mm = 0;
    if (facts.length_mm > 0) machine.travel.at(static_cast<std::size_t>(axis)) = vocabulary::travel_of(rule, facts);
  }
  if (store.flag(setting::kSoftLimits)) machine.guarded_axes = guarded_axes(machine);
  machine.spindle_rpm_max = static_cast<float>(store.number(setting::kSpindleMax));
  machine.spindle_rpm_min = static_cast<float>(store.number(setting::kSpindleMin));
  machine.is_laser = store.number(setting::kMode) == 1.0;
  if (personality.has_extended_settings) {
    machine.tool_change_mode = static_cast<int>(store.number(setting::kToolChangeMode));
  }
  machine.has_probe = std::ranges::any_of(described.workcell, [](const firmware::WorkcellEvent& event) {
    const auto* surface = std::get_if<firmware::ProbeSurfaceMoved>(&event);
    return surface != nullptr && surface->z_mm.has_value();
  });
  for (const std::string& line : described.stored.startup_lines) {
    if (!line.empty()) machine.startup_lines.push_back(line);
  }

  if (place.zero_mm) machine.reader.offsets().work[0] = axis_values(*place.zero_mm);
  machine.reader.reload_offsets();
  machine.knows_offsets = place.zero_mm.has_value() || described.stored.offsets.contains("G54");
  if (place.position_mm) {
    machine.reader.sync_position(axis_values(*place.position_mm));
    machine.known_place = all_axes(store.axes());
  } else if (machine.knows_offsets && homes) {
    machine.reader.sync_position(home_position(store, rule));
    machine.known_place = all_axes(store.axes());
  }
  return machine;
}

CheckMachine check_machine_of(const machine::Capabilities& known, const machine::Snapshot& snapshot) {
  CheckMachine machine{.dialect = &dialect_for(known)};
  machine.may_have_macros = known.lists_tokens;
  const auto number = [&](int id) { return machine::setting_number(known, id).value_or(0); };
  const gcode::InterpreterSettings settings = machine::interpreter_settings_of(known);
  machine.tool_changes = job::tool_changes_on(known.features.tool_change);
  machine.motion = machine::motion_settings_of(known);
  machine::LineTracker tracker;
  tracker.seed(snapshot, *machine.dialect, settings);
  if (tracker.knows()) {
    machine.reader = *tracker.reader();
    machine.known_place = all_axes(known.axes.count);
    machine.knows_offsets = true;
  } else {
    machine.reader = gcode::Interpreter(gcode::rules_for(*machine.dialect), settings);
    machine.knows_modes = false;
  }
  const bool homes = machine::is_setting_on(known, setting::kHoming);
  machine.is_homed = snapshot.homing.all.value_or(homes);
  machine.homed_axes = snapshot.homing.axes ? mask_of(*snapshot.homing.axes)
                       : machine.is_homed   ? all_axes(known.axes.count)
                                            : AxisMask{0};
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(known.axes.count); ++axis) {
    machine.travel.at(axis) = machine::travel_of_axis(axis, known, *machine.dialect);
  }
  if (machine::is_setting_on(known, setting::kSoftLimits)) machine.guarded_axes = guarded_axes(machine);
  machine.spindle_rpm_max = static_cast<float>(number(setting::kSpindleMax));
  machine.spindle_rpm_min = static_cast<float>(number(setting::kSpindleMin));
  machine.is_laser = number(setting::kMode) == 1.0;
  if (known.lists_tokens) machine.tool_change_mode = static_cast<int>(number(setting::kToolChangeMode));
  for (const std::string_view id : {"N0", "N1"}) {
    const auto* const line = known.find_setting(id);
    if (line != nullptr && line->value && !line->value->empty()) machine.startup_lines.push_back(*line->value);
  }
  machine.has_probe = known.features.probe.available.value_or(false);
  return machine;
}

}  // namespace kerf::rehearsal
