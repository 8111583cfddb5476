#include "sender/machine/controller_rules.hpp"

#include <cstddef>
#include <string>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::machine {
namespace {

// The same numbers mean other things on Rabbit (protocol.md 7.5), which has only the first five.
constexpr int kArcTolerance = 12;
constexpr int kReportInches = 13;
constexpr int kMode = 32;
constexpr int kStepsPerMm = 100;
constexpr int kMaxRate = 110;
constexpr int kAcceleration = 120;
constexpr int kG73Retract = 28;
constexpr int kSpindleMax = 30;
constexpr int kSpindleMin = 31;
constexpr int kParking = 41;
constexpr int kRestoreOverrides = 60;
constexpr int kRotaryAxes = 376;
constexpr int kG92Volatile = 384;
constexpr int kPlannerBlocks = 398;
constexpr int kLockedOffsets = 486;

constexpr std::size_t kFirstRotary = 3;
constexpr unsigned kParkingOverrideBit = 2;

double number(const Capabilities& known, int id, double otherwise = 0) {
  const SettingFact* const setting = known.find_setting(std::to_string(id));
  if (setting == nullptr || !setting->value) return otherwise;
  return base::parse_decimal(*setting->value).value_or(otherwise);
}

unsigned mask(const Capabilities& known, int id) {
  return static_cast<unsigned>(number(known, id));
}

vocabulary::AxisValues axis_values(const Capabilities& known, int first_id) {
  vocabulary::AxisValues values{};
  for (int axis = 0; axis < known.axes.count; ++axis) {
    values.at(static_cast<std::size_t>(axis)) = static_cast<float>(number(known, first_id + axis));
  }
  return values;
}

}  // namespace

gcode::InterpreterSettings interpreter_settings_of(const Capabilities& known) {
  gcode::InterpreterSettings settings{.axes = known.axes.count};
  settings.laser_mode = number(known, kMode) == 1.0 && known.features.laser.available.value_or(false);
  settings.report_inches = number(known, kReportInches) != 0;
  if (!known.lists_tokens) return settings;
  settings.lathe_mode = number(known, kMode) == 2.0;
  settings.ignore_tool_change = known.features.tool_change.kind == ToolChangeKind::Ignored;
  settings.spindle_rpm_max = static_cast<float>(number(known, kSpindleMax));
  settings.spindle_rpm_min = static_cast<float>(number(known, kSpindleMin));
  settings.g92_volatile = number(known, kG92Volatile) != 0;
  settings.restore_overrides_at_end = number(known, kRestoreOverrides) != 0;
  settings.locked_work_offsets = mask(known, kLockedOffsets);
  settings.rotary_axes = static_cast<vocabulary::AxisMask>(mask(known, kRotaryAxes) << kFirstRotary);
  settings.parking_override_control =
      (mask(known, kParking) & 1U) != 0 && (mask(known, kParking) >> kParkingOverrideBit & 1U) != 0;
  settings.tools = known.tools.value_or(0);
  const AuxPortsFact& ports = known.features.aux_ports;
  settings.ports = {.digital_inputs = ports.digital_inputs,
                    .digital_outputs = ports.digital_outputs,
                    .analog_inputs = ports.analog_inputs,
                    .analog_outputs = ports.analog_outputs};
  settings.spindle_encoder = known.features.spindle_sync.available.value_or(false);
  settings.g73_retract_mm = static_cast<float>(number(known, kG73Retract, 0.1));
  return settings;
}

motion::MotionSettings motion_settings_of(const Capabilities& known) {
  const motion::MotionSettings usual;
  return {.axes = known.axes.count,
          .steps_per_mm = axis_values(known, kStepsPerMm),
          .max_rate_mm_per_min = axis_values(known, kMaxRate),
          .acceleration_mm_per_s2 = axis_values(known, kAcceleration),
          .arc_tolerance_mm = static_cast<float>(number(known, kArcTolerance, usual.arc_tolerance_mm)),
          .laser_mode = number(known, kMode) == 1.0,
          .planner_blocks = static_cast<int>(number(known, kPlannerBlocks))};
}

}  // namespace kerf::machine
