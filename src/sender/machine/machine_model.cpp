#include "sender/machine/machine_model.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/vocabulary/codes.hpp"

namespace kerf::machine {
namespace {

using vocabulary::MachineState;

std::optional<std::vector<double>> combine(const std::optional<std::vector<double>>& a,
                                           const std::optional<std::vector<double>>& b, double sign) {
  if (!a || !b || a->size() != b->size()) return std::nullopt;
  std::vector<double> result = *a;
  for (std::size_t axis = 0; axis < result.size(); ++axis) result[axis] += sign * (*b)[axis];
  return result;
}

bool is_work_coordinate_system(std::string_view word) {
  return word.size() >= 3 && word[0] == 'G' && word[1] == '5' && word[2] >= '4' && word[2] <= '9';
}

}  // namespace

void MachineModel::fold(Instant now, const protocol::Message& message) {
  std::visit(
      base::Overloaded{
          [&](const protocol::StatusReport& report) { fold_report(now, report); },
          [&](const protocol::ParserState& state) { fold_parser_state(state); },
          [&](const protocol::Welcome&) { fold_welcome(); },
          [&](const protocol::AlarmRaised& alarm) { raise_alarm(alarm.code); },
          [&](const protocol::Feedback& feedback) { keep_message(feedback.text); },
          [&](const protocol::SettingValue& setting) { fold_setting(setting.id, setting.value); },
          [&](const protocol::StoredOffset& offset) { snapshot_.offsets_mm[offset.name] = in_mm(offset.values); },
          [&](const protocol::ToolLengthOffset& offset) { snapshot_.tool_length_offset_mm = in_mm(offset.values); },
          [&](const protocol::ProbeResult& probe) {
            snapshot_.probe = ProbeContact{.position_mm = in_mm(probe.values), .touched = probe.success};
          },
          [](const auto&) {},
      },
      message);
}

std::vector<double> MachineModel::in_mm(std::vector<double> values) const {
  for (double& value : values) value *= scale();
  return values;
}

void MachineModel::fold_report(Instant now, const protocol::StatusReport& report) {
  snapshot_.state = report.state;
  snapshot_.substate = report.substate;
  snapshot_.reported_at = now;
  ++snapshot_.reports;
  fold_position(report);
  fold_optional_fields(report);
  fold_alarm_state(report);
  fold_controller_file(report);
  snapshot_.other_fields = report.unknown;
}

// `<Idle|WPos:1.000,0.000,0.000|FS:0,0|WCO:-1.000,0.000,0.000>`
void MachineModel::fold_position(const protocol::StatusReport& report) {
  if (report.work_offset) snapshot_.work_offset_mm = in_mm(*report.work_offset);
  if (report.machine_position) {
    snapshot_.machine_position_mm = in_mm(*report.machine_position);
    snapshot_.work_position_mm = combine(snapshot_.machine_position_mm, snapshot_.work_offset_mm, -1);
  }
  if (report.work_position) {
    snapshot_.work_position_mm = in_mm(*report.work_position);
    if (!report.machine_position) {
      snapshot_.machine_position_mm = combine(snapshot_.work_position_mm, snapshot_.work_offset_mm, 1);
    }
  }
}

void MachineModel::fold_optional_fields(const protocol::StatusReport& report) {
  if (report.buffer) {
    snapshot_.planner_blocks_free = report.buffer->planner_blocks;
    snapshot_.rx_bytes_free = report.buffer->rx_bytes;
  }
  snapshot_.line_number.reset();
  if (report.line_number) snapshot_.line_number = *report.line_number;
  if (report.feed_mm_per_min) snapshot_.feed_mm_per_min = *report.feed_mm_per_min * scale();
  if (report.spindle_rpm) snapshot_.spindle_rpm = report.spindle_rpm;
  if (report.measured_rpm) snapshot_.measured_rpm = report.measured_rpm;
  snapshot_.pins = report.pins.value_or("");
  if (report.overrides) {
    snapshot_.overrides = OverridePercentages{.feed = report.overrides->feed_percent,
                                              .rapid = report.overrides->rapid_percent,
                                              .spindle = report.overrides->spindle_percent};
    // Overrides without `A:` mean that everything is off (gnea/grbl report.c).
    if (!report.accessories) snapshot_.accessories = "";
  }
  if (report.accessories) snapshot_.accessories = report.accessories;
  if (report.wcs) snapshot_.work_coordinate_system = report.wcs;
  if (report.tool) snapshot_.tool = report.tool;
  if (report.mpg) snapshot_.pendant_in_control = *report.mpg;
  if (report.auto_report_ms) snapshot_.auto_report_ms = *report.auto_report_ms;
  if (report.homed) {
    snapshot_.homed = report.homed->homed;
    snapshot_.homed_axes.reset();
    if (report.homed->axis_mask) {
      snapshot_.homed_axes = static_cast<vocabulary::AxisMask>(static_cast<unsigned>(*report.homed->axis_mask) & 0xFFU);
    }
  }
}

void MachineModel::fold_alarm_state(const protocol::StatusReport& report) {
  if (report.state == MachineState::Alarm) {
    if (report.substate) snapshot_.alarm_code = report.substate;
    if (report.critical) snapshot_.reset_required = *report.critical;
    return;
  }
  snapshot_.alarm_code.reset();
  snapshot_.reset_required = report.critical.value_or(false);
}

// `|SD:10.5,part.nc`, `|SD:Pending`; `|SD:1` only tells that a card is there (protocol.md 9.3).
void MachineModel::fold_controller_file(const protocol::StatusReport& report) {
  // Full reports never carry it.
  if (report.firmware) return;
  snapshot_.controller_file.clear();
  for (const auto& field : report.unknown) {
    if (field.name != "SD") continue;
    const auto comma = field.value.find(',');
    if (comma != std::string::npos) snapshot_.controller_file = field.value.substr(comma + 1);
    if (field.value == "Pending") snapshot_.controller_file = field.value;
  }
}

void MachineModel::fold_parser_state(const protocol::ParserState& state) {
  snapshot_.parser_words = state.words;
  for (const std::string& word : state.words) {
    if (is_work_coordinate_system(word)) snapshot_.work_coordinate_system = word;
    if (word.size() > 1 && word[0] == 'T') {
      if (const auto tool = base::parse_int(std::string_view{word}.substr(1))) snapshot_.tool = tool;
    }
  }
}

void MachineModel::fold_welcome() {
  snapshot_.state = MachineState::Unknown;
  snapshot_.substate.reset();
  snapshot_.alarm_code.reset();
  snapshot_.reset_required = false;
  snapshot_.overrides.reset();
  snapshot_.accessories.reset();
  snapshot_.parser_words.clear();
  snapshot_.controller_file.clear();
  snapshot_.pins.clear();
  snapshot_.line_number.reset();
}

void MachineModel::fold_setting(std::string_view id, std::string_view value) {
  if (id != "13") return;
  const bool inches = base::parse_decimal(base::trim(value)).value_or(0) != 0;
  if (inches == snapshot_.reports_inches) return;
  snapshot_.reports_inches = inches;
  // What was converted under the other assumption is not known any more.
  snapshot_.machine_position_mm.reset();
  snapshot_.work_position_mm.reset();
  snapshot_.work_offset_mm.reset();
  snapshot_.offsets_mm.clear();
  snapshot_.tool_length_offset_mm.reset();
  snapshot_.probe.reset();
  snapshot_.feed_mm_per_min.reset();
}

void MachineModel::raise_alarm(int code) {
  snapshot_.state = MachineState::Alarm;
  snapshot_.substate.reset();
  snapshot_.alarm_code = code;
  const auto* row = vocabulary::find_code(dialect_->alarms, code);
  snapshot_.reset_required = row != nullptr && row->critical;
}

void MachineModel::keep_message(std::string_view text) {
  if (base::trim(text).empty()) return;
  snapshot_.messages.emplace_back(text);
  if (snapshot_.messages.size() > kMessagesKept) snapshot_.messages.erase(snapshot_.messages.begin());
}

void MachineModel::on_line_accepted(std::string_view line) {
  const std::string_view text = base::trim(line);
  const auto equals = text.find('=');
  if (!text.starts_with('$') || equals == std::string_view::npos) return;
  fold_setting(base::trim(text.substr(1, equals - 1)), text.substr(equals + 1));
}

}  // namespace kerf::machine
