#include "simulation/resume_rehearsal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/text.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/job/resume_steps.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "simulation/machine_like.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::simulation {
namespace {

using vocabulary::kAxisLetters;

constexpr std::size_t kZ = 2;
constexpr int kStepsPerMm = 100;
/// Some 50,000 lines, which take less than a second; twenty times that on a small computer.
constexpr std::size_t kMostBytes = 1'000'000;
/// One step and the rounding of the report from which it starts.
constexpr double kToleranceMm = 0.02;

/// A line as the virtual machine gets it, and where it comes from.
struct Script {
  std::string text;
  /// Of the file; 0 for lines of the plan and before.
  std::vector<std::uint32_t> file_lines;
  std::vector<bool> is_rapid_of_plan;
  std::size_t setup_lines = 0;
  std::uint32_t last_line = 0;
  bool is_whole = true;

  void add(std::string_view line, std::uint32_t file_line, bool is_rapid = false) {
    (text += line) += '\n';
    file_lines.push_back(file_line);
    is_rapid_of_plan.push_back(is_rapid);
  }
};

std::string words_for(const std::vector<double>& values) {
  std::string words;
  for (std::size_t axis = 0; axis < std::min(values.size(), kAxisLetters.size()); ++axis) {
    (words += kAxisLetters[axis]) += job::number_text(static_cast<float>(values[axis]));
  }
  return words;
}

/// It stands in G54, so G92 names the place where the machine is, less G54, the tool length and the shift.
void add_g92(Script& script, const machine::Snapshot& now) {
  const auto shift = now.offsets_mm.find("G92");
  const auto zero = now.offsets_mm.find("G54");
  const bool has_shift = shift != now.offsets_mm.end() && zero != now.offsets_mm.end() && now.machine_position_mm &&
                         std::ranges::any_of(shift->second, [](double mm) { return mm != 0; });
  if (!has_shift) return;
  std::vector<double> place = *now.machine_position_mm;
  const std::vector<double> length = now.tool_length.offset_mm.value_or(std::vector<double>{});
  for (std::size_t axis = 0; axis < place.size(); ++axis) {
    const auto of = [axis](const std::vector<double>& values) { return axis < values.size() ? values[axis] : 0.0; };
    place[axis] -= of(zero->second) + of(shift->second);
    if (length.size() > 1) place[axis] -= of(length);
    if (length.size() == 1 && axis == kZ) place[axis] -= length.front();
  }
  script.add("G92" + words_for(place), 0);
}

/// Brings the virtual machine to where the real one stands.
void add_setup(Script& script, const machine::Snapshot& now) {
  script.add("G21G90G94", 0);
  if (now.machine_position_mm) script.add("G53G0" + words_for(*now.machine_position_mm), 0);
  if (now.tool_length.offset_mm && !now.tool_length.offset_mm->empty()) {
    const auto& length = *now.tool_length.offset_mm;
    const double z = length.size() > kZ ? length[kZ] : length.front();
    if (z != 0) script.add("G43.1Z" + job::number_text(static_cast<float>(z)), 0);
  }
  add_g92(script, now);
  script.setup_lines = script.file_lines.size();
}

void add_rest(Script& script, const job::Program& file, const job::ResumePlan& plan, job::WireForm form) {
  std::string text;
  for (auto line = file.line(plan.from_line); line; line = file.line_at(file.offset_after(*line), line->number + 1)) {
    text.clear();
    const bool is_rewritten = plan.rewritten && plan.rewritten->line == line->number;
    if (is_rewritten) {
      text = plan.rewritten->text;
    } else {
      job::append_wire_form(text, line->text, form);
    }
    if (text.starts_with('$') || script.text.size() > kMostBytes) {
      script.is_whole = false;
      return;
    }
    script.last_line = line->number;
    if (!text.empty()) script.add(text, line->number);
  }
}

class Judge {
 public:
  Judge(const Script& script, const job::ResumePlan& plan, const MotionTrace& trace,
        const machine::Capabilities& capabilities)
      : script_(script), plan_(plan), trace_(trace), capabilities_(capabilities) {}

