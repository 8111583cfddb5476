#include "firmware/foreground.hpp"

#include <algorithm>
#include <chrono>

#include "firmware/block_steps.hpp"
#include "firmware/listing.hpp"

namespace kerf::firmware {

using vocabulary::AlarmCode;
using vocabulary::FeedbackText;

namespace {

/// What a jump in a file takes, so that a loop without motion cannot stop the clock: the card looks for the place.
constexpr std::chrono::microseconds kSeekTime{100};

}  // namespace

void Foreground::power_on() {
  const StartRules& rules = board_.personality.start;
  if (!board_.stored.initialised) {
    if (rules.blank_memory_error) {
      board_.say(protocol::ErrorAnswer{.code = vocabulary::number_of(ErrorCode::SettingReadFail)});
    }
    board_.store_settings();
    if (rules.blank_memory_lists_settings) Listing{board_}.settings();
  }
  board_.cold_start = true;
  if (rules.homing_locks && board_.settings.flag(setting::kHoming)) board_.state = MachineState::Alarm;
  if (const Duration interval = auto_report_interval(); interval > Duration::zero()) {
    next_auto_report_ = board_.now + interval;
  }
  steps_.emplace_back(Restart{});
  run();
}

void Foreground::run() {
  for (;;) {
    waiting_for_ = WaitingFor::Nothing;
    if (board_.is_locked()) return;
    if (!steps_.empty()) {
      if (!advance_front()) break;
    } else if (!read_line()) {
      break;
    }
  }
  if (board_.now >= next_auto_report_) {
    // Started at power-up, it takes over a new period by itself, and ends for good when there is none.
    const Duration interval = auto_report_interval();
    next_auto_report_ = interval > Duration::zero() ? board_.now + interval : kNever;
    if (board_.auto_reporting) status_wanted_ = true;
  }
  watch_for_sleep();
  say_wanted_status();
}

Duration Foreground::auto_report_interval() const {
  return std::chrono::milliseconds{static_cast<std::int64_t>(board_.settings.number(setting::kAutoReport))};
}

// grblHAL sleep.c: with `$62` five minutes of rest with spindle or coolant on, unless somebody asks something.
void Foreground::watch_for_sleep() {
  constexpr std::chrono::minutes kUntilSleep{5};
  const Accessories& on = board_.accessories;
  const bool powered = on.spindle != gcode::SpindleDirection::Off || on.flood || on.mist;
  const bool rests = board_.state == MachineState::Idle ||
                     (board_.state == MachineState::Hold && board_.hold_complete) ||
                     (board_.state == MachineState::Door && board_.door == DoorPhase::Ajar);
  // Asked last, because looking up a setting takes longer than everything else here.
  const bool may_sleep = powered && rests && board_.personality.sleep_needs_setting && !board_.auto_reporting &&
                         board_.settings.flag(setting::kSleepEnable);
  if (!may_sleep) {
    asleep_at_ = kNever;
  } else if (asleep_at_ == kNever) {
    asleep_at_ = board_.now + kUntilSleep;
  } else if (board_.now >= asleep_at_) {
    asleep_at_ = kNever;
    cycle_.sleep();
  }
}

void Foreground::settle() {
  run();
  if (steps_.empty()) {
    cycle_.auto_start_idle();
    run();
  }
}

bool Foreground::advance_front() {
  Step step = std::move(steps_.front());
  steps_.pop_front();
  if (std::visit(*this, step)) return true;
  steps_.push_front(std::move(step));
  return false;
}

bool Foreground::wait_for(WaitingFor what) {
  waiting_for_ = what;
  return false;
}

void Foreground::insert_front(Steps steps) {
  steps_.insert(steps_.begin(), std::make_move_iterator(steps.begin()), std::make_move_iterator(steps.end()));
}

bool Foreground::reads_lines() const {
  if (cycle_.is_suspended()) return false;
  return !board_.critical || board_.personality.dialect().critical_alarm_answers_lines;
}

bool Foreground::read_line() {
  while (reads_lines()) {
    const auto byte = next_byte();
    if (!byte) break;
    if (*byte == Receiver::kCancelMark) {
      reader_.clear();
      last_error_ = ErrorCode::Ok;
      cycle_.jog_cancel();
      continue;
    }
    if (const auto line = reader_.push(*byte)) {
      begin_line(*line);
      return true;
    }
  }
  return false;
}

bool Foreground::locks_gcode() const {
  switch (board_.state) {
    case MachineState::Alarm:
    case MachineState::Jog:
    case MachineState::Sleep: return true;
    default: return board_.critical;
  }
}

void Foreground::begin_line(const gcode::ReadLine& line) {
  in_line_ = true;
  ++board_.lines_read;
  if (!line.text.empty() && line.text.front() != '$') ++board_.blocks_begun;
  board_.be_busy(board_.personality.loop.for_line);
  if (line.overlong) {
    steps_.emplace_back(Answer{.code = ErrorCode::LineTooLong});
  } else if (line.text.empty()) {
    steps_.emplace_back(Answer{});
  } else if (line.text.front() == '$' || (line.text.front() == '[' && board_.personality.names_settings)) {
    const std::string_view text = line.text;
    const auto result = commands_.execute(board_.personality.names_settings ? text : text.substr(1), steps_);
    if (result) return;
    if (result.error() == ErrorCode::LimitsEngaged) {
      steps_.insert(steps_.end(),
                    {RaiseAlarm{.code = AlarmCode::LimitsEngaged},
                     Say{.message = protocol::Feedback{.text = std::string{vocabulary::feedback_text(
                                                           board_.personality.firmware, FeedbackText::CheckLimits)}}}});
    }
    steps_.emplace_back(Answer{.code = result.error()});
  } else if (locks_gcode()) {
    const bool is_demarcation =
        line.text == "%" && board_.personality.dialect().percent_rule == vocabulary::PercentRule::ProgramToggle;
    steps_.emplace_back(Answer{.code = is_demarcation ? ErrorCode::Ok : ErrorCode::SystemLocked});
  } else {
    execute_block(line.text);
  }
}

void Foreground::execute_block(std::string_view text) {
  const bool latched = board_.personality.dialect().error_latch && last_error_ != ErrorCode::Ok &&
                       last_error_ != ErrorCode::ToolChangePending;
  if (latched) {
    steps_.emplace_back(Answer{.code = last_error_});
    return;
  }
  FileJob& job = board_.job;
  const bool has_file = job.is_read() && !job.is_drained();
  board_.interpreter.settings().file_line = has_file ? job.line() : 0;
  board_.interpreter.settings().file_position = has_file ? std::optional(job.position()) : std::nullopt;
  const std::int32_t line_before = board_.interpreter.state().line_number;
  const auto result = add_block_steps(board_, text, steps_);
  if (!result) reader_.block_failed();
  // An N word moves the count of the file's lines (fs_stream.c onLineNumberAssigned).
  const std::int32_t line = board_.interpreter.state().line_number;
  if (job.is_read() && line != line_before && line != 0) job.set_line(line);
  if (const auto jump = board_.interpreter.take_file_jump()) {
    job.go_to(jump->position, jump->line);
    steps_.emplace_back(Freeze{.duration = kSeekTime});
  }
  steps_.emplace_back(Answer{.code = result ? ErrorCode::Ok : result.error()});
}

bool Foreground::is_program_end(const Step& step) {
  const auto* perform = std::get_if<Perform>(&step);
  return perform != nullptr && std::holds_alternative<gcode::ProgramEnd>(perform->action);
}

Say Foreground::saying_program_end() const {
  return {.message = protocol::Feedback{
              .text = std::string{vocabulary::feedback_text(board_.personality.firmware, FeedbackText::ProgramEnd)}}};
}

void Foreground::append_steps(Steps steps) {
  steps_.insert(steps_.end(), std::make_move_iterator(steps.begin()), std::make_move_iterator(steps.end()));
}

void Foreground::reset() {
  const auto restarts = [](const Step& step) { return std::holds_alternative<Restart>(step); };
  if (std::ranges::any_of(steps_, restarts)) return;
  const bool homes = board_.state == MachineState::Home;
  const bool moved = cycle_.kill();
  homing_.abandon();
  board_.set_accessories({});
  board_.position_lost = board_.position_lost || moved;
  const bool ends_program = std::ranges::any_of(steps_, is_program_end);
  board_.outbox.say_bytes(board_.upload.abort());
  steps_.clear();
  until_.reset();
  is_frozen_ = false;
  status_wanted_ = false;
  receiver_.forget_aside();
  receiver_.clear();
  if (moved) steps_.emplace_back(RaiseAlarm{.code = homes ? AlarmCode::HomingFailReset : AlarmCode::AbortCycle});
  append_steps(interrupted_file());
  if (ends_program && board_.personality.interrupted_program_ends) steps_.emplace_back(saying_program_end());
  if (in_line_ && board_.personality.dialect().failed_line_answers_across_reset) steps_.emplace_back(Answer{});
  steps_.emplace_back(Restart{});
}

void Foreground::fail(AlarmCode code) {
  cycle_.kill();
  homing_.abandon();
  board_.set_accessories({});
  board_.position_lost = true;
  steps_.clear();
  steps_.emplace_back(RaiseAlarm{.code = code});
  append_steps(interrupted_file());
  if (in_line_ && board_.personality.dialect().failed_line_answers_across_reset) steps_.emplace_back(Answer{});
  steps_.emplace_back(Restart{});
}

void Foreground::enter_critical_alarm(AlarmCode code) {
  cycle_.kill();
  homing_.abandon();
  board_.set_accessories({});
  steps_.clear();
  until_.reset();
  const auto text = code == AlarmCode::EmergencyStop && board_.personality.start.has_homing_alarm
                        ? FeedbackText::EmergencyStop
                        : FeedbackText::ResetToContinue;
  steps_.emplace_back(RaiseAlarm{.code = code});
  append_steps(interrupted_file());
  steps_.insert(steps_.end(), {Say{.message = protocol::Feedback{.text = std::string{vocabulary::feedback_text(
                                                                     board_.personality.firmware, text)}}},
                               EnterCritical{}});
}

void Foreground::abandon_line() {
  const bool ends_program = std::ranges::any_of(steps_, is_program_end);
  steps_.clear();
  board_.outbox.say_bytes(board_.upload.abort());
  if (board_.job.is_running()) {
    board_.say(protocol::Feedback{.text = file_interruption()});
    end_file_job();
  }
  if (ends_program && board_.personality.interrupted_program_ends) {
    steps_.insert(steps_.end(), {Synchronize{}, saying_program_end()});
  }
  until_.reset();
  is_frozen_ = false;
  in_line_ = false;
  homing_.abandon();
  tool_change_.abandon();
  board_.probing = false;
  receiver_.forget_aside();
  receiver_.cancel();
}

void Foreground::open_door() {
  if (board_.state == MachineState::Home) {
    fail(AlarmCode::HomingFailDoor);
  } else {
    cycle_.open_door();
  }
}

void Foreground::open_door_by_switch() {
  if (board_.personality.has_extended_settings) {
    const bool at_rest = board_.state == MachineState::Idle || board_.state == MachineState::Jog;
    const bool ignored = at_rest && board_.settings.flag(setting::kDoorOptions);
    if (ignored || board_.changes_tool) return;
  }
  open_door();
}

void Foreground::emergency_stop() {
  // Only grblHAL has the input (alarms.h).
  if (!board_.personality.start.has_homing_alarm) return;
  board_.position_lost = board_.position_lost || !cycle_.is_finished();
  enter_critical_alarm(AlarmCode::EmergencyStop);
}

void Foreground::request_status(bool everything) {
  status_wanted_ = true;
  if (everything) board_.report.everything = true;
  say_wanted_status();
}

bool Foreground::answers_status() const {
  const StatusRules& rules = board_.personality.status;
  if (rules.at_once) return true;
  if (is_frozen_ || board_.is_locked() || (board_.critical && !rules.when_critical)) return false;
  if (board_.state != MachineState::Home || !homing_.is_active()) return true;
  return board_.personality.homing.tracks_axes && board_.reports(vocabulary::ReportBit::ReportWhenHoming);
}

void Foreground::say_wanted_status() {
  status_wanted_ = status_wanted_ || board_.owes_status;
  if (!status_wanted_ || !answers_status()) return;
  status_wanted_ = board_.owes_status = false;
  reporter_.say_status(receiver_.free());
}

void Foreground::look_at_switches() {
  homing_.look_at_switches();
  if (!board_.guards_hard_limits()) return;
  const AxisMask limits = board_.limits();
  const auto fresh = static_cast<AxisMask>(limits & ~last_limits_);
  last_limits_ = limits;
  const bool ignores = board_.state == MachineState::Alarm || board_.state == MachineState::Home;
  if (fresh == 0 || ignores) return;
  board_.position_lost = true;
  board_.homed = 0;
  board_.last_limits = fresh;
  enter_critical_alarm(AlarmCode::HardLimit);
}

Receiver::LineContext Foreground::line_context() const {
  const bool drops_text = board_.job.is_read();
  if (!board_.personality.keeps_special_bytes || !reader_.keeps_realtime_characters()) {
    return {.drops_text = drops_text};
  }
  return {.keeps_high_bytes = true,
          .keeps_printable_commands = !board_.settings.flag(setting::kLegacyRealtime),
          .drops_text = drops_text};
}

Instant Foreground::next_deadline() const {
  Instant deadline = std::min(homing_.next_deadline(), next_auto_report_);
  if (until_) deadline = std::min(deadline, *until_);
  if (board_.locked_until > board_.now) deadline = std::min(deadline, board_.locked_until);
  deadline = std::min(deadline, asleep_at_);
  return deadline;
}

}  // namespace kerf::firmware
