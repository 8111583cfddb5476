#include "sender/job/stall_diagnosis.hpp"

#include <chrono>
#include <string_view>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using vocabulary::MachineState;

/// Answers that come sooner are no matter.
constexpr double kPatience_s = 2;
/// Reports in a row that say Idle: one may be older than the line that it is about.
constexpr int kIdleReports = 4;
constexpr Duration kProofTimeout = std::chrono::seconds{3};

std::string lines_text(const StallFacts& facts) {
  if (facts.first_owed_line == 0) return "a line of Kerf's own";
  if (facts.first_owed_line == facts.last_owed_line) return "line " + std::to_string(facts.first_owed_line);
  return "lines " + std::to_string(facts.first_owed_line) + " to " + std::to_string(facts.last_owed_line);
}

std::vector<std::string> evidence_of(const StallFacts& facts) {
  std::vector<std::string> evidence;
  evidence.push_back(std::to_string(facts.owed_lines) + (facts.owed_lines == 1 ? " answer has" : " answers have") +
                     " been missing for " + base::to_fixed(facts.unanswered_s, 1) + " s, to " + lines_text(facts) +
                     ".");
  if (!facts.link_is_dead) {
    evidence.push_back("The machine reports " + std::string(vocabulary::name_of(facts.state)) + ".");
  }
  if (facts.planner_free && facts.rx_free) {
    evidence.push_back("Bf: " + std::to_string(*facts.planner_free) + " of " + std::to_string(facts.planner_blocks) +
                       " planner blocks and " + std::to_string(*facts.rx_free) + " of " +
                       std::to_string(facts.rx_bytes) + " bytes of the receive buffer are free.");
  }
  return evidence;
}

Stall stall_of(const StallFacts& facts, StallCause cause, std::string headline, std::vector<std::string> steps) {
  return {.cause = cause,
          .file_line = facts.first_owed_line,
          .since_s = facts.unanswered_s,
          .headline = std::move(headline),
          .evidence = evidence_of(facts),
          .steps = std::move(steps)};
}

constexpr std::string_view kStopStep = "Stop the job: the position is kept, and 'kerf resume' plans the way back in.";

std::optional<Stall> by_state(const StallFacts& facts) {
  switch (facts.state) {
    case MachineState::Door:
      return stall_of(facts, StallCause::Door, "The safety door holds the machine.",
                      {"Close the door, then continue."});
    case MachineState::Tool:
      return stall_of(facts, StallCause::ToolChange, "The controller waits for a tool change.",
                      {"Change the tool, then continue."});
    case MachineState::Hold:
      if (facts.single_block) {
        return stall_of(facts, StallCause::SingleBlock, "Single block is on: the machine stops behind every line.",
                        {"Continue for one line, or switch single block off."});
      }
      if (facts.waits_for_operator) {
        return stall_of(facts, StallCause::WaitingForOperator, "The job waits for the operator.",
                        {"Continue, or stop."});
      }
      return stall_of(facts, StallCause::Hold, "The machine is held.", {"Find out who held it, then continue."});
    default: return std::nullopt;
  }
}

// grblHAL counts one byte too few behind a 0x85 (protocol.md 6.5); a lone byte is no line.
bool has_unread_lines(const StallFacts& facts) {
  return facts.rx_free && *facts.rx_free + 1 < facts.rx_bytes;
}

Stall by_silence(const StallFacts& facts) {
  const std::string count = std::to_string(facts.owed_lines);
  Stall stall = stall_of(facts, StallCause::LostLine,
                         "Lines from " + std::to_string(facts.silent_from_line) +
                             " on may not have arrived: the link was silent, and " + count +
                             (facts.owed_lines == 1 ? " answer is missing." : " answers are missing."),
                         {std::string(kStopStep), "Check cable and network: the link was interrupted."});
  stall.file_line = facts.silent_from_line;
  stall.evidence = {"The controller answers a question behind them, so it has read all that arrived.",
                    "Answers do not say which line they are for: which one got lost is not known."};
  return stall;
}

