// What each step of the foreground does.

#include <algorithm>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "firmware/block_steps.hpp"
#include "firmware/foreground.hpp"

namespace kerf::firmware {

using vocabulary::AlarmCode;
using vocabulary::FeedbackText;

bool Foreground::operator()(Answer& step) {
  if (board_.memory.is_busy(board_.now)) {
    is_frozen_ = true;
    until_ = board_.memory.busy_until();
    return wait_for(WaitingFor::Time);
  }
  if (is_frozen_) {
    is_frozen_ = false;
    until_.reset();
  }
  last_error_ = step.code;
  in_line_ = false;
  // `O1 ERROR [254]`: the firmware's own mark of a line that somebody else answers. It latches and says ok.
  constexpr int kHandled = 254;
  const bool says_ok = step.code == ErrorCode::Ok || vocabulary::number_of(step.code) == kHandled;
  if (board_.job.is_read()) {
    if (says_ok) return true;
    board_.say(protocol::FileError{.code = vocabulary::number_of(step.code), .line = board_.job.line()});
    end_file_job();
  }
  if (says_ok) {
    board_.say(protocol::Ok{});
  } else {
    const int code = vocabulary::number_of(step.code);
    if (board_.settings.number("Errors/Verbose") == 0) {
      board_.say(protocol::ErrorAnswer{.code = code});
    } else {
      const auto* row = vocabulary::find_code(board_.personality.dialect().errors, code);
      board_.say(protocol::ErrorAnswer{.code = protocol::ErrorAnswer::kUnnumbered,
                                       .text = row != nullptr ? std::string{row->title} : std::to_string(code)});
    }
  }
  return true;
}

bool Foreground::operator()(Say& step) {
  board_.say(step.message);
  return true;
}

bool Foreground::operator()(SayStatus& /*step*/) {
  reporter_.say_status(receiver_.free());
  return true;
}

bool Foreground::operator()(SayProbe& /*step*/) {
  reporter_.say_probe();
  return true;
}

bool Foreground::check_travel(const AxisValues& target_mm) {
  if (!board_.guards_soft_limits() || board_.is_within_travel(target_mm)) return true;
  if (board_.state == MachineState::Check && !board_.personality.soft_limits_in_check) return true;
  steps_.clear();
  steps_.emplace_back(StopAtSoftLimit{});
  return false;
}

bool Foreground::has_planner_room() {
  if (!board_.planner.is_full()) return true;
  cycle_.auto_start();
  return !board_.planner.is_full();
}

bool Foreground::plan_when_room(const AxisValues& target_mm, const gcode::Feed& feed) {
  if (!turn_noted_) take_up_mm_ = board_.note_turn(target_mm);
  turn_noted_ = true;
  if (take_up_mm_) {
    if (!has_planner_room()) return false;
    board_.plan_take_up(*std::exchange(take_up_mm_, std::nullopt), feed);
  }
  if (!has_planner_room()) return false;
  board_.plan(target_mm, feed);
  turn_noted_ = false;
  return true;
}

bool Foreground::operator()(PlanMove& step) {
  if (cycle_.is_suspended()) return wait_for(WaitingFor::CycleStart);
  if (!check_travel(step.move.target_mm)) return true;
  if (board_.state == MachineState::Check) return true;
  const int blocks = board_.planner.block_count();
  if (!plan_when_room(step.move.target_mm, step.move.feed)) return wait_for(WaitingFor::PlannerRoom);
  // A steady laser gets its power at once where there is nothing to cut (gnea/grbl motion_control.c).
  const bool is_steady =
      board_.planner.settings().laser_mode && board_.accessories.spindle == gcode::SpindleDirection::Clockwise;
  if (board_.planner.block_count() == blocks && is_steady) {
    insert_front({Synchronize{}, Perform{.action = gcode::SpindleSpeedChange{.rpm = step.move.feed.spindle_rpm}}});
  }
  return true;
}

bool Foreground::operator()(PlanArc& step) {
  const gcode::ArcMove& move = step.move;
  if (!step.chords) {
    if (board_.personality.checks_whole_arcs && !check_travel(move.target_mm)) return true;
    if (board_.state == MachineState::Check && !board_.personality.soft_limits_in_check) return true;
    step.chords.emplace(motion::arc_of(move, step.start_mm), board_.planner.rules(), board_.planner.settings());
  }
  gcode::Feed feed = move.feed;
  if (feed.inverse_time && step.chords->inverse_time_factor() > 1) {
    feed.inverse_time = false;
    feed.rate_mm_per_min *= static_cast<float>(step.chords->inverse_time_factor());
  }
  for (;;) {
    if (!step.chord) step.chord = step.chords->next();
    if (!step.chord || !check_travel(*step.chord)) return true;
    if (board_.state != MachineState::Check) {
      if (cycle_.is_suspended()) return wait_for(WaitingFor::CycleStart);
      if (!plan_when_room(*step.chord, feed)) return wait_for(WaitingFor::PlannerRoom);
    }
    step.chord.reset();
  }
}

bool Foreground::operator()(PlanJog& step) {
  if (cycle_.is_suspended()) return wait_for(WaitingFor::CycleStart);
  if (!plan_when_room(step.move.target_mm, step.move.feed)) return wait_for(WaitingFor::PlannerRoom);
  board_.interpreter.sync_position(step.move.target_mm);
  cycle_.start_jog();
  return true;
}

bool Foreground::operator()(Synchronize& /*step*/) {
  // A tool change that is waited for in the same block has no motion before it.
  const bool waits = cycle_.is_suspended() && board_.state != MachineState::Tool;
  if (waits) return wait_for(WaitingFor::CycleStart);
  if (board_.state != MachineState::Check) cycle_.auto_start();
  return cycle_.is_finished() || wait_for(WaitingFor::MotionToFinish);
}

bool Foreground::operator()(Dwell& step) {
  if (board_.state == MachineState::Check) return true;
  if (cycle_.is_suspended()) {
    // The delay loop stands still in a hold (T:27).
    // What has begun of it goes on to its end.
    if (until_) step.left = *until_ - board_.now - (*until_ - board_.now) % board_.planner.rules().dwell_step;
    until_.reset();
    return wait_for(WaitingFor::CycleStart);
  }
  if (!until_) until_ = motion::dwell_end(board_.planner.rules(), board_.now, step.left);
  if (board_.now < *until_) return wait_for(WaitingFor::Time);
  until_.reset();
  return true;
}

bool Foreground::operator()(Freeze& step) {
  if (!step.until) step.until = until_ = motion::dwell_end(board_.planner.rules(), board_.now, step.duration);
  is_frozen_ = board_.now < *step.until;
  if (is_frozen_) return wait_for(WaitingFor::Time);
  until_.reset();
  return true;
}

bool Foreground::operator()(Perform& step) {
  const bool checks_only = board_.state == MachineState::Check;
  Accessories wanted = board_.accessories;
  std::visit(base::Overloaded{
                 [&](const gcode::SpindleChange& change) {
                   wanted.spindle = change.direction;
                   wanted.programmed_rpm = change.rpm;
                 },
                 [&](const gcode::SpindleSpeedChange& change) { wanted.programmed_rpm = change.rpm; },
                 [&](const gcode::CoolantChange& change) {
                   wanted.flood = change.flood;
                   wanted.mist = change.mist;
                 },
                 [&](const gcode::WorkOffsetChange&) { note_work_offset(); },
                 [&](const gcode::StoredOffsetWrite& write) {
                   board_.store_offset(write.which);
                   const auto selected = board_.interpreter.state().modal.work_offset;
                   if (write.which == static_cast<gcode::StoredOffset>(selected))
                     tool_change_.note_work_offset_stored();
                 },
                 [&](const gcode::ToolTableWrite& write) { board_.store_tool(write.tool); },
                 [&](const gcode::PortOutput& output) {
                   if (checks_only) return;
                   if (output.with_motion) {
                     board_.ports.set_with_block(board_.blocks_planned + 1, output);
                   } else {
                     board_.ports.set(output);
                   }
                 },
                 [&](const gcode::ToolSelect&) { board_.report.tool = true; },
                 [&](const gcode::OverrideControl& control) {
                   board_.overrides.feed_acts = control.feed_enabled;
                   board_.overrides.spindle_acts = control.spindle_enabled;
                   board_.overrides.feed_hold_acts = control.feed_hold_enabled;
                   board_.overrides.parking_acts = control.parking_enabled;
                   board_.apply_overrides();
                 },
                 [&](const gcode::ProgramDemarcation&) { board_.in_demarcated_program ^= true; },
                 [&](const gcode::ProgramEnd& end) {
                   board_.in_demarcated_program = false;
                   wanted = {};
                   if (!checks_only) {
                     note_work_offset();
                     board_.owe_accessories();
                     if (end.restores_overrides) restore_overrides();
                   }
                   if (board_.job.is_read()) end_file_job();
                 },
                 [](const auto&) {},
             },
             step.action);
  Steps after;
  const auto* coolant = std::get_if<gcode::CoolantChange>(&step.action);
  const Duration pause = board_.switching_pause(wanted, coolant != nullptr && coolant->waits);
  if (!checks_only && pause > Duration::zero()) after.emplace_back(Freeze{.duration = pause});
  if (std::holds_alternative<gcode::ProgramEnd>(step.action)) {
    after.emplace_back(Say{.message = protocol::Feedback{.text = std::string{vocabulary::feedback_text(
                                                             board_.personality.firmware, FeedbackText::ProgramEnd)}}});
  }
  if (!checks_only && coolant != nullptr && board_.personality.status.coolant_on_is_untold) {
    board_.accessories = wanted;
    if (!wanted.flood && !wanted.mist) board_.owe_accessories();
  } else if (!checks_only) {
    board_.set_accessories(wanted);
  }
  insert_front(std::move(after));
  return true;
}

void Foreground::note_work_offset() {
  board_.owe_work_offset();
  if (const std::uint8_t selected = board_.interpreter.state().modal.work_offset; selected != last_work_offset_) {
    last_work_offset_ = selected;
    board_.report.work_coordinate_system = true;
  }
  const AxisValues& length = board_.interpreter.offsets().tool_length;
  if (length != last_tool_length_) board_.report.tool_offset = true;
  last_tool_length_ = length;
}

void Foreground::restore_overrides() {
  board_.overrides = {};
  board_.apply_overrides();
  board_.owe_overrides();
}

bool Foreground::operator()(HoldForCycleStart& step) {
  if (board_.state == MachineState::Check) return true;
  if (!step.begun) {
    step.begun = true;
    cycle_.pause();
  }
  return board_.state != MachineState::Hold || wait_for(WaitingFor::CycleStart);
}

bool Foreground::begin_probe(Probe& step) {
  if (board_.state == MachineState::Check) return true;
  gcode::Offsets& offsets = board_.interpreter.offsets();
  offsets.probe_succeeded = false;
  if (board_.personality.probe_begins_at_target) offsets.probe = board_.to_mm(board_.to_steps(step.move.target_mm));
  const bool triggered = board_.probe_triggered() != step.move.away;
  if (triggered || board_.workcell.is_active(Input::ProbeDisconnected)) {
    board_.interpreter.sync_position(step.move.start_mm);
    insert_front({RaiseAlarm{.code = AlarmCode::ProbeFailInitial}});
    return true;
  }
  if (!check_travel(step.move.target_mm)) return true;
  static_cast<void>(plan_when_room(step.move.target_mm, step.move.feed));  // the queue is empty
  static_cast<void>(cycle_.take_contacts());
  if (const auto surface =
          board_.workcell.surface_step(board_.executor.motor_steps_at(board_.now), board_.geometry())) {
    board_.executor.watch({.axis = vocabulary::Axis::Z,
                           .steps = step.move.away ? *surface + 1 : *surface,
                           .above = step.move.away,
                           .seen_by_step_interrupt = true});
  }
  board_.probing = true;
  step.phase = Probe::Phase::Moving;
  cycle_.auto_start();
  return false;
}

bool Foreground::operator()(Probe& step) {
  if (step.phase == Probe::Phase::Check) {
    if (begin_probe(step)) return true;
  }
  const auto rests = [this] { return board_.state == MachineState::Idle || board_.state == MachineState::Tool; };
  if (step.phase == Probe::Phase::Moving) {
    const auto contacts = cycle_.take_contacts();
    const bool touched = !contacts.empty() || board_.probe_triggered() != step.move.away;
    if (touched) {
      contact_ = contacts.empty() ? board_.steps() : contacts.front().steps;
      step.phase = Probe::Phase::Cancelling;
      cycle_.cancel_motion();
    } else if (cycle_.is_finished() && rests()) {
      return finish_probe(board_.steps(), false, step.move);
    }
  }
  if (step.phase == Probe::Phase::Cancelling && !cycle_.is_decelerating() && rests()) {
    return finish_probe(contact_, true, step.move);
  }
  return wait_for(WaitingFor::Contact);
}

bool Foreground::finish_probe(const AxisSteps& contact, bool touched, const gcode::ProbeMove& move) {
  board_.probing = false;
  board_.executor.clear_watches();
  board_.flush_motion();
  board_.backlash.stand_at(board_.position_mm());
  gcode::Offsets& offsets = board_.interpreter.offsets();
  offsets.probe = board_.to_mm(contact);
  offsets.probe_succeeded = touched;
  offsets.probe_work_offset = board_.interpreter.state().modal.work_offset;
  const bool tells =
      !board_.personality.status.counts_changes || board_.reports(vocabulary::ReportBit::ProbeCoordinates);
  Steps next;
  if (!touched && !move.no_error) next.emplace_back(RaiseAlarm{.code = AlarmCode::ProbeFailContact});
  if (const Duration lock = board_.executor.lock_delay(); lock > Duration::zero()) {
    next.emplace_back(Freeze{.duration = lock, .until = std::nullopt});
  }
  if (tells) next.emplace_back(SayProbe{});
  insert_front(std::move(next));
  return true;
}

bool Foreground::operator()(WaitForInput& step) {
  if (board_.state == MachineState::Check) return true;
  if (cycle_.is_suspended()) return wait_for(WaitingFor::CycleStart);
  const float value = board_.workcell.port_input(step.wait.digital, step.wait.port);
  const bool first = !step.until;
  if (first) {
    step.before = value;
    step.until = board_.now + base::from_seconds(static_cast<double>(step.wait.timeout_s));
  }
  const bool is_on = value != 0.0F;
  const bool was_on = std::exchange(step.before, value) != 0.0F;
  bool met = false;
  switch (step.wait.mode) {
    case gcode::WaitMode::Immediate: met = true; break;
    case gcode::WaitMode::Rise: met = is_on && !was_on; break;
    case gcode::WaitMode::Fall: met = was_on && !is_on; break;
    case gcode::WaitMode::High: met = is_on; break;
    case gcode::WaitMode::Low: met = !is_on; break;
  }
  if (!met && board_.now < *step.until) {
    until_ = step.until;
    return wait_for(WaitingFor::Time);
  }
  until_.reset();
  board_.input_result = met ? static_cast<int>(value) : -1;
  board_.report.input_result = true;
  return true;
}

bool Foreground::operator()(HomeAxes& step) {
  while (!step.cycles.empty()) {
    if (!step.begun) homing_.begin(step.cycles.front());
    step.begun = true;
    switch (homing_.advance()) {
      case Homing::Outcome::Moving: return wait_for(WaitingFor::Contact);
      case Homing::Outcome::SwitchNotFound: fail(AlarmCode::HomingFailApproach); return true;
      case Homing::Outcome::SwitchStuck: fail(AlarmCode::HomingFailPulloff); return true;
      case Homing::Outcome::Done: break;
    }
    step.cycles.pop_front();
    step.begun = false;
  }
  return true;
}

bool Foreground::operator()(FinishHoming& step) {
  board_.sync_position();
  board_.backlash.forget(board_.position_mm());
  if (status_wanted_) reporter_.say_status(receiver_.free());
  status_wanted_ = false;
  board_.state = MachineState::Idle;
  board_.locked_until = board_.now + board_.executor.lock_delay();
  board_.position_lost = false;
  board_.report.homed = true;
  const HomingRules& rules = board_.personality.homing;
  const AxisMask wanted = board_.homing_axes();
  const bool all_homed = (wanted & board_.homed) == wanted;
  const bool measures = board_.settings.number(setting::kToolChangeMode) != 0;
  if (rules.tracks_axes && measures && (step.asked == 0 || step.asked == vocabulary::mask_of(vocabulary::Axis::Z)) &&
      board_.tool_reference_axes != 0) {
    board_.tool_reference_axes = 0;
    board_.report.tool_reference = true;
  }
  if (rules.announces) board_.say(protocol::Feedback{});
  if (rules.tracks_axes ? all_homed : step.asked == 0) {
    insert_front({RunStartupLines{}});
  } else if (homing_is_required(board_)) {
    board_.alarm = vocabulary::number_of(AlarmCode::HomingRequired);
    board_.state = MachineState::Alarm;
  }
  return true;
}

bool Foreground::operator()(RaiseAlarm& step) {
  const bool is_news = board_.raise_alarm(step.code);
  const auto* row = vocabulary::find_code(board_.personality.dialect().alarms, vocabulary::number_of(step.code));
  if (step.by_program && row != nullptr && row->critical) board_.critical = true;
  if (is_news) insert_front({Freeze{.duration = board_.personality.dialect().alarm_delay, .until = std::nullopt}});
  return true;
}

bool Foreground::operator()(StopAtSoftLimit& step) {
  if (!step.begun) {
    step.begun = true;
    cycle_.stop_before_limit();
  }
  if (cycle_.is_decelerating()) return wait_for(WaitingFor::MotionToFinish);
  enter_critical_alarm(AlarmCode::SoftLimit);
  return true;
}

bool Foreground::operator()(EnterCritical& /*step*/) {
  board_.critical = true;
  if (board_.personality.dialect().critical_alarm_answers_lines) {
    receiver_.clear();
    reader_.clear();
    in_line_ = false;
  }
  return true;
}

bool Foreground::operator()(EnterSleep& /*step*/) {
  cycle_.sleep();
  return true;
}

}  // namespace kerf::firmware
