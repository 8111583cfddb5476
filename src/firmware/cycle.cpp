#include "firmware/cycle.hpp"

#include <algorithm>

#include "common/base/overloaded.hpp"

namespace kerf::firmware {

using motion::ExecutorPhase;
using vocabulary::FeedbackText;

namespace {

constexpr unsigned kRestoreAfterHoldBit = 1;

}  // namespace

void Cycle::auto_start(int more_passes) {
  const bool changes_tool = board_.state == MachineState::Tool && board_.changes_tool;
  if (!(board_.state == MachineState::Idle || changes_tool) || board_.planner.is_empty()) return;
  const auto wait = wait_for_index();
  if (!wait) return miss_spindle();
  if (*wait > Duration::zero()) board_.locked_until = board_.now + *wait;
  board_.owes_status = board_.owes_status || changes_tool;
  run_or_idle(*wait + board_.until_pass(board_.personality.loop.to_start + more_passes));
}

void Cycle::run_or_idle_after(int passes) {
  run_or_idle(passes == 0 ? Duration::zero() : board_.until_pass(passes));
}

/// A limit switch interrupts motion in the step that closes it.
void Cycle::guard_limits() {
  if (!board_.guards_hard_limits() || board_.probing) return;
  board_.executor.clear_watches();
  const Workcell::Geometry& geometry = board_.geometry();
  for (std::size_t axis = 0; axis < geometry.axes; ++axis) {
    const auto step = board_.workcell.homing_switch_step(axis, geometry);
    if (!step) continue;
    const bool to_minus = ((geometry.homing_negative >> axis) & 1U) != 0;
    board_.executor.watch({.axis = static_cast<vocabulary::Axis>(axis),
                           .steps = *step,
                           .above = !to_minus,
                           .seen_by_step_interrupt = board_.personality.homing.switch_sees_pulses});
  }
}

void Cycle::run_or_idle(Duration after) {
  if (std::exchange(drops_rest_, false)) {
    board_.flush_motion();
    end_motion();
    return;
  }
  guard_limits();
  board_.executor.cycle_start(board_.now, after);
  const ExecutorPhase phase = board_.executor.phase();
  moving_ = phase == ExecutorPhase::Running || phase == ExecutorPhase::Decelerating;
  board_.state = moving_ ? MachineState::Run : resting_state();
}

void Cycle::cycle_start() {
  switch (board_.state) {
    case MachineState::Idle: auto_start(); break;
    case MachineState::Hold:
      if (board_.hold_complete) resume();
      break;
    case MachineState::Door:
      if (board_.door != DoorPhase::Closed || parking_.leg() != Parking::Leg::None) break;
      board_.door = DoorPhase::Resuming;
      restoring_ = Restoring::No;
      if (parking_.go_back()) {
        moving_ = true;
      } else {
        restore_next();
      }
      break;
    default: break;
  }
}

void Cycle::resume() {
  const bool restores = !board_.personality.realtime.resume_says_nothing_said ||
                        board_.settings.flag(setting::kHoldActions, kRestoreAfterHoldBit);
  const bool was_stopped = to_restore_.is_spinning() && !board_.accessories.is_spinning();
  if (was_stopped && restores) {
    board_.say(FeedbackText::RestoringSpindle);
    Accessories wanted = board_.accessories;
    wanted.spindle = to_restore_.spindle;
    wanted.programmed_rpm = to_restore_.programmed_rpm;
    board_.set_accessories(wanted);
    if (board_.settings.number(setting::kSpindleOnDelay) > 0) {
      restoring_ = Restoring::Hold;
      restored_at_ = board_.now + board_.delay_step(setting::kSpindleOnDelay).left;
      return;
    }
  }
  finish_resume(was_stopped);
}

void Cycle::finish_resume(bool was_stopped) {
  const bool says = board_.personality.realtime.resume_says_nothing_said &&
                    board_.settings.flag(setting::kHoldActions, kRestoreAfterHoldBit);
  restoring_ = Restoring::No;
  restored_at_ = kNever;
  if (says) board_.say(protocol::Feedback{});
  to_restore_ = {};
  board_.hold_complete = false;
  // A stopped spindle is restored first, one pass earlier.
  const int passes = board_.personality.loop.resume_to_start;
  run_or_idle_after(passes != 0 && was_stopped ? passes + 1 : passes);
}

void Cycle::feed_hold() {
  switch (board_.state) {
    case MachineState::Idle:
      if (board_.overrides.feed_hold_acts) pause();
      break;
    case MachineState::Run:
      if (cuts_thread()) {
        holds_after_thread_ = true;
      } else if (board_.overrides.feed_hold_acts && may_interrupt_cancel()) {
        halt(Halt::Hold);
      }
      break;
    case MachineState::Jog:
      if (board_.personality.dialect().feed_hold_cancels_jog) jog_cancel();
      break;
    default: break;
  }
}

void Cycle::pause() {
  board_.state = MachineState::Hold;
  board_.hold_complete = true;
  to_restore_ = board_.accessories;
}

void Cycle::jog_cancel() {
  if (board_.state == MachineState::Jog) halt(Halt::JogCancel);
}

void Cycle::cancel_motion() {
  if (board_.state == MachineState::Hold || board_.state == MachineState::Door) {
    drops_rest_ = board_.personality.realtime.hold_keeps_probe_contact;
  } else {
    halt(Halt::MotionCancel);
  }
}

/// The probe has touched, and now something else slows the machine down: the contact is not forgotten.
bool Cycle::may_interrupt_cancel() {
  if (halt_ != Halt::MotionCancel) return true;
  drops_rest_ = board_.personality.realtime.hold_keeps_probe_contact;
  return drops_rest_;
}

void Cycle::stop_before_limit() {
  if (board_.state == MachineState::Run) halt(Halt::SoftLimit);
}

void Cycle::halt(Halt reason) {
  if (halt_ == Halt::Stop) return;
  halt_ = reason;
  if (reason == Halt::Hold || reason == Halt::SoftLimit) {
    board_.state = MachineState::Hold;
    board_.hold_complete = false;
    to_restore_ = board_.accessories;
  }
  // A cancelled jog and a probe that touched stop as fast as 0x19 does (grblHAL system.h: one bit for both kinds of
  // cancel); elsewhere all of them are holds.
  const bool is_forgotten = reason == Halt::Stop || reason == Halt::JogCancel || reason == Halt::MotionCancel;
  if (is_forgotten) {
    board_.executor.begin_stop(board_.now);
  } else {
    board_.executor.begin_hold(board_.now);
  }
  const ExecutorPhase phase = board_.executor.phase();
  if (phase == ExecutorPhase::Resting || phase == ExecutorPhase::Held) come_to_rest();
}

void Cycle::come_to_rest() {
  moving_ = false;
  switch (std::exchange(halt_, Halt::None)) {
    case Halt::Hold: board_.hold_complete = true; break;
    case Halt::SoftLimit: board_.state = MachineState::Idle; break;
    case Halt::JogCancel:
      board_.flush_motion();
      board_.locked_until = board_.now + board_.executor.lock_delay();
      end_motion();
      break;
    case Halt::MotionCancel: board_.state = resting_state(); break;
    case Halt::Stop: finish_stop(); break;
    case Halt::Door: finish_retract(); break;
    case Halt::None: break;
  }
}

void Cycle::end_motion() {
  moving_ = false;
  board_.state = resting_state();
  if (std::exchange(holds_after_thread_, false)) pause();
}

void Cycle::stop() {
  if (board_.state == MachineState::Home) return;
  const bool moves = moving_ && board_.executor.phase() == ExecutorPhase::Running;
  if (moves) {
    halt(Halt::Stop);
  } else if (halt_ != Halt::None) {
    halt_ = Halt::Stop;
  } else {
    finish_stop();
  }
}

void Cycle::finish_stop() {
  board_.interpreter.stop();
  board_.flush_motion();
  board_.set_accessories({});
  board_.overrides.feed_acts = board_.overrides.spindle_acts = board_.overrides.feed_hold_acts = true;
  board_.apply_overrides();
  restoring_ = Restoring::No;
  restored_at_ = kNever;
  parking_.forget();
  drops_rest_ = false;
  board_.hold_complete = false;
  using vocabulary::AlarmCode;
  const auto code = static_cast<AlarmCode>(board_.alarm);
  const bool stays =
      board_.state == MachineState::Alarm &&
      (code == AlarmCode::HomingRequired || code == AlarmCode::LimitsEngaged || code == AlarmCode::ProbeProtect);
  if (stays) return;
  board_.state = MachineState::Idle;
  board_.alarm = 0;
  board_.report.accessories = true;
  board_.say(FeedbackText::Stop);
}

void Cycle::sleep() {
  board_.flush_motion();
  board_.state = MachineState::Sleep;
  if (!parking_.begin()) {
    switch_off();
    board_.say(FeedbackText::Sleeping);
    return;
  }
  moving_ = parking_.pull_out();
  if (!moving_) end_parking_leg();
}

void Cycle::start_jog() {
  if (board_.planner.is_empty() || board_.state == MachineState::Jog) return;
  board_.state = MachineState::Jog;
  moving_ = true;
  guard_limits();
  const int passes = board_.personality.loop.jog_to_start;
  board_.executor.cycle_start(board_.now, passes == 0 ? Duration::zero() : board_.until_pass(passes));
}

bool Cycle::kill() {
  const bool was_moving = moving_ || halt_ != Halt::None || board_.state == MachineState::Home;
  halt_ = Halt::None;
  restoring_ = Restoring::No;
  restored_at_ = kNever;
  to_restore_ = {};
  parking_.forget();
  moving_ = drops_rest_ = false;
  motion_ended_ = false;
  contacts_.clear();
  holds_after_thread_ = false;
  spindle_missed_at_ = kNever;
  board_.hold_complete = false;
  if (board_.motion_log && was_moving) board_.motion_log->ended(board_.now, board_.steps());
  board_.executor.reset(board_.now);
  return was_moving;
}

bool Cycle::is_suspended() const {
  switch (board_.state) {
    case MachineState::Hold:
      if (halt_ == Halt::SoftLimit) return false;
      return board_.hold_complete || !board_.personality.realtime.reads_while_slowing;
    case MachineState::Door: return true;
    case MachineState::Jog: return halt_ == Halt::JogCancel || halt_ == Halt::Stop;
    case MachineState::Tool: return !board_.tool_acknowledged;
    case MachineState::Sleep: return !board_.personality.reads_lines_in_sleep;
    default: return halt_ == Halt::Stop;
  }
}

bool Cycle::is_finished() const {
  return board_.planner.is_empty() && !moving_ && halt_ == Halt::None;
}

void Cycle::advance() {
  board_.executor.advance_to(board_.now);
  for (const motion::ExecutorEvent& event : board_.executor.take_events()) handle(event);
  if (restored_at_ <= board_.now) restore_next();
  if (spindle_missed_at_ <= board_.now) {
    spindle_missed_at_ = kNever;
    board_.raise_alarm(vocabulary::AlarmCode::SpindleAtSpeedTimeout);
  }
}

void Cycle::handle(const motion::ExecutorEvent& event) {
  std::visit(base::Overloaded{
                 [&](const motion::BlockStarted& started) {
                   if (board_.motion_log) {
                     // A cancel may have dropped the last segments of the block before.
                     if (halt_ != Halt::None) board_.motion_log->ended(started.at, board_.steps());
                     board_.motion_log->began(started.at);
                   }
                   board_.ports.block_began(started.source_line);
                   auto& messages = board_.motion_messages;
                   while (!messages.empty() && messages.front().block <= started.source_line) {
                     board_.say(protocol::Feedback{.text = messages.front().text});
                     messages.pop_front();
                   }
                 },
                 [&](const motion::BlockFinished& finished) {
                   if (board_.motion_log) board_.motion_log->ended(finished.at, finished.steps);
                 },
                 [&](const motion::MotionEnded&) {
                   if (parking_.leg() != Parking::Leg::None) {
                     end_parking_leg();
                     return;
                   }
                   motion_ended_ = true;
                   if (halt_ != Halt::None) {
                     come_to_rest();
                   } else if (board_.state == MachineState::Run || board_.state == MachineState::Jog) {
                     end_motion();
                   }
                 },
                 [&](const motion::HoldComplete& hold) {
                   if (board_.motion_log) board_.motion_log->ended(hold.stopped_at, board_.steps());
                   come_to_rest();
                 },
                 [&](const motion::ThresholdCrossed& contact) { contacts_.push_back(contact); },
             },
             event);
}

Instant Cycle::next_deadline() const {
  return std::min({board_.executor.next_deadline(), restored_at_, spindle_missed_at_});
}

}  // namespace kerf::firmware
