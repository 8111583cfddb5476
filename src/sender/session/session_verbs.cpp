// Hold, resume, stop, abort and cancel: what each means for a job, for a jog, and for motion by hand.

#include <optional>
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

// A jog comes without a report in between, and nothing else can move from Idle meanwhile.
bool Session::may_be_jogging() const {
  return snapshot().state == MachineState::Jog || (snapshot().state == MachineState::Idle && last_line_jogs_);
}

void Session::cancel_jog() {
  tool_work_.set_returning(false);
  streamer_.drop_queued(Purpose::Operator);
  send_byte(Realtime::JogCancel);
  // grblHAL drops every unread line with it (protocol.md 4.4). Elsewhere a jog that waits for planner room is planned
  // behind the cancelled ones: it is cancelled in its turn (on_answer).
  if (dialect().jog_cancel_flushes_rx)
    strike_out();
  else
    cancels_owed_jogs_ = !ledger().empty();
}

void Session::on_jog_answered(const streaming::OwedLine& line) {
  if (!cancels_owed_jogs_) return;
  if (streaming::is_jog(line.text)) send_byte(Realtime::JogCancel);
  cancels_owed_jogs_ = !ledger().empty();
}

void Session::obey(Instant now, const HoldJob&) {
  if (has_job() && !(is_at_tool_change() && may_be_jogging()))
    job_->hold(now);
  else if (may_be_jogging())
    // grblHAL takes no hold while it jogs (protocol.md 6.8); Grbl and Rabbit cancel either way.
    cancel_jog();
  else
    send_byte(Realtime::FeedHold);
}

bool Session::can_resume() const {
  if (snapshot().pendant_in_control || stop_.is_under_way()) return false;
  return has_job() ? job_->can_resume() : machine::can_resume(snapshot());
}

void Session::obey(Instant now, const ResumeJob&) {
  if (!can_resume()) {
    refuse(snapshot().pendant_in_control ? Refused::PendantInControl : Refused::NotAtRest);
    return;
  }
  if (is_at_tool_change() && tool_work_.has_worked()) {
    go_back_from_tool_work();
    return;
  }
  if (has_job() && job_->state().departure) path_.on_overruled();
  // Only a stall of which the lost lines are known can be resumed.
  if (has_job() && job_->state().hold_cause == job::HoldCause::Stall) link_doubt_ = {};
  if (has_job())
    job_->resume(now);
  else
    send_byte(Realtime::CycleStart);
}

void Session::obey(Instant now, const StopJob&) {
  if (has_job()) {
    if (is_at_tool_change() && may_be_jogging()) cancel_jog();
    job_->stop(now);
    return;
  }
  const bool was_waiting = std::exchange(waiting_start_, std::nullopt).has_value();
  start_until_ = kNever;
  if (may_be_jogging()) {
    cancel_jog();
    return;
  }
  const bool rests = machine::is_at_rest(snapshot());
  const bool holds = rests && snapshot().state == MachineState::Hold;
  const bool is_idle = snapshot().state == MachineState::Idle && !gate_.may_be_moving();
  if ((rests && !holds) || is_idle) {
    if (!was_waiting) refuse(Refused::NoJob);
    return;
  }
  streamer_.drop_queued(Purpose::Operator);
  if (!stop_.is_under_way()) stop_.begin(now, holds);
}

void Session::obey(Instant now, const AbortJob&) {
  if (has_job())
    job_->abort(now);
  else
    obey(now, SoftReset{});
}

void Session::obey(Instant, const CancelJog&) {
  if (has_job() && !is_at_tool_change()) {
    refuse(Refused::JobUnderWay);
    return;
  }
  cancel_jog();
}

void Session::obey(Instant now, const SoftReset&) {
  if (has_job()) {
    job_->abort(now);
    return;
  }
  stop_.end();
  waiting_start_.reset();
  start_until_ = kNever;
  reset_controller(now);
  handshake_.on_operator_reset(now);
}

void Session::follow_stop(Instant now) {
  for (const job::StopOrder order : stop_.take_orders()) {
    if (order == job::StopOrder::FeedHold) {
      send_byte(Realtime::FeedHold);
    } else {
      reset_controller(now);
      handshake_.on_operator_reset(now);
    }
  }
  if (stop_.is_unconfirmed()) stop_.end();
}

}  // namespace kerf::session
