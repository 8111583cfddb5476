#include "sender/job/path_watch.hpp"

#include <algorithm>
#include <utility>

#include "common/base/text.hpp"
#include "sender/machine/controller_rules.hpp"

namespace kerf::job {
namespace {

using vocabulary::MachineState;

double number(const machine::Capabilities& known, std::string_view id, double otherwise) {
  const auto* const setting = known.find_setting(id);
  if (setting == nullptr || !setting->value) return otherwise;
  return base::parse_decimal(*setting->value).value_or(otherwise);
}

PathRules path_rules_of(const machine::Capabilities& known) {
  return {.motion = motion::rules_of(known.family),
          .settings = machine::motion_settings_of(known),
          .planner_blocks = known.buffers.planner_blocks};
}

/// In the other states it stands still or moves by rules of its own: homing, parking, a tool change, check mode.
bool follows_program(MachineState state) {
  return state == MachineState::Idle || state == MachineState::Run || state == MachineState::Hold;
}

AxisValues axis_values(const std::vector<double>& mm) {
  AxisValues values{};
  for (std::size_t axis = 0; axis < std::min(mm.size(), values.size()); ++axis) {
    values.at(axis) = static_cast<float>(mm[axis]);
  }
  return values;
}

}  // namespace

void PathWatch::begin(Instant now, const std::optional<gcode::Interpreter>& reader, const machine::Snapshot& snapshot,
                      const machine::Capabilities& known, double clock) {
  const PathRules rules = path_rules_of(known);
  forecast_ = {};
  gap_told_ = stands_ = restarted_ = false;
  rested_at_mm_.reset();
  stood_at_mm_.reset();
  const AxisValues start = snapshot.machine_position_mm ? axis_values(*snapshot.machine_position_mm) : AxisValues{};
  if (reader && snapshot.machine_position_mm) {
    forecast_.begin(*reader, start, rules);
  } else {
    forecast_.open(1, "Kerf does not know the modes and offsets that the machine began with");
  }
  constexpr unsigned kMachinePosition = 1;
  tells_work_position_ = (static_cast<unsigned>(number(known, "10", kMachinePosition)) & kMachinePosition) == 0;
  follower_.begin(now, start, rules,
                  {.tolerance_mm = tolerance_mm(rules, number(known, "13", 0) != 0),
                   .clock = clock,
                   .reports_inches = number(known, "13", 0) != 0,
                   .least_rpm = number(known, "31", 0),
                   .most_rpm = number(known, "30", 0)});
}

void PathWatch::on_sent(std::uint32_t file_line, std::string_view text) {
  forecast_.on_sent(file_line, text);
}

void PathWatch::on_answer(std::uint32_t file_line, int error_code) {
  if (error_code != 0) forecast_.open(file_line, "the controller refused it, and it may have acted on lines behind it");
  forecast_.on_acknowledged();
}

std::optional<PathDeparture> PathWatch::on_report(Instant now, std::optional<Instant> asked,
                                                  const machine::Snapshot& snapshot) {
  const bool stands = snapshot.state == MachineState::Hold || snapshot.state == MachineState::Door;
  // By a button, or by Kerf.
  if (!stands && stands_ && !restarted_) follower_.on_restart();
  if (!stands) restarted_ = false;
  stands_ = stands;
  if (!snapshot.machine_position_mm || !follows_program(snapshot.state)) {
    stood_at_mm_.reset();
    follower_.on_interlude();
    return std::nullopt;
  }
  const AxisValues at_mm = axis_values(*snapshot.machine_position_mm);
  const bool stays = stands && std::exchange(stood_at_mm_, at_mm) == at_mm;
  // It still brakes, or the report is a damaged one, which may fit to where the path comes by again.
  if (stands && !stays) return std::nullopt;
  if (!stands) stood_at_mm_.reset();
  PathReport report{.arrived = now,
                    .asked = asked,
                    .machine_mm = at_mm,
                    .axes = snapshot.machine_position_mm->size(),
                    .runs = snapshot.state == MachineState::Run,
                    .feed_mm_per_min = snapshot.feed_mm_per_min,
                    .spindle_rpm = snapshot.spindle_rpm,
                    .line_number = snapshot.line_number};
  if (tells_work_position_ && snapshot.work_position_mm) report.work_mm = axis_values(*snapshot.work_position_mm);
  if (snapshot.overrides) {
    report.feed_override = snapshot.overrides->feed;
    report.spindle_override = snapshot.overrides->spindle;
  }
  return follower_.on_report(forecast_, report);
}

void PathWatch::on_cycle_start() {
  if (!stands_) return;
  restarted_ = true;
  follower_.on_restart();
}

void PathWatch::on_overruled() {
  forecast_.open(forecast_.line_sent(), "the job went on from a place off its path");
}

// One report may still be older than what came before it, or come between two motions.
void PathWatch::look_for_rest(Instant now, const machine::Snapshot& snapshot, bool nothing_on_its_way) {
  const bool rests = snapshot.state == MachineState::Idle && nothing_on_its_way && snapshot.machine_position_mm &&
                     snapshot.work_offset_mm;
  if (snapshot.state == MachineState::Tool) forecast_.on_tool_state();
  if (!rests) {
    rested_at_mm_.reset();
    return;
  }
  const AxisValues at = axis_values(*snapshot.machine_position_mm);
  const bool stays = std::exchange(rested_at_mm_, at) == at;
  if (stays && forecast_.stand(at, axis_values(*snapshot.work_offset_mm))) follower_.stand(now, forecast_);
}

std::optional<PathGap> PathWatch::take_gap() {
  if (!forecast_.is_open() || std::exchange(gap_told_, true)) return std::nullopt;
  const std::uint32_t line = forecast_.open_from_line();
  return PathGap{.file_line = line,
                 .sentence = "From line " + std::to_string(line) +
                             " on Kerf cannot tell whether the machine keeps to " +
                             "the path of the program: " + forecast_.open_reason() + "."};
}

}  // namespace kerf::job
