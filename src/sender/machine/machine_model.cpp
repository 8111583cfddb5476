#include "sender/machine/machine_model.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/codes.hpp"
#include "common/vocabulary/report_mask.hpp"
#include "sender/machine/status_letters.hpp"

namespace kerf::machine {
namespace {

using vocabulary::AlarmCode;
using vocabulary::MachineState;
using vocabulary::ReportBit;

constexpr double kMmPerInch = 25.4;

std::optional<std::vector<double>> combine(const std::optional<std::vector<double>>& a,
                                           const std::optional<std::vector<double>>& b, double sign) {
  if (!a || !b || a->size() != b->size()) return std::nullopt;
  std::vector<double> result = *a;
  for (std::size_t axis = 0; axis < result.size(); ++axis) result[axis] += sign * (*b)[axis];
  return result;
}

/// After these nobody knows where the axes are (protocol.md 9.8).
bool loses_homing(int alarm) {
  constexpr std::array kAlarms{AlarmCode::HardLimit,      AlarmCode::AbortCycle,        AlarmCode::HomingFailReset,
                               AlarmCode::HomingFailDoor, AlarmCode::HomingFailPulloff, AlarmCode::HomingFailApproach};
  return std::ranges::any_of(kAlarms, [alarm](AlarmCode code) { return number_of(code) == alarm; });
}

void scale_by(std::optional<std::vector<double>>& values, double factor) {
  if (!values) return;
  for (double& value : *values) value *= factor;
}

}  // namespace

void MachineModel::fold(Instant now, const protocol::Message& message) {
  std::visit(
      base::Overloaded{
          [&](const protocol::StatusReport& report) { fold_report(now, report); },
          [&](const protocol::ParserState& state) { fold_parser_state(state); },
          [&](const protocol::Welcome&) { fold_welcome(); },
          [&](const protocol::AlarmRaised& alarm) { raise_alarm(alarm.code); },
          [&](const protocol::Feedback& feedback) { fold_message(now, feedback.text); },
          [&](const protocol::NewOptions& options) {
            for (const std::string& flag : options.flags) {
              if (flag == "RT+" || flag == "RT-") snapshot_.texts_keep_realtime = flag == "RT-";
            }
          },
          [&](const protocol::SettingValue& setting) { fold_setting(setting.id, setting.value); },
          [&](const protocol::StoredOffset& offset) { snapshot_.offsets_mm[offset.name] = in_mm(offset.values); },
          [&](const protocol::ToolLengthOffset& offset) { snapshot_.tool_length.offset_mm = in_mm(offset.values); },
          [&](const protocol::ToolLengthReference& reference) {
            snapshot_.tool_length.reference_mm = in_mm(reference.values);
          },
          [&](const protocol::HomePosition& home) { fold_home(home); },
          [&](const protocol::ProbeResult& probe) {
            snapshot_.probe = ProbeContact{.position_mm = in_mm(probe.values), .touched = probe.success};
          },
          [](const auto&) {},
      },
      message);
  tell_without_units();
}

void MachineModel::tell_without_units() {
  if (snapshot_.units_are_known) return;
  told_ = snapshot_;
  told_.machine_position_unitless = std::exchange(told_.machine_position_mm, std::nullopt);
  told_.work_position_unitless = std::exchange(told_.work_position_mm, std::nullopt);
  told_.work_offset_mm.reset();
  told_.distance_to_go_mm.reset();
  told_.feed_mm_per_min.reset();
  told_.tool_length.offset_mm.reset();
  told_.tool_length.reference_mm.reset();
  told_.homing.home_position_mm.reset();
  told_.offsets_mm.clear();
  told_.probe.reset();
  told_.modes.feed_mm_per_min.reset();
}

void MachineModel::forget() {
  snapshot_ = {};
  told_ = {};
  report_mask_.reset();
  prompt_state_ = MachineState::Unknown;
}

std::vector<double> MachineModel::in_mm(std::vector<double> values) const {
  for (double& value : values) value *= scale();
  return values;
}

void MachineModel::fold_report(Instant now, const protocol::StatusReport& report) {
  snapshot_.state = report.state;
  snapshot_.substate = report.substate;
  snapshot_.odd_state = report.odd_state;
  snapshot_.reported_at = now;
  ++snapshot_.reports;
  fold_position(report);
  fold_motion(report);
  fold_spindles(report);
  fold_inputs(report);
  fold_accessories(report);
  fold_modes(report);
  fold_homed(report);
  fold_alarm_state(report);
  fold_card(report);
  snapshot_.other_fields = report.unknown;
  if (report.state != prompt_state_) snapshot_.prompt.clear();
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
  if (!report.work_offset || report.machine_position || report.work_position) return;
  // A new offset moves no axis.
  if (snapshot_.machine_position_mm) {
    snapshot_.work_position_mm = combine(snapshot_.machine_position_mm, snapshot_.work_offset_mm, -1);
  } else {
    snapshot_.machine_position_mm = combine(snapshot_.work_position_mm, snapshot_.work_offset_mm, 1);
  }
}

void MachineModel::fold_motion(const protocol::StatusReport& report) {
  if (report.buffer) {
    snapshot_.planner_blocks_free = report.buffer->planner_blocks;
    snapshot_.rx_bytes_free = report.buffer->rx_bytes;
  }
  snapshot_.line_number.reset();
  if (report.line_number) snapshot_.line_number = *report.line_number;
  snapshot_.distance_to_go_mm.reset();
  if (report.distance_to_go) snapshot_.distance_to_go_mm = in_mm(*report.distance_to_go);
  if (report.feed_mm_per_min) snapshot_.feed_mm_per_min = *report.feed_mm_per_min * scale();
}

// `FS:500,8000,7950`, `SP1:1000,,S,100`
void MachineModel::fold_spindles(const protocol::StatusReport& report) {
  if (report.spindle_rpm) snapshot_.spindle_rpm = report.spindle_rpm;
  if (report.measured_rpm) snapshot_.measured_rpm = report.measured_rpm;
  if (report.active_spindle) snapshot_.active_spindle = report.active_spindle;
  snapshot_.further_spindles.clear();
  for (const auto& spindle : report.extra_spindles) {
    snapshot_.further_spindles.push_back({.number = spindle.number,
                                          .rpm = spindle.spindle_rpm,
                                          .turns = accessories_of(spindle.direction).spindle,
                                          .override_percent = spindle.override_percent});
  }
}

void MachineModel::fold_inputs(const protocol::StatusReport& report) {
  snapshot_.pins = report.pins.value_or("");
  // Grbl takes any byte for `$10`, but knows two bits of it only; grblHAL has this one, and has it on (protocol.md).
  const bool may_be_off = vocabulary::has(dialect_->report_mask_default, ReportBit::PinState);
  const bool are_off = may_be_off && report_mask_ && !vocabulary::has(*report_mask_, ReportBit::PinState);
  snapshot_.inputs.reset();
  if (report.pins || !are_off) snapshot_.inputs = inputs_of(snapshot_.pins);
}

void MachineModel::fold_accessories(const protocol::StatusReport& report) {
  if (report.overrides) {
    snapshot_.overrides = OverridePercentages{.feed = report.overrides->feed_percent,
                                              .rapid = report.overrides->rapid_percent,
                                              .spindle = report.overrides->spindle_percent};
    // Overrides without `A:` mean that everything is off (gnea/grbl report.c).
    if (!report.accessories) snapshot_.accessories = Accessories{};
  }
  if (report.accessories) snapshot_.accessories = accessories_of(*report.accessories);
}

void MachineModel::fold_modes(const protocol::StatusReport& report) {
  if (report.wcs) {
    // Changed without a line of ours: a file, a macro or a pendant has done more than that.
    const bool is_news = !snapshot_.modes.work_coordinates.empty() && snapshot_.modes.work_coordinates != *report.wcs;
    snapshot_.parser_state_is_old = snapshot_.parser_state_is_old || is_news;
    snapshot_.work_coordinate_system = report.wcs;
  }
  if (report.tool) snapshot_.tool = report.tool;
  if (report.tlr) snapshot_.tool_length.reference_set = report.tlr;
  if (report.tlr == false) snapshot_.tool_length.reference_mm.reset();
  if (report.scaled_axes) snapshot_.scaled_axes = *report.scaled_axes;
  if (report.diameter) snapshot_.diameter_mode = report.diameter;
  if (report.input_result) snapshot_.input_result = report.input_result;
  if (report.probe) {
    snapshot_.probe_in_use = ProbeInUse{.number = report.probe->probe, .is_protected = report.probe->is_protected};
  }
  if (report.mpg) snapshot_.pendant_in_control = *report.mpg;
  if (report.auto_report_ms) snapshot_.auto_report_ms = report.auto_report_ms;
}

// `H:1` or `H:1,7`
void MachineModel::fold_homed(const protocol::StatusReport& report) {
  if (!report.homed) return;
  snapshot_.homing.all = report.homed->homed;
  snapshot_.homing.is_told = true;
  snapshot_.homing.axes.reset();
  if (report.homed->axis_mask) snapshot_.homing.axes = letters_of(static_cast<unsigned>(*report.homed->axis_mask));
}

void MachineModel::fold_home(const protocol::HomePosition& home) {
  snapshot_.homing.home_position_mm = in_mm(home.values);
  snapshot_.homing.axes = letters_of(static_cast<unsigned>(home.axis_mask));
  snapshot_.homing.is_told = true;
}

std::string MachineModel::letters_of(unsigned axis_mask) const {
  std::string letters;
  for (std::size_t axis = 0; axis < vocabulary::kMaxAxes; ++axis) {
    if (((axis_mask >> axis) & 1U) != 0) letters += vocabulary::kAxisLetters[axis];
  }
  return letters;
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
void MachineModel::fold_card(const protocol::StatusReport& report) {
  // Full reports never carry the progress, and tell the card alone.
  const auto is_card = [](const protocol::UnknownField& field) { return field.name == "SD"; };
  const auto field = std::ranges::find_if(report.unknown, is_card);
  if (field != report.unknown.end()) {
    if (const auto bits = base::parse_int<unsigned>(field->value)) {
      snapshot_.card.mounted = (*bits & 1U) != 0;
      snapshot_.card.detected = (*bits & 2U) != 0;
    }
  }
  if (report.firmware) return;
  const bool had_file = !snapshot_.controller_file.empty();
  snapshot_.controller_file.clear();
  snapshot_.card.file_percent.reset();
  snapshot_.card.file_waits = false;
  const std::string_view value = field == report.unknown.end() ? std::string_view{} : field->value;
  const auto comma = value.find(',');
  if (comma != std::string_view::npos) {
    snapshot_.controller_file = value.substr(comma + 1);
    snapshot_.card.file_percent = base::parse_decimal(value.substr(0, comma));
  }
  if (value == "Pending") {
    snapshot_.controller_file = value;
    snapshot_.card.file_waits = true;
  }
  if (had_file && snapshot_.controller_file.empty()) on_strange_hands();
}

void MachineModel::fold_parser_state(const protocol::ParserState& state) {
  snapshot_.parser_words = state.words;
  snapshot_.modes = modes_of(state.words, scale());
  snapshot_.parser_state_is_old = false;
  if (!snapshot_.modes.work_coordinates.empty()) {
    snapshot_.work_coordinate_system = snapshot_.modes.work_coordinates;
  }
  for (const std::string& word : state.words) {
    if (word.size() < 2 || word[0] != 'T') continue;
    if (const auto tool = base::parse_int(std::string_view{word}.substr(1))) snapshot_.tool = tool;
  }
}

// What a reset clears on some firmware is not known until it is told again (protocol.md 1.2).
void MachineModel::fold_welcome() {
  snapshot_.state = MachineState::Unknown;
  snapshot_.substate.reset();
  snapshot_.odd_state.clear();
  snapshot_.work_offset_mm.reset();
  snapshot_.work_position_mm.reset();
  snapshot_.distance_to_go_mm.reset();
  snapshot_.line_number.reset();
  snapshot_.feed_mm_per_min.reset();
  snapshot_.spindle_rpm.reset();
  snapshot_.measured_rpm.reset();
  snapshot_.pins.clear();
  snapshot_.inputs.reset();
  snapshot_.overrides.reset();
  snapshot_.accessories.reset();
  snapshot_.scaled_axes.clear();
  snapshot_.work_coordinate_system.reset();
  if (!dialect_->keeps_tool_over_reset) snapshot_.tool.reset();
  if (!dialect_->keeps_g92_over_reset) snapshot_.offsets_mm.erase("G92");
  snapshot_.tool_length.offset_mm.reset();
  snapshot_.probe.reset();
  snapshot_.controller_file.clear();
  snapshot_.card.file_percent.reset();
  snapshot_.card.file_waits = false;
  snapshot_.parser_words.clear();
  snapshot_.modes = {};
  snapshot_.parser_state_is_old = true;
  snapshot_.offsets_are_old = true;
  snapshot_.alarm_code.reset();
  snapshot_.reset_required = false;
  snapshot_.prompt.clear();
}

void MachineModel::fold_setting(std::string_view id, std::string_view value) {
  if (const auto mask = base::parse_int<std::uint32_t>(base::trim(value)); id == "10" && mask) report_mask_ = mask;
  const auto number = base::parse_decimal(base::trim(value));
  if (!number) return;
  // Rabbit's names: `$Report/Inches=1` is `$13=1`.
  const auto match = vocabulary::find_setting(dialect_->settings, id);
  const std::string known =
      match && match->row->id >= 0 ? std::to_string(match->row->id + match->axis) : std::string{id};
  if (known == "13") set_inches(*number != 0);
  if (known == "39") snapshot_.texts_keep_realtime = *number == 0;
}

void MachineModel::set_inches(bool inches) {
  const bool was_guessed = !snapshot_.units_are_known;
  snapshot_.units_are_known = true;
  if (inches == snapshot_.reports_inches) return;
  snapshot_.reports_inches = inches;
  // Numbers that were told while `$13` was not known were inches already.
  if (was_guessed) {
    for (auto* values : {&snapshot_.machine_position_mm, &snapshot_.work_position_mm, &snapshot_.work_offset_mm,
                         &snapshot_.distance_to_go_mm, &snapshot_.tool_length.offset_mm,
                         &snapshot_.tool_length.reference_mm, &snapshot_.homing.home_position_mm}) {
      scale_by(*values, kMmPerInch);
    }
    for (auto& [name, values] : snapshot_.offsets_mm) values = in_mm(std::move(values));
    if (snapshot_.probe) snapshot_.probe->position_mm = in_mm(std::move(snapshot_.probe->position_mm));
    if (snapshot_.feed_mm_per_min) *snapshot_.feed_mm_per_min *= kMmPerInch;
    if (snapshot_.modes.feed_mm_per_min) *snapshot_.modes.feed_mm_per_min *= kMmPerInch;
    return;
  }
  // A report may have been on its way when the units changed: what it said is not known any more. Stored values are
  // the same as before.
  snapshot_.machine_position_mm.reset();
  snapshot_.work_position_mm.reset();
  snapshot_.work_offset_mm.reset();
  snapshot_.distance_to_go_mm.reset();
  snapshot_.feed_mm_per_min.reset();
}

void MachineModel::raise_alarm(int code) {
  snapshot_.state = MachineState::Alarm;
  snapshot_.substate.reset();
  snapshot_.alarm_code = code;
  const auto* row = vocabulary::find_code(dialect_->alarms, code);
  snapshot_.reset_required = row != nullptr && row->critical;
  if (loses_homing(code)) forget_homing();
}

void MachineModel::note_homed(std::string_view axes) {
  if (snapshot_.homing.is_told) return;
  if (axes.empty()) {
    const std::size_t count = snapshot_.machine_position_mm ? snapshot_.machine_position_mm->size() : 0;
    snapshot_.homing.all = true;
    snapshot_.homing.axes = letters_of((1U << count) - 1U);
    return;
  }
  std::string known = snapshot_.homing.axes.value_or("");
  for (const char axis : axes) {
    if (!known.contains(base::to_upper(axis))) known += base::to_upper(axis);
  }
  snapshot_.homing.axes = known;
}

void MachineModel::forget_homing() {
  if (snapshot_.homing.is_told) return;
  snapshot_.homing.all = false;
  snapshot_.homing.axes = "";
}

void MachineModel::on_power_doubt() {
  if (snapshot_.homing.is_told) return;
  snapshot_.homing.all.reset();
  snapshot_.homing.axes.reset();
  tell_without_units();
}

void MachineModel::on_strange_hands() {
  snapshot_.parser_state_is_old = true;
  snapshot_.offsets_are_old = true;
  tell_without_units();
}

void MachineModel::fold_message(Instant now, std::string_view text) {
  if (base::trim(text).empty()) return;
  const auto id = vocabulary::feedback_of(text);
  snapshot_.messages.push_back({.kind = vocabulary::feedback_kind(text),
                                .id = id,
                                .text = std::string{vocabulary::without_kind(text)},
                                .at = now});
  if (snapshot_.messages.size() > kMessagesKept) snapshot_.messages.erase(snapshot_.messages.begin());
  const MachineState state = id ? waits_in(*id) : MachineState::Unknown;
  if (state == MachineState::Unknown) return;
  prompt_state_ = state;
  snapshot_.prompt = snapshot_.messages.back().text;
}

void MachineModel::on_line_accepted(std::string_view line) {
  const std::string_view text = base::trim(line);
  const LineEffect effect = effect_of(text);
  snapshot_.parser_state_is_old = snapshot_.parser_state_is_old || effect.parser_state;
  snapshot_.offsets_are_old = snapshot_.offsets_are_old || effect.offsets;
  if (!text.starts_with('$')) return;
  if (text == "$#") snapshot_.offsets_are_old = false;
  const auto equals = text.find('=');
  if (equals != std::string_view::npos) {
    fold_setting(base::trim(text.substr(1, equals - 1)), text.substr(equals + 1));
  } else if (base::starts_with_ignoring_case(text, "$H") && !base::starts_with_ignoring_case(text, "$HE")) {
    note_homed(base::trim(text.substr(2)));
  }
  tell_without_units();
}

}  // namespace kerf::machine
