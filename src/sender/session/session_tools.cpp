// A job waits for a tool, and the operator works by hand meanwhile.

#include <string>
#include <utility>

#include "sender/machine/rest.hpp"
#include "sender/session/refusals.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::Purpose;
using vocabulary::MachineState;
using vocabulary::Realtime;

}  // namespace

bool Session::is_at_tool_change() const {
  return has_job() && job_->state().phase == job::JobPhase::Held &&
         job_->state().hold_cause == job::HoldCause::ToolChange && !stop_.is_under_way();
}

std::optional<Refused> Session::why_no_tool_work(Instant now) const {
  if (snapshot().pendant_in_control) return Refused::PendantInControl;
  if (!is_ready()) return Refused::NotIdentified;
  if (tool_work_.is_returning()) return Refused::NotAtRest;
  if (gate_.verdict(now) != GateVerdict::Open) return Refused::NotAnswering;
  return std::nullopt;
}

void Session::send_by_hand(Instant now, std::string text) {
  if (!tool_work_.is_open()) tool_work_.begin(snapshot());
  if (tool_work_.on_line(now, snapshot())) send_byte(Realtime::ToolChangeAcknowledge);
  // Offsets and place are no longer what the program made them.
  path_.on_work_by_hand(text);
  incidents_.forget();
  last_line_jogs_ = streaming::is_jog(text);
  streamer_.enqueue(Purpose::Operator, std::move(text));
}

// The operator is done with the tool.
void Session::go_back_from_tool_work() {
  const bool stands = snapshot().state == MachineState::Idle || machine::is_at_rest(snapshot());
  const bool is_answered = ledger().empty() && streamer_.done_with(Purpose::Operator);
  const auto lines = tool_work_.way_back(snapshot());
  if (!stands || !is_answered || !lines) {
    refuse(Refused::NotAtRest, "The machine is not yet at rest behind the last line by hand: continue once it is.");
    return;
  }
  for (const std::string& line : *lines) streamer_.enqueue(Purpose::Operator, line);
  tool_work_.set_returning(true);
}

void Session::follow_tool_work(Instant now) {
  if (!is_at_tool_change()) {
    tool_work_.end();
    return;
  }
  if (!tool_work_.is_open()) tool_work_.begin(snapshot());
  tool_work_.on_report();
  const bool stands = snapshot().state == MachineState::Idle || snapshot().state == MachineState::Tool;
  const bool is_answered = ledger().empty() && streamer_.done_with(Purpose::Operator);
  if (!tool_work_.is_returning() || !stands || !is_answered) return;
  const auto lines = tool_work_.way_back(snapshot());
  if (!lines) return;
  tool_work_.set_returning(false);
  if (lines->empty())
    job_->resume(now);
  else
    refuse(Refused::NotAtRest,
           "The machine did not get back to where the job waits for its tool: jog it out of the way "
           "of whatever is there and continue, or stop the job.");
}

}  // namespace kerf::session