Stall by_proof(const StallFacts& facts) {
  if (facts.proof == StallProof::LineEndMissing) {
    auto stall = stall_of(facts, StallCause::LostLineEnd,
                          "The end of " + lines_text(facts) + " got lost on the way: it was not executed as sent.",
                          {std::string(kStopStep), "Check the cable and its shield: bytes get lost."});
    stall.evidence.push_back("A harmless question behind it was taken for a part of it and refused.");
    return stall;
  }
  if (facts.proof == StallProof::LinesRead && facts.executed_lines) {
    const bool all = *facts.executed_lines == facts.owed_lines;
    auto stall =
        all ? stall_of(facts, StallCause::LostAnswer,
                       "An ok got lost on the way: " + lines_text(facts) + " was executed, its answer never arrived.",
                       {"Continue behind line " + std::to_string(facts.last_owed_line) + ": nothing is sent twice."})
            : stall_of(facts, StallCause::LostLine,
                       "Line " + std::to_string(facts.first_not_executed) + " never arrived at the controller.",
                       {"Continue from line " + std::to_string(facts.first_not_executed) +
                        ": neither it nor what follows it was executed."});
    stall.goes_on_at = all ? facts.last_owed_line + 1 : facts.first_not_executed;
    stall.steps.push_back("Check the cable and its shield: bytes get lost.");
    stall.evidence.push_back("The controller answers a question behind them, so it has read all that arrived.");
    stall.evidence.push_back(all ? "The machine stands where the last of them leads."
                                 : "The machine stands where the line before it leads.");
    return stall;
  }
  auto stall = stall_of(facts, StallCause::Unexplained,
                        "Answers to " + lines_text(facts) + " are missing, and nothing proves what became of it.",
                        {std::string(kStopStep)});
  if (facts.proof == StallProof::LinesRead) {
    stall.evidence.push_back("The controller answers a question behind them; its position fits no single line.");
  }
  return stall;
}

}  // namespace

std::optional<Stall> diagnose(const StallFacts& facts) {
  if (facts.link_is_dead) {
    return stall_of(facts, StallCause::DeadLink, "Nothing comes from the controller any more.",
                    {"Look at the machine: it cuts on what it has already got.",
                     "Check cable and power. If it answers again, the job goes on by itself; else stop it."});
  }
  if (facts.owed_lines == 0) return std::nullopt;
  if (facts.silent_from_line != 0 && facts.proof == StallProof::LinesRead) return by_silence(facts);
  if (facts.unanswered_s < kPatience_s) return std::nullopt;
  if (auto stall = by_state(facts)) return stall;
  if (facts.state == MachineState::Run && facts.planner_free == 0) {
    return stall_of(facts, StallCause::PlannerFull, "The planner is full: a long move is under way.", {"Wait."});
  }
  if (facts.state != MachineState::Idle && facts.state != MachineState::Check) return std::nullopt;
  if (facts.proof == StallProof::LinesRead || facts.proof == StallProof::LineEndMissing) return by_proof(facts);
  if (facts.dwell_s < 0 || facts.unanswered_s < facts.dwell_s + kPatience_s) {
    return facts.dwell_s == 0 ? std::nullopt
                              : std::optional{stall_of(facts, StallCause::Dwell, "The program dwells.", {"Wait."})};
  }
  if (has_unread_lines(facts) || facts.proof == StallProof::NoAnswer) {
    return stall_of(facts, StallCause::NotReading,
                    "The controller does not read its lines: it may wait for a spindle, an input or its memory.",
                    {"Wait.", std::string(kStopStep)});
  }
  return std::nullopt;
}

bool calls_for_proof(const StallFacts& facts) {
  const bool is_idle = facts.state == MachineState::Idle || facts.state == MachineState::Check;
  const bool has_blocks = facts.planner_free && *facts.planner_free + 1 < facts.planner_blocks;
  return is_idle && facts.owed_lines > 0 && facts.proof == StallProof::NotAsked && !facts.waits_for_operator &&
         !has_unread_lines(facts) && !has_blocks && facts.dwell_s >= 0 &&
         facts.unanswered_s >= facts.dwell_s + kPatience_s;
}

void StallWatch::on_progress(Instant now) {
  progress_at_ = now;
  proof_ = StallProof::NotAsked;
  idle_reports_ = 0;
  question_due_ = false;
}

std::optional<Stall> StallWatch::on_report(Instant now, StallFacts facts) {
  const bool is_idle = facts.state == MachineState::Idle || facts.state == MachineState::Check;
  idle_reports_ = is_idle ? idle_reports_ + 1 : 0;
  if (proof_ == StallProof::Asked && now - asked_at_ >= kProofTimeout) proof_ = StallProof::NoAnswer;
  const bool is_held =
      facts.state == MachineState::Hold || facts.state == MachineState::Door || facts.state == MachineState::Tool;
  // No line is read while it stands: what was waited for there is no matter.
  if (std::exchange(was_held_, is_held) && !is_held) on_progress(now);
  facts.unanswered_s = unanswered_s(now);
  facts.proof = proof_;
  if (idle_reports_ >= kIdleReports && calls_for_proof(facts)) {
    question_due_ = true;
    proof_ = StallProof::Asked;
    asked_at_ = now;
  }
  return diagnose(facts);
}

bool StallWatch::take_question() {
  return std::exchange(question_due_, false);
}

}  // namespace kerf::job
