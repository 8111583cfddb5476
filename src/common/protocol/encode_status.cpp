#include <algorithm>

#include "common/base/text.hpp"
#include "common/protocol/encode.hpp"
#include "common/protocol/printer.hpp"

namespace kerf::protocol {
namespace {

using vocabulary::StatusField;

// Appends `|NAME:` and leaves the value to the caller.
std::string& begin_field(std::string& out, std::string_view name) {
  out += '|';
  out += name;
  out += ':';
  return out;
}

void add_positions(std::string& out, std::string_view name, const std::optional<std::vector<double>>& values,
                   const PrintStyle& style) {
  if (values) append_positions(begin_field(out, name), *values, style);
}

void add_text(std::string& out, std::string_view name, const std::optional<std::string>& text) {
  if (text) begin_field(out, name) += *text;
}

void add_flag(std::string& out, std::string_view name, const std::optional<bool>& flag) {
  if (flag) begin_field(out, name) += *flag ? '1' : '0';
}

template <typename Integer>
void add_number(std::string& out, std::string_view name, const std::optional<Integer>& number) {
  if (number) begin_field(out, name) += std::to_string(*number);
}

// FS:250,12000[,11980], or F:250 without variable spindle
void add_speeds(std::string& out, const StatusReport& report, const PrintStyle& style) {
  if (!report.feed_mm_per_min) return;
  base::append_fixed(begin_field(out, report.spindle_rpm ? "FS" : "F"), *report.feed_mm_per_min, style.feed_decimals);
  if (!report.spindle_rpm) return;
  out += ',';
  base::append_fixed(out, *report.spindle_rpm, style.rpm_decimals);
  if (!report.measured_rpm) return;
  out += ',';
  base::append_fixed(out, *report.measured_rpm, style.rpm_decimals);
}

void add_extra_spindles(std::string& out, const StatusReport& report, const PrintStyle& style) {
  for (const ExtraSpindle& spindle : report.extra_spindles) {
    begin_field(out, "SP" + std::to_string(spindle.number));
    base::append_fixed(out, spindle.spindle_rpm, style.rpm_decimals);
    out += ",,";
    out += spindle.direction;
    if (spindle.override_percent) out += ',' + std::to_string(*spindle.override_percent);
  }
}

void add_homed(std::string& out, const std::optional<Homed>& homed) {
  if (!homed) return;
  begin_field(out, "H") += homed->homed ? '1' : '0';
  if (homed->axis_mask) out += ',' + std::to_string(*homed->axis_mask);
}

void add_probe(std::string& out, const std::optional<ProbeState>& probe) {
  if (!probe) return;
  begin_field(out, "P") += std::to_string(probe->probe);
  if (probe->is_protected) out += ",P";
}

void add_auto_report(std::string& out, const std::optional<int>& period_ms) {
  if (!period_ms) return;
  out += "|AR";
  if (*period_ms != 0) out += ':' + std::to_string(*period_ms);
}

// A damaged or repeated field has a name that we know. It has to stand behind the sound one, which counts.
bool has_known_name(const UnknownField& field) {
  const auto rows = vocabulary::status_field_rows();
  return std::ranges::find(rows, field.name, &vocabulary::StatusFieldRow::name) != rows.end();
}

void add_unknown(std::string& out, const StatusReport& report, bool known_names) {
  for (const UnknownField& field : report.unknown) {
    if (has_known_name(field) != known_names) continue;
    out += '|';
    out += field.name;
    if (!field.value.empty()) out += ':' + field.value;
  }
}

void add_buffer(std::string& out, const std::optional<BufferState>& buffer) {
  if (!buffer) return;
  begin_field(out, "Bf") += std::to_string(buffer->planner_blocks) + ',' + std::to_string(buffer->rx_bytes);
}

void add_overrides(std::string& out, const std::optional<Overrides>& overrides) {
  if (!overrides) return;
  begin_field(out, "Ov") += std::to_string(overrides->feed_percent) + ',' + std::to_string(overrides->rapid_percent) +
                            ',' + std::to_string(overrides->spindle_percent);
}

// A switch, so that the compiler names a field that was forgotten.
void add_field(std::string& out, StatusField field, const StatusReport& report, const PrintStyle& style) {
  switch (field) {
    case StatusField::MachinePosition: return add_positions(out, "MPos", report.machine_position, style);
    case StatusField::WorkPosition: return add_positions(out, "WPos", report.work_position, style);
    case StatusField::Buffer: return add_buffer(out, report.buffer);
    case StatusField::LineNumber: return add_number(out, "Ln", report.line_number);
    case StatusField::DistanceToGo: return add_positions(out, "DTG", report.distance_to_go, style);
    case StatusField::FeedAndSpeed: return add_speeds(out, report, style);
    case StatusField::Feed: return;  // one member with FeedAndSpeed
    case StatusField::ExtraSpindle: return add_extra_spindles(out, report, style);
    case StatusField::ActiveSpindle: return add_number(out, "S", report.active_spindle);
    case StatusField::Pins: return add_text(out, "Pn", report.pins);
    case StatusField::WorkOffset: return add_positions(out, "WCO", report.work_offset, style);
    case StatusField::WorkCoordinateSystem: return add_text(out, "WCS", report.wcs);
    case StatusField::Overrides: return add_overrides(out, report.overrides);
    case StatusField::Accessories: return add_text(out, "A", report.accessories);
    case StatusField::Scaling: return add_text(out, "Sc", report.scaled_axes);
    case StatusField::AutoReport: return add_auto_report(out, report.auto_report_ms);
    case StatusField::Mpg: return add_flag(out, "MPG", report.mpg);
    case StatusField::Homed: return add_homed(out, report.homed);
    case StatusField::Diameter: return add_flag(out, "D", report.diameter);
    case StatusField::Tool: return add_number(out, "T", report.tool);
    case StatusField::Probe: return add_probe(out, report.probe);
    case StatusField::ToolLengthReference: return add_flag(out, "TLR", report.tlr);
    case StatusField::InputResult: return add_number(out, "In", report.input_result);
    case StatusField::PluginFields: return add_unknown(out, report, false);
    case StatusField::FirmwareName: return add_text(out, "FW", report.firmware);
    case StatusField::CriticalEvent: return add_flag(out, "$C", report.critical);
  }
}

}  // namespace

// <Hold:1|MPos:1.000,0.000,0.000|Bf:14,128|FS:250,12000|Ov:100,100,100|A:SF>
std::string encode_status(const StatusReport& report, const PrintStyle& style) {
  std::string out = "<";
  if (!report.odd_state.empty()) {
    out += report.odd_state;
  } else {
    out += vocabulary::name_of(report.state);
    if (report.substate) out += ':' + std::to_string(*report.substate);
  }
  for (const StatusField field : style.field_order) add_field(out, field, report, style);
  // Fields that this firmware does not have are still told, behind those that it has.
  for (const vocabulary::StatusFieldRow& row : vocabulary::status_field_rows()) {
    if (std::ranges::find(style.field_order, row.field) == style.field_order.end()) {
      add_field(out, row.field, report, style);
    }
  }
  add_unknown(out, report, true);
  out += '>';
  return out;
}

}  // namespace kerf::protocol
