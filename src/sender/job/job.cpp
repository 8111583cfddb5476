#include "sender/job/job.hpp"

#include <chrono>
#include <utility>

#include "common/vocabulary/alarms.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using vocabulary::AlarmCode;

/// Answers that still come after an alarm come soon; lines of a critical alarm get none.
constexpr Duration kAlarmDrain = 3s;
constexpr Duration kReportAge = 250ms;

bool loses_position(int alarm_code) {
  return alarm_code == number_of(AlarmCode::HardLimit) || alarm_code == number_of(AlarmCode::AbortCycle);
}

std::string line_text(std::uint32_t file_line) {
  return "line " + std::to_string(file_line);
}

}  // namespace

Job::Job(Instant now, const Program& program, JobTerms terms, std::shared_ptr<const Timeline> timeline)
    : terms_(std::move(terms)) {
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
  const bool repeats = account_ && account_->on_answer(answer.error_code, answer.file_line);
  if (answer.error_code == 0) {
    if (account_) ++state_.aftermath.lines_executed_after_refusal;
    meter_.acknowledge(answer.file_line, answer.file_offset_after);
    return false;
  }
  Aftermath& aftermath = state_.aftermath;
  if (aftermath.first_line_not_executed == 0) aftermath.first_line_not_executed = answer.file_line;
  ++aftermath.lines_not_executed;
  if (!repeats && !state_.alarm_code && state_.phase != JobPhase::Stopping) refuse(now, answer);
  return repeats;
}

void Job::refuse(Instant now, const JobAnswer& answer) {
  state_.refusal = Refusal{.file_line = answer.file_line,
                           .text = std::string{answer.text},
                           .code = answer.error_code,
                           .meaning = std::string{answer.meaning}};
  ++state_.lines_refused;
  account_.emplace(*state_.refusal, terms_.has_error_latch);
  goes_on_ = terms_.on_error == ErrorPolicy::Continue;
  if (goes_on_ && !terms_.has_error_latch) return;
  feeding_held_ = true;
  order(JobOrder::HoldFeeding);
  if (goes_on_) return;
  if (terms_.on_error == ErrorPolicy::Stop) {
    stop(now);
    return;
  }
  const bool was_held = state_.phase == JobPhase::Held;
  enter(now, was_held ? JobPhase::Held : JobPhase::Holding, HoldCause::Refusal, was_held && resumable_);
  if (!was_held) order_hold(now);
}

void Job::on_lines_answered(Instant now) {
  if (ended() || state_.phase == JobPhase::Stopping) return;
  if (state_.alarm_code) {
    if (*state_.alarm_code != number_of(AlarmCode::AbortCycle)) end_by_alarm(now);
    return;
  }
  if (feeding_held_) {
    if (goes_on_) go_on(now);
    return;
  }
  if (waiting_ != Waiting::ForLines) return;
  if (terms_.flow && terms_.flow->gate() && !terms_.flow->gate()->by_operator) {
    waiting_ = Waiting::ForToolState;
    tool_line_answered_at_ = now;
    return;
  }
  waiting_ = Waiting::ForSync;
  order(JobOrder::SendSync);
}

// Every line that was on its way is answered: the account of the refused line is complete.
void Job::go_on(Instant) {
  goes_on_at_ = account_->goes_on_at();
  // What the latch refused is sent again.
  state_.aftermath.lines_not_executed -= account_->lines_latched();
  if (terms_.flow) terms_.flow->go_back_to(goes_on_at_);
  if (terms_.has_error_latch) order(JobOrder::ClearLatch);
  order(JobOrder::FeedAgain);
  account_.reset();
  feeding_held_ = goes_on_ = false;
}

void Job::on_sync_answered(Instant) {
  if (waiting_ == Waiting::ForSync) waiting_ = Waiting::ForRest;
}

bool Job::is_at_operators_gate() const {
  return state_.phase == JobPhase::Held && state_.tool_change && state_.tool_change->by_operator;
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
}

void Job::on_lines_lost(std::uint32_t first_file_line, std::uint32_t lines) {
  if (ended() || lines == 0) return;
  Aftermath& aftermath = state_.aftermath;
  if (aftermath.first_line_not_executed == 0) aftermath.first_line_not_executed = first_file_line;
  aftermath.lines_not_executed += lines;
}

void Job::hold_for(Instant now, Stall stall) {
  if (ended() || state_.phase == JobPhase::Stopping) return;
  feeding_held_ = true;
  goes_on_ = false;
  account_.reset();
  order(JobOrder::HoldFeeding);
  // Lines are missing in what it executes.
  if (moving_) order(JobOrder::FeedHold);
  enter(now, JobPhase::Held, HoldCause::Stall, stall.goes_on_at.has_value());
  state_.stall = std::move(stall);
}

void Job::on_welcome(Instant now) {
  if (ended()) return;
  if (state_.phase == JobPhase::Stopping) {
    end(now, stopped_phase(),
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
  // At a tool change by the operator the machine is idle and stands.
  if (ended() || state_.phase == JobPhase::Stopping || waits_while_idle()) return;
  order_hold(now);
  hold_asked_ = true;
  if (state_.phase == JobPhase::Running) enter(now, JobPhase::Holding, HoldCause::FeedHold);
}

void Job::resume(Instant now) {
  if (!can_resume()) return;
  hold_asked_ = false;
  if (is_at_operators_gate()) {
    if (in_hold_) order(JobOrder::CycleStart);
    terms_.flow->pass_gate();
    state_.tool_change.reset();
    waiting_ = Waiting::ForLines;
    enter(now, JobPhase::Running);
    return;
  }
  if (state_.hold_cause == HoldCause::Stall) {
    goes_on_at_ = *state_.stall->goes_on_at;
    state_.stall.reset();
    feeding_held_ = false;
    waiting_ = Waiting::ForLines;
    if (terms_.flow) terms_.flow->go_back_to(goes_on_at_);
    order(JobOrder::FeedAgain);
    enter(now, JobPhase::Running);
    return;
  }
  if (asks_about_refusal() && state_.hold_cause == HoldCause::Refusal) goes_on_ = true;
  deaf_to_hold_until_ = now + kReportAge;
  state_.departure.reset();
  order(JobOrder::CycleStart);
  if (state_.phase == JobPhase::Held) enter(now, JobPhase::Running);
}

void Job::stop(Instant now) {
  if (ended() || state_.phase == JobPhase::Stopping) return;
  const bool rests = state_.phase == JobPhase::Held && !moving_;
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
  // The operator knows of the stop that he asked for.
  const bool by_policy = account_ && terms_.on_error == ErrorPolicy::Stop;
  for (const StopOrder what : stop_.take_orders()) {
    if (what == StopOrder::SoftReset && by_policy) order(JobOrder::AnnounceReset);
    order(what == StopOrder::FeedHold ? JobOrder::FeedHold : JobOrder::SoftReset);
  }
}

void Job::advance_to(Instant now) {
  stop_.advance_to(now);
  obey_stop();
  if (stop_.is_unconfirmed()) {
    end(now, stopped_phase(), "The controller did not confirm the reset: look at the machine before anything else.");
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
