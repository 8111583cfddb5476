#include "common/gcode/parameter_values.hpp"

#include <algorithm>
#include <array>

namespace kerf::gcode {

namespace {

using Values = ParameterValues;

constexpr float kMmPerInch = 25.4F;

float truth(bool is_true) {
  return is_true ? 1.0F : 0.0F;
}

/// Parameters come in tens: the last digit is the axis, 1 for X. Axes that the machine lacks read as 0.
float axis_value(const Values& values, const AxisValues& of, int axis) {
  return axis >= 0 && axis < values.settings.axes ? of.at(static_cast<std::size_t>(axis)) : 0.0F;
}

/// With `$13` on, grblHAL multiplies where it should divide.
float in_report_units(const Values& values, float mm, int axis) {
  const bool turns = axis >= 0 && ((values.settings.rotary_axes >> static_cast<unsigned>(axis)) & 1U) != 0;
  return values.settings.report_inches && !turns ? mm * kMmPerInch : mm;
}

float absolute_position(const Values& values, int axis) {
  return in_report_units(values, axis_value(values, values.machine_position_mm(), axis), axis);
}

float work_position(const Values& values, int axis) {
  const float offset = axis_value(values, values.state.work_offset_mm, axis) +
                       axis_value(values, values.offsets.g92, axis) +
                       axis_value(values, values.offsets.tool_length, axis);
  return in_report_units(values, axis_value(values, values.machine_position_mm(), axis) - offset, axis);
}

int axis_of(int id) {
  return id % 10 - 1;
}

float probe_position(const Values& values, int id) {
  const int axis = axis_of(id);
  const std::uint8_t system = values.offsets.probe_work_offset;
  const AxisValues& offset =
      system == values.state.modal.work_offset ? values.state.work_offset_mm : values.offsets.work.at(system);
  const float mm = axis_value(values, values.offsets.probe, axis) - axis_value(values, offset, axis);
  return in_report_units(values, mm, axis);
}

float work_offset(const Values& values, int id) {
  constexpr int kFirst = 5220;
  constexpr int kSpacing = 20;
  const auto system = static_cast<std::size_t>((id - kFirst - id % 10) / kSpacing);
  return system < values.offsets.work.size() ? axis_value(values, values.offsets.work.at(system), axis_of(id)) : 0.0F;
}

float tool_diameter(const Values& values, int /*id*/) {
  const auto tool = static_cast<std::size_t>(values.state.tool);
  return tool < values.offsets.tools.size() ? values.offsets.tools[tool].radius_mm * 2.0F : 0.0F;
}

struct NumberRow {
  std::uint16_t first;
  std::uint16_t last;
  float (*get)(const Values& values, int id);
};

constexpr NumberRow kNumbered[] = {
    {5061, 5069, probe_position},
    {5070, 5070, [](const Values& values, int) { return truth(values.offsets.probe_succeeded); }},
    {5161, 5169, [](const Values& values, int id) { return axis_value(values, values.offsets.g28, axis_of(id)); }},
    {5181, 5189, [](const Values& values, int id) { return axis_value(values, values.offsets.g30, axis_of(id)); }},
    {5191, 5199,
     [](const Values& values, int id) { return axis_value(values, values.state.scale_factor, axis_of(id)); }},
    {5210, 5210, [](const Values& values, int) { return truth(values.offsets.g92 != AxisValues{}); }},
    {5211, 5219, [](const Values& values, int id) { return axis_value(values, values.offsets.g92, axis_of(id)); }},
    {5220, 5220, [](const Values& values, int) { return static_cast<float>(values.state.modal.work_offset) + 1.0F; }},
    {5221, 5230, work_offset},
    {5241, 5250, work_offset},
    {5261, 5270, work_offset},
    {5281, 5290, work_offset},
    {5301, 5310, work_offset},
    {5321, 5330, work_offset},
    {5341, 5350, work_offset},
    {5361, 5370, work_offset},
    {5381, 5390, work_offset},
    // M66: nothing was waited for.
    {5399, 5399, [](const Values&, int) { return -2.0F; }},
    {5400, 5400, [](const Values& values, int) { return static_cast<float>(values.state.tool); }},
    {5401, 5409,
     [](const Values& values, int id) { return axis_value(values, values.offsets.tool_length, axis_of(id)); }},
    {5410, 5410, tool_diameter},
    {5420, 5428, [](const Values& values, int id) { return work_position(values, id % 10); }},
    {5599, 5599, [](const Values& values, int) { return truth(values.settings.prints_debug); }},
};

/// grblHAL's own numbers of motion modes.
float motion_number(MotionMode motion) {
  constexpr int kProbe = 140;
  switch (motion) {
    case MotionMode::Rapid: return 0.0F;
    case MotionMode::Linear: return 10.0F;
    case MotionMode::ClockwiseArc: return 20.0F;
    case MotionMode::CounterclockwiseArc: return 30.0F;
    case MotionMode::ProbeToward: return kProbe * 10.0F;
    case MotionMode::ProbeTowardNoError: return (kProbe + 1) * 10.0F;
    case MotionMode::ProbeAway: return (kProbe + 2) * 10.0F;
    case MotionMode::ProbeAwayNoError: return (kProbe + 3) * 10.0F;
    case MotionMode::DrillChipBreak: return 730.0F;
    case MotionMode::Drill: return 810.0F;
    case MotionMode::DrillDwell: return 820.0F;
    case MotionMode::DrillPeck: return 830.0F;
    case MotionMode::Tap: return 840.0F;
    case MotionMode::BoreFeedOut: return 850.0F;
    case MotionMode::BoreSpindleStop: return 860.0F;
    case MotionMode::BoreDwell: return 890.0F;
    case MotionMode::CubicSpline: return 50.0F;
    case MotionMode::QuadraticSpline: return 510.0F;
    case MotionMode::SpindleSynchronized: return 330.0F;
    case MotionMode::RigidTap: return 3310.0F;
    case MotionMode::Thread: return 760.0F;
    case MotionMode::None: return 800.0F;
  }
  return 0.0F;
}

/// 540 for G54; 591 for G59.1.
float coordinate_system_number(std::uint8_t system) {
  constexpr int kG54 = 540;
  constexpr int kG59Index = 5;
  const int beyond = system > kG59Index ? system - kG59Index : 0;
  return static_cast<float>(kG54 + (system - beyond) * 10 + beyond);
}

bool is_tool_selected(const Values& values) {
  return values.state.tool_pending != values.state.tool;
}

/// Without a table grblHAL has a single entry, which becomes the tool that was asked for.
float selected_pocket(const Values& values) {
  if (!is_tool_selected(values)) return -1.0F;
  if (values.settings.tools == 0) values.state.tool = values.state.tool_pending;
  return static_cast<float>(values.state.tool_pending);
}

struct NameRow {
  std::string_view name;
  float (*get)(const Values& values);
};

template <FeedMode Mode>
float is_feed_mode(const Values& values) {
  return truth(values.state.modal.feed_mode == Mode);
}
template <int Axis>
float work(const Values& values) {
  return work_position(values, Axis);
}
template <int Axis>
float absolute(const Values& values) {
  return absolute_position(values, Axis);
}
template <int Value>
float always(const Values&) {
  return static_cast<float>(Value);
}

constexpr int kBuild = 260817;

constexpr NameRow kNamed[] = {
    {"_vmajor", [](const Values&) { return 1.1F; }},
    {"_vminor", always<kBuild>},
    {"_line", [](const Values& values) { return static_cast<float>(values.state.line_number); }},
    {"_motion_mode", [](const Values& values) { return motion_number(values.state.modal.motion); }},
    {"_plane", [](const Values& values) { return 170.0F + static_cast<float>(values.state.modal.plane) * 10.0F; }},
    {"_ccomp", always<400>},
    {"_metric", [](const Values& values) { return truth(!values.state.modal.inches); }},
    {"_imperial", [](const Values& values) { return truth(values.state.modal.inches); }},
    {"_absolute", [](const Values& values) { return truth(!values.state.modal.incremental); }},
    {"_incremental", [](const Values& values) { return truth(values.state.modal.incremental); }},
    {"_inverse_time", is_feed_mode<FeedMode::InverseTime>},
    {"_units_per_minute", is_feed_mode<FeedMode::UnitsPerMinute>},
    {"_units_per_rev", is_feed_mode<FeedMode::UnitsPerRevolution>},
    {"_coord_system", [](const Values& values) { return coordinate_system_number(values.state.modal.work_offset); }},
    {"_tool_offset",
     [](const Values& values) { return truth(values.state.modal.tool_length != ToolLengthMode::None); }},
    {"_retract_r_plane",
     [](const Values& values) { return truth(values.state.modal.retract == RetractMode::Previous); }},
    {"_retract_old_z",
     [](const Values& values) { return truth(values.state.modal.retract == RetractMode::RPosition); }},
    {"_spindle_rpm_mode", [](const Values& values) { return truth(!values.state.modal.surface_speed); }},
    {"_spindle_css_mode", [](const Values& values) { return truth(values.state.modal.surface_speed); }},
    {"_ijk_absolute_mode", always<0>},
    {"_lathe_diameter_mode", [](const Values& values) { return truth(values.state.modal.diameter); }},
    {"_lathe_radius_mode", [](const Values& values) { return truth(!values.state.modal.diameter); }},
    {"_spindle_on", [](const Values& values) { return truth(values.state.modal.spindle != SpindleDirection::Off); }},
    {"_spindle_cw",
     [](const Values& values) { return truth(values.state.modal.spindle == SpindleDirection::Counterclockwise); }},
    {"_mist", [](const Values& values) { return truth(values.state.modal.coolant.mist); }},
    {"_flood", [](const Values& values) { return truth(values.state.modal.coolant.flood); }},
    {"_speed_override", [](const Values& values) { return truth(values.state.modal.overrides.spindle); }},
    {"_feed_override", [](const Values& values) { return truth(values.state.modal.overrides.feed); }},
    {"_adaptive_feed", always<0>},
    {"_feed_hold", [](const Values& values) { return truth(values.state.modal.overrides.feed_hold); }},
    {"_feed", [](const Values& values) { return values.state.feed_rate; }},
    {"_rpm", [](const Values& values) { return values.state.spindle_rpm; }},
    {"_x", work<0>},
    {"_y", work<1>},
    {"_z", work<2>},
    {"_a", work<3>},
    {"_b", work<4>},
    {"_c", work<5>},
    {"_u", work<6>},
    {"_v", work<7>},
    {"_w", always<0>},
    {"_abs_x", absolute<0>},
    {"_abs_y", absolute<1>},
    {"_abs_z", absolute<2>},
    {"_abs_a", absolute<3>},
    {"_abs_b", absolute<4>},
    {"_abs_c", absolute<5>},
    {"_abs_u", absolute<6>},
    {"_abs_v", absolute<7>},
    {"_abs_w", always<0>},
    {"_current_tool", [](const Values& values) { return static_cast<float>(values.state.tool); }},
    {"_current_pocket", [](const Values& values) { return static_cast<float>(values.state.tool); }},
    {"_selected_tool",
     [](const Values& values) {
       return is_tool_selected(values) ? static_cast<float>(values.state.tool_pending) : -1.0F;
     }},
    {"_selected_pocket", selected_pocket},
    {"_call_level", [](const Values& values) { return static_cast<float>(values.written.call_level()); }},
    // The reference build tells nothing about its probe input.
    {"_probe_state", always<-1>},
    {"_probe2_state", always<-1>},
    {"_toolsetter_state", always<-1>},
    {"_active_probe", always<0>},
    {"_homed_state",
     [](const Values& values) { return truth(values.machine != nullptr && values.machine->is_homed()); }},
    {"_homed_axes",
     [](const Values& values) {
       return values.machine != nullptr ? static_cast<float>(values.machine->homed_axes()) : 0.0F;
     }},
    {"_tool_table_size", [](const Values& values) { return static_cast<float>(values.settings.tools); }},
    {"_free_memory", always<-1>},
};

const NameRow* find_predefined(std::string_view name) {
  if (!name.starts_with('_')) return nullptr;
  const auto* found = std::ranges::find(kNamed, name, &NameRow::name);
  return found == std::end(kNamed) ? nullptr : found;
}

}  // namespace

std::optional<float> ParameterValues::get(std::uint16_t id) const {
  if (Parameters::is_writable(id)) return written.get(id);
  const auto* row = std::ranges::find_if(kNumbered, [id](const NumberRow& r) { return id >= r.first && id <= r.last; });
  if (row == std::end(kNumbered)) return std::nullopt;
  return row->get(*this, id);
}

std::optional<float> ParameterValues::get(std::string_view name) const {
  const auto clean = clean_name(name);
  if (!clean) return std::nullopt;
  if (const NameRow* row = find_predefined(*clean)) return row->get(*this);
  return written.get(*clean);
}

bool ParameterValues::set(std::string_view name, float value) const {
  const auto clean = clean_name(name);
  if (!clean) return false;
  if (find_predefined(*clean) == nullptr) written.set(*clean, value);
  return true;
}

}  // namespace kerf::gcode
