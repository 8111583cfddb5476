#include "sender/job/job.hpp"

#include <chrono>
#include <utility>

#include "common/vocabulary/alarms.hpp"
#include "sender/machine/rest.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using vocabulary::AlarmCode;
using vocabulary::MachineState;

/// A hold that shows no effect is sent again: a byte can get lost.
constexpr Duration kHoldRepeat = 1s;
/// Answers that still come after an alarm come soon; lines of a critical alarm get none.
constexpr Duration kAlarmDrain = 3s;
constexpr Duration kReportAge = 250ms;

bool is_moving(const machine::Snapshot& snapshot) {
  return snapshot.state != MachineState::Idle && !machine::is_at_rest(snapshot);
}

bool loses_position(int alarm_code) {
  return alarm_code == number_of(AlarmCode::HardLimit) || alarm_code == number_of(AlarmCode::AbortCycle);
}

std::string line_text(std::uint32_t file_line) {
  return "line " + std::to_string(file_line);
}

}  // namespace

Job::Job(Instant now, const Program& program, bool has_error_latch, std::shared_ptr<const Timeline> timeline)
    : has_error_latch_(has_error_latch) {
  state_.program = program.name();
  meter_.start(now, program.line_count(), program.size_bytes(), std::move(timeline));
  update_progress(now);
}

void Job::stop_feeding() {
  if (!feeding_) return;
  feeding_ = false;
  order(JobOrder::StopFeeding);
}

void Job::order_hold(Instant now) {
  hold_ordered_ = true;
  hold_ordered_at_ = now;
  order(JobOrder::FeedHold);
}

void Job::enter(Instant now, JobPhase phase, HoldCause cause, bool resumable) {
  state_.phase = phase;
  state_.hold_cause = cause == HoldCause::FeedHold && state_.departure ? HoldCause::OffPath : cause;
  resumable_ = resumable;
  if (phase == JobPhase::Running || phase == JobPhase::Held) hold_ordered_ = false;
  meter_.set_held(now, phase == JobPhase::Held);
}

void Job::end(Instant now, JobPhase phase, std::string reason) {
  stop_feeding();
  if (phase == JobPhase::Finished) meter_.complete();
  if (phase == JobPhase::Refused && has_error_latch_) order(JobOrder::ClearLatch);
  enter(now, phase);
  meter_.stop(now);
  update_progress(now);
  state_.reason = std::move(reason);
  deadline_ = kNever;
  stop_.end();
}

void Job::end_by_alarm(Instant now) {
  std::string reason = "Alarm " + std::to_string(*state_.alarm_code) + " ended the job";
  if (state_.progress.file_line > 0 || meter_.at(now).file_line > 0) {
    reason += " after " + line_text(meter_.at(now).file_line);
  }
  if (!alarm_meaning_.empty()) reason += ": " + alarm_meaning_;
  end(now, JobPhase::Alarmed, reason + (reason.ends_with('.') ? "" : "."));
}

bool Job::on_answer(Instant now, const JobAnswer& answer) {
  if (ended()) return false;
  if (answer.error_code == 0) {
    if (state_.refusal) {
      ++state_.aftermath.lines_executed_after_refusal;
    } else {
      meter_.acknowledge(answer.file_line, answer.file_offset_after);
    }
    return false;
  }
  Aftermath& aftermath = state_.aftermath;
  if (aftermath.first_line_not_executed == 0) aftermath.first_line_not_executed = answer.file_line;
  ++aftermath.lines_not_executed;
  if (state_.refusal) return has_error_latch_ && answer.error_code == state_.refusal->code;
  if (state_.alarm_code || state_.phase == JobPhase::Stopping) return false;
  state_.refusal = Refusal{.file_line = answer.file_line,
                           .text = std::string{answer.text},
                           .code = answer.error_code,
                           .meaning = std::string{answer.meaning}};
  stop_feeding();
  enter(now, JobPhase::Draining);
  return false;
}

void Job::on_lines_answered(Instant now) {
  if (ended() || lines_settled_) return;
  lines_settled_ = true;
  if (state_.phase == JobPhase::Stopping) return;
  if (state_.alarm_code) {
    if (*state_.alarm_code != number_of(AlarmCode::AbortCycle)) end_by_alarm(now);
    return;
  }
  if (state_.refusal) {
    waiting_ = Waiting::ForRest;
    return;
  }
  waiting_ = Waiting::ForSync;
  order(JobOrder::SendSync);
}

void Job::on_sync_answered(Instant) {
  if (waiting_ == Waiting::ForSync) waiting_ = Waiting::ForRest;
}

void Job::on_snapshot(Instant now, const machine::Snapshot& snapshot) {
  if (ended()) return;
  moving_ = is_moving(snapshot);
  if (snapshot.overrides) meter_.set_feed_override(now, snapshot.overrides->feed);
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
  follow_motion(now, snapshot);
}