  std::optional<job::ResumeRefusal> refusal() const {
    if (!trace_.errors.empty()) {
      const RefusedLine& refused = trace_.errors.front();
      return say(refused.line, "is refused (error:" + std::to_string(refused.code) + ")");
    }
    if (!trace_.alarms.empty()) {
      return say(trace_.lines_answered + 1, "raises ALARM:" + std::to_string(trace_.alarms.front()));
    }
    std::vector<double> from(axes(), 0.0);
    for (const BlockTrace& block : trace_.blocks) {
      const std::vector<double> to = place_of(block);
      if (block.line > script_.setup_lines) {
        if (auto found = check_block(block.line, from, to)) return found;
      }
      from = to;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::size_t axes() const { return std::min(plan_.resume_position_mm.size(), vocabulary::kMaxAxes); }

  [[nodiscard]] std::optional<job::ResumeRefusal> say(std::uint32_t script_line, const std::string& what) const {
    const std::size_t at = std::clamp<std::size_t>(script_line, 1, script_.file_lines.size()) - 1;
    const std::uint32_t line = script_.file_lines[at];
    const std::string where = line > 0 ? "line " + std::to_string(line) : std::string{"a line of the plan"};
    return job::ResumeRefusal{.problem = job::ResumeProblem::RehearsalFailed,
                              .line = line,
                              .sentence = "Rehearsed on the virtual machine, " + where + " " + what + ".",
                              .next = "Choose another line (--from-line), or mend the program."};
  }

  [[nodiscard]] std::vector<double> place_of(const BlockTrace& block) const {
    std::vector<double> place;
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      const auto per_mm = machine::setting_number(capabilities_, kStepsPerMm + static_cast<int>(axis));
      place.push_back(block.end_steps.at(axis) / per_mm.value_or(1));
    }
    return place;
  }

  [[nodiscard]] std::optional<job::ResumeRefusal> check_block(std::uint32_t line, const std::vector<double>& from,
                                                              const std::vector<double>& to) const {
    const auto& dialect = vocabulary::dialect_of(capabilities_.family);
    for (std::size_t axis = 0; plan_.is_homed && axis < to.size(); ++axis) {
      const auto travel = machine::travel_of_axis(axis, capabilities_, dialect);
      if (!travel) continue;
      const bool is_inside = to[axis] >= static_cast<double>(travel->min_mm) - kToleranceMm &&
                             to[axis] <= static_cast<double>(travel->max_mm) + kToleranceMm;
      if (!is_inside) {
        return say(line, "goes to " + std::string{kAxisLetters[axis]} + base::to_fixed(to[axis], 3) +
                             ", outside of the travel");
      }
    }
    const std::size_t at = line - 1;
    if (at >= script_.is_rapid_of_plan.size() || !script_.is_rapid_of_plan[at] || to.size() <= kZ) return std::nullopt;
    bool is_sideways = false;
    for (std::size_t axis = 0; axis < to.size(); ++axis) {
      is_sideways = is_sideways || (axis != kZ && std::abs(to[axis] - from[axis]) > kToleranceMm);
    }
    const bool is_free = !is_sideways && to[kZ] >= from[kZ];
    const double highest = plan_.highest_cut_mm.value_or(plan_.safe_height_mm);
    if (!is_free && std::min(from[kZ], to[kZ]) < highest - kToleranceMm) {
      return say(line, "is a rapid below what was cut so far");
    }
    return std::nullopt;
  }

  const Script& script_;
  const job::ResumePlan& plan_;
  const MotionTrace& trace_;
  const machine::Capabilities& capabilities_;
};

}  // namespace

std::expected<ResumeRehearsal, job::ResumeRefusal> rehearse_resume(const job::Program& file,
                                                                   const job::ResumePlan& plan,
                                                                   const machine::Snapshot& now,
                                                                   const machine::Capabilities& capabilities) {
  if (plan.steps.empty()) {
    return ResumeRehearsal{.sentence = "There is nothing to rehearse: the program runs from its beginning."};
  }
  Script script;
  add_setup(script, now);
  for (const std::string& line : plan.preamble()) script.add(line, 0, line.starts_with("G53G0"));
  add_rest(script, file, plan, job::wire_form_of(vocabulary::dialect_of(capabilities.family)));

  CaseMachine machine = machine_like(capabilities);
  for (const auto& [name, values] : now.offsets_mm) {
    if (name != "G92") machine.stored.offsets[name] = values;
  }
  const MotionTrace trace = trace_program({.program = script.text}, machine);
  if (auto refusal = Judge(script, plan, trace, capabilities).refusal()) return std::unexpected{*std::move(refusal)};

  ResumeRehearsal rehearsal{.last_line = script.last_line,
                            .is_whole = script.is_whole && trace.lines_answered == trace.lines,
                            .blocks = static_cast<std::uint32_t>(trace.block_count),
                            .duration_s = trace.total_s};
  if (trace.lines_answered < trace.lines && !script.file_lines.empty()) {
    rehearsal.last_line = script.file_lines[std::min<std::size_t>(trace.lines_answered, script.file_lines.size() - 1)];
  }
  rehearsal.sentence = rehearsal.is_whole
                           ? "Rehearsed to the end on a virtual machine with these settings: nothing wrong."
                           : "Rehearsed up to line " + std::to_string(rehearsal.last_line) +
                                 " on a virtual machine with these settings: nothing wrong.";
  return rehearsal;
}

}  // namespace kerf::simulation
