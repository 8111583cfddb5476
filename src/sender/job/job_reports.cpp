// A job as the machine's reports tell it: what holds it, whether it obeys, and when it rests.

#include <chrono>
#include <utility>

#include "sender/job/job.hpp"
#include "sender/machine/rest.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// A hold that shows no effect is sent again: a byte can get lost.
constexpr Duration kHoldRepeat = 1s;
/// The controller answers M6 and then enters its Tool state; a report that was on its way may still say Idle.
constexpr Duration kToolStateDelay = 300ms;

bool is_moving(const machine::Snapshot& snapshot) {
  return snapshot.state != MachineState::Idle && !machine::is_at_rest(snapshot);
}

}  // namespace

void Job::on_snapshot(Instant now, const machine::Snapshot& snapshot, std::string_view awaited) {
  if (ended()) return;
  moving_ = is_moving(snapshot);
  in_hold_ = snapshot.state == MachineState::Hold;
  if (snapshot.overrides) meter_.set_overrides(now, snapshot.overrides->feed, snapshot.overrides->rapid);
  update_progress(now);
  if (state_.phase == JobPhase::Stopping) {
    stop_.on_snapshot(now, snapshot);
    obey_stop();
    return;
  }
  if (snapshot.pendant_in_control) {
    end(now, JobPhase::Interrupted, "A pendant took control of the machine in the middle of the job.");
    return;
  }
  if (snapshot.state == MachineState::Sleep) {
    end(now, JobPhase::Interrupted, "The controller went to sleep in the middle of the job; only a reset wakes it.");
    return;
  }
  if (snapshot.state == MachineState::Alarm) {
    if (!state_.alarm_code) on_alarm(now, snapshot.alarm_code.value_or(snapshot.substate.value_or(0)), "");
    return;
  }
  follow_motion(now, snapshot, awaited);
}

HoldCause Job::cause_of_hold(const machine::Snapshot& snapshot, std::string_view awaited) const {
  if (asks_about_refusal()) return HoldCause::Refusal;
  if (hold_asked_) return HoldCause::FeedHold;
  const FlowWords words = flow_words_of(awaited);
  if (words.pauses || words.pauses_optionally) return HoldCause::ProgramPause;
  if (snapshot.inputs && snapshot.inputs->single_block) return HoldCause::SingleBlock;
  return HoldCause::FeedHold;
}

void Job::follow_motion(Instant now, const machine::Snapshot& snapshot, std::string_view awaited) {
  const bool may_hold = state_.phase != JobPhase::Draining;
  if (!may_hold) resumable_ = machine::can_resume(snapshot);
  const bool rests = machine::is_at_rest(snapshot);
  if (snapshot.state != MachineState::Idle) was_idle_ = false;
  switch (snapshot.state) {
    case MachineState::Hold:
      if (!may_hold || now < deaf_to_hold_until_ || waits_while_idle()) return;
      enter(now, rests ? JobPhase::Held : JobPhase::Holding, cause_of_hold(snapshot, awaited), rests);
      return;
    case MachineState::Door:
      if (!may_hold) return;
      if (snapshot.substate == vocabulary::kDoorResumingGrbl || snapshot.substate == vocabulary::kDoorResumingHal) {
        enter(now, JobPhase::Running);
      } else {
        enter(now, rests ? JobPhase::Held : JobPhase::Holding, HoldCause::Door, machine::can_resume(snapshot));
      }
      return;
    case MachineState::Jog:
      if (state_.hold_cause == HoldCause::ToolChange) return;  // by the operator's hand
      break;
    case MachineState::Tool:
      if (!may_hold || now < deaf_to_hold_until_) return;
      if (terms_.flow) state_.tool_change = terms_.flow->gate();
      enter(now, JobPhase::Held, HoldCause::ToolChange, true);
      return;
    case MachineState::Check:
      // No hold is taken there (protocol.md 6.6), and nothing moves.
      if (asks_about_refusal()) return enter(now, JobPhase::Held, HoldCause::Refusal, true);
      [[fallthrough]];
    case MachineState::Idle:
      if (waits_while_idle()) return;
      if (waiting_ == Waiting::ForToolState && now - tool_line_answered_at_ >= kToolStateDelay) {
        if (std::exchange(was_idle_, true)) follow_tool_gate(now);
        break;
      }
      if (waiting_ == Waiting::ForRest && !hold_ordered_) return follow_rest(now);
      break;
    default: break;
  }
  if (may_hold) follow_run(now);
}

// Nothing is on its way and the machine stands.
void Job::follow_rest(Instant now) {
  if (terms_.flow && terms_.flow->gate()) {
    state_.tool_change = terms_.flow->gate();
    enter(now, JobPhase::Held, HoldCause::ToolChange, true);
    return;
  }
  if (terms_.flow) state_.end_line = terms_.flow->end_line();
  end(now, JobPhase::Finished,
      state_.lines_refused == 0 ? "Every line was executed and the machine stands still."
                                : "The machine stands still; " + std::to_string(state_.lines_refused) + " refused " +
                                      (state_.lines_refused == 1 ? "line was" : "lines were") +
                                      " left out, the last is line " + std::to_string(state_.refusal->file_line) + ".");
}

// The controller has left its Tool state, or never entered it; on its way back it may be idle between two motions.
void Job::follow_tool_gate(Instant now) {
  terms_.flow->pass_gate();
  state_.tool_change.reset();
  waiting_ = Waiting::ForLines;
  was_idle_ = false;
  enter(now, JobPhase::Running);
}

void Job::follow_run(Instant now) {
  // A report that was changed on its way does not answer the question of a stall, and a closed door does not either.
  if (asks_about_stall()) return enter(now, JobPhase::Held, HoldCause::Stall, state_.stall && state_.stall->goes_on_at);
  // A door that was closed again does not answer the question.
  if (asks_about_refusal() && !hold_ordered_) {
    enter(now, JobPhase::Holding, HoldCause::Refusal);
    return order_hold(now);
  }
  if (!hold_ordered_) {
    if (state_.phase != JobPhase::Running) enter(now, JobPhase::Running);
    return;
  }
  if (now - hold_ordered_at_ >= kHoldRepeat) order_hold(now);
}

}  // namespace kerf::job