void Job::follow_motion(Instant now, const machine::Snapshot& snapshot) {
  const bool may_hold = state_.phase != JobPhase::Draining;
  if (!may_hold) resumable_ = machine::can_resume(snapshot);
  switch (snapshot.state) {
    case MachineState::Hold:
      if (!may_hold || now < deaf_to_hold_until_) return;
      if (machine::is_at_rest(snapshot))
        enter(now, JobPhase::Held, HoldCause::FeedHold, true);
      else
        enter(now, JobPhase::Holding, HoldCause::FeedHold);
      return;
    case MachineState::Door:
      if (!may_hold) return;
      if (snapshot.substate == vocabulary::kDoorResumingGrbl || snapshot.substate == vocabulary::kDoorResumingHal) {
        enter(now, JobPhase::Running);
      } else {
        enter(now, machine::is_at_rest(snapshot) ? JobPhase::Held : JobPhase::Holding, HoldCause::Door,
              machine::can_resume(snapshot));
      }
      return;
    case MachineState::Tool:
      if (may_hold && now >= deaf_to_hold_until_) enter(now, JobPhase::Held, HoldCause::ToolChange, true);
      return;
    case MachineState::Idle:
    case MachineState::Check:
      if (waiting_ == Waiting::ForRest && state_.refusal) {
        end(now, JobPhase::Refused,
            "The controller refused " + line_text(state_.refusal->file_line) + " with error " +
                std::to_string(state_.refusal->code) + ".");
        return;
      }
      if (waiting_ == Waiting::ForRest && !hold_ordered_) {
        end(now, JobPhase::Finished, "Every line was executed and the machine stands still.");
        return;
      }
      break;
    default: break;
  }
  if (may_hold) follow_run(now);
}

void Job::follow_run(Instant now) {
  if (!hold_ordered_) {
    if (state_.phase != JobPhase::Running) enter(now, JobPhase::Running);
    return;
  }
  if (now - hold_ordered_at_ >= kHoldRepeat) order_hold(now);
}

void Job::on_alarm(Instant now, int code, std::string_view meaning) {
  if (ended()) return;
  if (loses_position(code)) state_.position_suspect = true;
  if (state_.phase == JobPhase::Stopping) return;
  state_.alarm_code = code;
  alarm_meaning_ = std::string{meaning};
  stop_feeding();
  enter(now, JobPhase::Draining);
  deadline_ = now + kAlarmDrain;
  if (lines_settled_ && code != number_of(AlarmCode::AbortCycle)) end_by_alarm(now);
}

void Job::on_lines_lost(std::uint32_t first_file_line, std::uint32_t lines) {
  if (ended() || lines == 0) return;
  Aftermath& aftermath = state_.aftermath;
  if (aftermath.first_line_not_executed == 0) aftermath.first_line_not_executed = first_file_line;
  aftermath.lines_not_executed += lines;
}

void Job::on_welcome(Instant now) {
  if (ended()) return;
  if (state_.phase == JobPhase::Stopping) {
    end(now, JobPhase::Stopped,
        state_.position_suspect ? "The job was stopped in motion: home the machine before relying on its position."
                                : "The job was stopped and the machine's position is kept.");
    return;
  }
  end(now, JobPhase::Interrupted,
      state_.alarm_code ? "The controller was reset while the machine moved: home it before relying on its position."
                        : "The controller restarted in the middle of the job.");
}

void Job::on_link_closed(Instant now) {
  if (ended()) return;
  if (moving_) state_.position_suspect = true;
  end(now, JobPhase::Interrupted,
      "The link to the controller was lost in the middle of the job; what it had buffered may still have been "
      "executed.");
}

void Job::on_departure(Instant now, const PathDeparture& departure) {
  if (ended() || state_.departure || state_.phase == JobPhase::Stopping) return;
  state_.departure = departure;
  if (state_.phase == JobPhase::Held) {
    if (state_.hold_cause == HoldCause::FeedHold) state_.hold_cause = HoldCause::OffPath;
    return;
  }
  hold(now);
}

void Job::set_executing(const ExecutingLines& lines) {
  meter_.set_executing(lines);
  state_.progress.executing = lines;
}

void Job::hold(Instant now) {
  if (ended() || state_.phase == JobPhase::Stopping) return;
  order_hold(now);
  if (state_.phase == JobPhase::Running) enter(now, JobPhase::Holding, HoldCause::FeedHold);
}

void Job::resume(Instant now) {
  if (!can_resume()) return;
  deaf_to_hold_until_ = now + kReportAge;
  state_.departure.reset();
  order(JobOrder::CycleStart);
  if (state_.phase == JobPhase::Held) enter(now, JobPhase::Running);
}

void Job::stop(Instant now) {
  if (ended() || state_.phase == JobPhase::Stopping) return;
  const bool rests = state_.phase == JobPhase::Held;
  stop_feeding();
  enter(now, JobPhase::Stopping);
  stop_.begin(now, rests, deaf_to_hold_until_);
  obey_stop();
}

void Job::abort(Instant now) {
  if (ended()) return;
  if (moving_ && state_.phase != JobPhase::Held) state_.position_suspect = true;
  stop_feeding();
  enter(now, JobPhase::Stopping);
  stop_.reset_now(now);
  obey_stop();
}

void Job::obey_stop() {
  if (stop_.position_suspect()) state_.position_suspect = true;
  for (const StopOrder what : stop_.take_orders()) {
    order(what == StopOrder::FeedHold ? JobOrder::FeedHold : JobOrder::SoftReset);
  }
}

void Job::advance_to(Instant now) {
  stop_.advance_to(now);
  obey_stop();
  if (stop_.is_unconfirmed()) {
    end(now, JobPhase::Stopped, "The controller did not confirm the reset: look at the machine before anything else.");
    return;
  }
  if (now < deadline_) return;
  deadline_ = kNever;
  if (state_.alarm_code && state_.phase != JobPhase::Stopping) end_by_alarm(now);
}

std::vector<JobOrder> Job::take_orders() {
  return std::exchange(orders_, {});
}

}  // namespace kerf::job
