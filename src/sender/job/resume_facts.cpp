#include "sender/job/resume_facts.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "sender/job/program_state.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/controller_rules.hpp"

namespace kerf::job {
namespace {

/// A shorter motion may be less than a step, and then it is no block.
constexpr float kSurelyABlockMm = 0.1F;
/// Blocks that a controller holds without saying how many.
constexpr int kBlocksUntold = 128;
/// Blocks that left the planner already and wait as prepared segments (gnea/grbl stepper.c has six).
constexpr std::size_t kInSegments = 8;

std::string because_of(ExecutingKnownBy known_by) {
  switch (known_by) {
    case ExecutingKnownBy::LineNumber: return "the controller reported the line number itself (Ln:)";
    case ExecutingKnownBy::Position: return "the last reported position lies on their path";
    case ExecutingKnownBy::Silence: return "the link was silent there, and what was sent then may have got lost";
    case ExecutingKnownBy::PlannerBlocks:
      return "that is what the planner can hold behind the line that was acknowledged last";
    case ExecutingKnownBy::Nothing: break;
  }
  return "nothing is known of the lines before";
}

std::string doubt_of(const JobHistory& job) {
  if (!job.closed) return "Kerf, its computer or the power ended in the middle of the job";
  if (job.closed->state.position_suspect) return "the job ended in motion: " + job.closed->state.reason;
  const auto is_lost = [](const TimedNote& note) {
    return note.note.kind == NoteKind::ControllerStarted || note.note.kind == NoteKind::LinkLost ||
           note.note.kind == NoteKind::OffThePath;
  };
  const auto found = std::ranges::find_if(job.notes, is_lost);
  return found == job.notes.end() ? std::string{} : found->note.text;
}

}  // namespace

ExecutingLines executing_by_planner(const Program& file, const ProgramStart& start, std::uint32_t acknowledged,
                                    std::uint32_t sent, int planner_blocks) {
  const auto most = static_cast<std::size_t>(planner_blocks > 0 ? planner_blocks : kBlocksUntold) + kInSegments;
  const ExecutingLines nothing{.from = 1, .to = std::max(sent, 1U), .known_by = ExecutingKnownBy::PlannerBlocks};
  auto reader = interpreter_at(start);
  if (!reader) return nothing;
  ProgramState state(*std::move(reader), *start.dialect);
  const WireForm form = wire_form_of(*start.dialect);
  // Lines that may still wait for their motion, oldest first.
  std::deque<std::uint32_t> waiting;
  std::uint32_t done = 0;
  std::string text;
  for (auto line = file.line_at(0, 1); line && line->number <= acknowledged;
       line = file.line_at(file.offset_after(*line), line->number + 1)) {
    text.clear();
    append_wire_form(text, line->text, form);
    state.execute(line->number, text);
    // The line that was answered last may owe its answer to the reset or alarm that cut its wait short.
    if (state.was_waiting() && line->number < acknowledged) {
      waiting.clear();
      done = state.moved_mm() > 0 ? line->number - 1 : line->number;
    }
    if (state.moved_mm() < kSurelyABlockMm) continue;
    waiting.push_back(line->number);
    if (waiting.size() <= most) continue;
    done = waiting.front();
    waiting.pop_front();
  }
  return {
      .from = done + 1, .to = std::max({sent, acknowledged, done + 1}), .known_by = ExecutingKnownBy::PlannerBlocks};
}

ResumeFacts facts_of_present(const machine::Snapshot& now, const machine::Capabilities& capabilities) {
  const MachineAtStart present = present_machine(now, capabilities);
  return {.start = present, .present = present, .capabilities = capabilities};
}

ResumeFacts facts_of_job(const JobHistory& job, const MachineAtStart& file_start, const Program& file,
                         const machine::Snapshot& now, const machine::Capabilities& capabilities) {
  ResumeFacts facts = facts_of_present(now, capabilities);
  facts.start = file_start;
  const JobOrigin& origin = job.begun.origin;
  facts.file_hash = origin.file_hash.empty() ? job.begun.hash : origin.file_hash;
  facts.position_doubt = doubt_of(job);
  const JobAdvanced* const last = job.latest();
  if (last == nullptr) {
    facts.executing = {.from = origin.first_line, .to = origin.first_line, .known_by = ExecutingKnownBy::PlannerBlocks};
    facts.executing_because = "no line was acknowledged";
    return facts;
  }
  if (last->executing.known_by != ExecutingKnownBy::Nothing) {
    facts.executing = {.from = file_line_of(origin, last->executing.from),
                       .to = file_line_of(origin, last->executing.to),
                       .known_by = last->executing.known_by};
  } else if (const auto start = program_start_of(file_start, machine::interpreter_settings_of(capabilities))) {
    const bool has_begun = last->line_acknowledged > origin.preamble_lines;
    const std::uint32_t acknowledged =
        has_begun ? file_line_of(origin, last->line_acknowledged) : origin.first_line - 1;
    facts.executing = executing_by_planner(file, *start, acknowledged, file_line_of(origin, last->line_sent),
                                           file_start.planner_blocks);
    facts.executing.from = std::max(facts.executing.from, origin.first_line);
  }
  facts.executing_because = because_of(facts.executing.known_by);
  if (job.outcome() == JobOutcome::Complete) facts.executing.from = file.line_count() + 1;
  if (last->overrides && *last->overrides != machine::OverridePercentages{}) {
    facts.remarks.push_back("Overrides were at " + std::to_string(last->overrides->feed) + " % feed, " +
                            std::to_string(last->overrides->rapid) + " % rapid and " +
                            std::to_string(last->overrides->spindle) + " % spindle; they are not put back.");
  }
  return facts;
}

}  // namespace kerf::job
