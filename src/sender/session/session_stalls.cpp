// Answers that do not come: what is known about it, the question that proves something, and what follows.

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::OwedLine;
using streaming::Purpose;
using vocabulary::MachineState;

/// A controller that answers it has read every line before it, and it moves nothing.
constexpr std::string_view kQuestion = "$G";

void describe_lines(job::StallFacts& facts, const auto& lines) {
  facts.owed_lines = lines.size();
  for (const OwedLine& line : lines) {
    if (line.file_line != 0) {
      if (facts.first_owed_line == 0) facts.first_owed_line = line.file_line;
      facts.last_owed_line = line.file_line;
    }
    const double dwell_s = job::flow_words_of(line.text).dwell_s.value_or(0);
    facts.dwell_s = dwell_s < 0 || facts.dwell_s < 0 ? -1 : facts.dwell_s + dwell_s;
  }
}

}  // namespace

job::StallFacts Session::stall_facts() const {
  const auto& now_known = snapshot();
  const auto& buffers = capabilities().buffers;
  job::StallFacts facts{.state = now_known.state,
                        .waits_for_operator = job_->state().phase == job::JobPhase::Held,
                        .single_block = now_known.inputs && now_known.inputs->single_block,
                        .planner_free = now_known.planner_blocks_free,
                        .planner_blocks = buffers.planner_blocks,
                        .rx_free = now_known.rx_bytes_free,
                        .rx_bytes = buffers.rx_usable};
  return facts;
}

void Session::watch_stall(Instant now) {
  if (job_->state().phase == job::JobPhase::Stopping || job_->state().hold_cause == job::HoldCause::Stall) return;
  job::StallFacts facts = stall_facts();
  // Most reports come while answers do.
  if (stall_.unanswered_s(now) >= 1) describe_lines(facts, ledger().owed());
  auto stall = stall_.on_report(now, facts);
  constexpr std::size_t kQuestionBytes = 3;
  // Beyond the window nothing is sent, not even where it would fit.
  const bool has_room = ledger().bytes_in_flight() + kQuestionBytes <= streamer_.window();
  const bool calls_for_question = stall_.take_question() || (link_doubt_.is_question_due() && !ledger().empty());
  if (calls_for_question && has_room && !ledger().owes(Purpose::Proof)) {
    link_doubt_.on_asked();
    const OwedLine line = streamer_.interject(now, outbox_.lines, Purpose::Proof, std::string{kQuestion});
    tell(LineSent{.purpose = line.purpose, .file_line = 0, .text = line.text});
  }
  job_->on_stall(std::move(stall));
}

void Session::note_silence() {
  const auto first = std::ranges::find(ledger().owed(), Purpose::JobLine, &OwedLine::purpose);
  if (has_job() && first != ledger().owed().end()) link_doubt_.on_silence(first->file_line);
}

// `[GC:` behind lines that owe answers: the controller has read all of them.
void Session::on_parser_state(Instant now) {
  const auto question = std::ranges::find(ledger().owed(), kQuestion, &OwedLine::text);
  if (question == ledger().owed().end() || question->purpose != Purpose::Proof) return;
  auto lost = streamer_.strike_out_before(Purpose::Proof);
  if (lost.empty()) link_doubt_.on_account_settled();
  if (lost.empty() || !has_job()) return;
  // A dwell of Kerf's own moves nothing, and an empty line does nothing: their answers are proven by the question's.
  const auto is_job_line = [](const OwedLine& line) { return line.purpose == Purpose::JobLine; };
  if (std::ranges::none_of(lost, is_job_line)) {
    if (std::ranges::any_of(lost, [](const OwedLine& line) { return line.purpose == Purpose::JobSync; })) {
      job_->on_sync_answered(now);
    }
    return;
  }
  std::erase_if(lost, [&](const OwedLine& line) { return !is_job_line(line); });
  link_doubt_.on_lines_lost();
  hold_for_stall(now, std::move(lost), job::StallProof::LinesRead);
}

// An error in place of the answer to the question: it was read as the end of a line that had none.
void Session::on_line_end_lost(Instant now, OwedLine line) {
  std::vector<OwedLine> lines{std::move(line)};
  for (OwedLine& other : streamer_.strike_out()) {
    if (other.purpose == Purpose::JobLine) lines.push_back(std::move(other));
  }
  if (dialect().error_latch) streamer_.enqueue(Purpose::ClearLatch, "");
  if (has_job()) hold_for_stall(now, std::move(lines), job::StallProof::LineEndMissing);
}

void Session::hold_for_stall(Instant now, std::vector<OwedLine> lines, job::StallProof proof) {
  job::StallFacts facts = stall_facts();
  describe_lines(facts, lines);
  facts.unanswered_s = stall_.unanswered_s(now);
  facts.proof = proof;
  facts.silent_from_line = link_doubt_.from_line().value_or(0);
  const bool rests = facts.state == MachineState::Idle || facts.state == MachineState::Check;
  if (rests && facts.silent_from_line == 0 && snapshot().machine_position_mm) {
    facts.executed_lines = incidents_.lines_behind(lines, *snapshot().machine_position_mm,
                                                   proof == job::StallProof::LinesRead ? &snapshot().modes : nullptr);
    const auto executed = facts.executed_lines.value_or(lines.size());
    if (executed < lines.size()) facts.first_not_executed = lines[executed].file_line;
    if (executed == lines.size()) {
      for (const OwedLine& line : lines) incidents_.on_accepted(line);
    }
  }
  auto stall = job::diagnose(facts);
  stall_.on_proof(job::StallProof::NotAsked);
  if (!stall) return;
  tell(JobStalled{*stall});
  job_->hold_for(now, *std::move(stall));
}

}  // namespace kerf::session
