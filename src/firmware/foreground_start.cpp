// How the foreground begins anew: after power-up and after every reset (protocol.md 1.1, 1.2).

#include "common/base/text.hpp"
#include "firmware/block_steps.hpp"
#include "firmware/foreground.hpp"

namespace kerf::firmware {

using vocabulary::AlarmCode;
using vocabulary::FeedbackText;

namespace {

// Bits of grblHAL's $676.
constexpr unsigned kClearHomed = 0;
constexpr unsigned kClearRapidOverride = 2;
constexpr unsigned kClearFeedOverride = 3;
constexpr unsigned kHardLimitsStrict = 1;
constexpr unsigned kParkingOffAtStart = 1;

Say saying(const Board& board, FeedbackText text) {
  return {.message =
              protocol::Feedback{.text = std::string{vocabulary::feedback_text(board.personality.firmware, text)}}};
}

}  // namespace

void Foreground::owe_first_report() {
  board_.report = {};
  if (board_.personality.status.counts_changes) {
    board_.report.overrides = board_.report.accessories = board_.report.tool_reference = true;
  }
  // Every reset switches them on, also if no clock runs because the period is newer than the last power-up
  // (grblHAL grbllib.c).
  board_.auto_reporting = auto_report_interval() > Duration::zero();
}

bool Foreground::operator()(Restart& /*step*/) {
  const bool has_actions = board_.personality.start.has_reset_actions && !board_.cold_start;
  const OverrideState before = board_.overrides;
  board_.overrides = {};
  if (has_actions && !board_.settings.flag(setting::kResetActions, kClearFeedOverride)) {
    board_.overrides.feed = before.feed;
  }
  if (has_actions && !board_.settings.flag(setting::kResetActions, kClearRapidOverride)) {
    board_.overrides.rapid = before.rapid;
  }
  if (board_.position_lost && board_.settings.flag(setting::kResetActions, kClearHomed)) board_.homed = 0;
  board_.overrides.parking_acts = !board_.settings.flag(setting::kParking, kParkingOffAtStart);
  board_.position_lost = false;
  board_.switches = {};
  board_.probing = false;
  board_.critical = false;
  board_.in_demarcated_program = false;
  board_.tool_acknowledged = false;
  board_.input_result.reset();
  board_.ports.forget_waiting();
  board_.hold_complete = false;
  cycle_.kill();
  receiver_.forget_aside();
  receiver_.clear();
  reader_.clear();
  last_error_ = ErrorCode::Ok;
  in_line_ = false;
  last_limits_ = board_.limits();

  tool_change_.abandon();
  board_.interpreter.settings().check_mode = false;
  board_.interpreter.reset();
  board_.interpreter.offsets().probe = {};
  board_.interpreter.offsets().probe_succeeded = false;
  board_.flush_motion();
  board_.backlash.forget(board_.position_mm());
  turn_noted_ = false;
  take_up_mm_.reset();
  board_.apply_settings();
  board_.apply_overrides();
  board_.set_accessories({});
  owe_first_report();
  last_work_offset_ = board_.interpreter.state().modal.work_offset;
  last_tool_length_ = board_.interpreter.offsets().tool_length;
  if (board_.state != MachineState::Alarm && board_.state != MachineState::Sleep) board_.state = MachineState::Idle;

  const vocabulary::Dialect& dialect = board_.personality.dialect();
  board_.say(protocol::Welcome{
      .firmware = dialect.firmware, .version = std::string{dialect.version}, .line = std::string{dialect.welcome}});
  insert_front({CheckAtStart{}});
  return true;
}

bool Foreground::operator()(CheckAtStart& /*step*/) {
  if (board_.personality.start.has_homing_alarm) {
    check_at_start_grblhal();
  } else {
    check_at_start_grbl();
  }
  board_.cold_start = false;
  // grblHAL grbllib.c: whoever can hand over command tells who has it.
  if (board_.equipment.pendant && (board_.pendant_commands || !board_.auto_reporting)) {
    request_status(board_.pendant_commands);
  }
  return true;
}

void Foreground::check_at_start_grbl() {
  const StartRules& rules = board_.personality.start;
  if (rules.limits_lock && board_.settings.flag(setting::kHardLimits) && board_.limits() != 0) {
    board_.state = MachineState::Alarm;
    board_.say(FeedbackText::CheckLimits);
  }
  if (board_.state == MachineState::Alarm || board_.state == MachineState::Sleep) {
    board_.state = MachineState::Alarm;
    board_.say(FeedbackText::UnlockRequired);
    return;
  }
  if (board_.workcell.is_active(Input::Door)) cycle_.open_door();
  insert_front({RunStartupLines{}});
}

void Foreground::check_at_start_grblhal() {
  const auto& settings = board_.settings;
  const bool strict_limits =
      settings.flag(setting::kHardLimits) && settings.flag(setting::kHardLimits, kHardLimitsStrict);
  if (board_.workcell.is_active(Input::EmergencyStop)) {
    enter_critical_alarm(AlarmCode::EmergencyStop);
  } else if (homing_is_required(board_)) {
    insert_front({RaiseAlarm{.code = AlarmCode::HomingRequired}, saying(board_, FeedbackText::HomingRequired)});
  } else if (strict_limits && board_.limits() != 0) {
    insert_front({RaiseAlarm{.code = AlarmCode::LimitsEngaged}, saying(board_, FeedbackText::CheckLimits)});
  } else if (board_.cold_start &&
             (settings.flag(setting::kForceInitAlarm) || board_.workcell.is_active(Input::Reset))) {
    board_.state = MachineState::Alarm;
    board_.say(FeedbackText::UnlockRequired);
  } else if (board_.state == MachineState::Alarm || board_.state == MachineState::Sleep) {
    if (board_.alarm == vocabulary::number_of(AlarmCode::HomingRequired)) board_.alarm = 0;
    board_.state = MachineState::Alarm;
    board_.say(FeedbackText::UnlockRequired);
  } else {
    const bool door_counts = !settings.flag(setting::kDoorOptions);
    if (door_counts && board_.workcell.is_active(Input::Door)) cycle_.open_door();
    if (!settings.flag(setting::kHoming, homing_bit::kStartupLinesWhenHomed)) insert_front({RunStartupLines{}});
  }
}

bool Foreground::operator()(RunStartupLines& /*step*/) {
  if (cycle_.is_suspended()) return wait_for(WaitingFor::CycleStart);
  Steps blocks;
  for (const std::string& line : board_.stored.startup_lines) {
    const auto parts =
        board_.personality.start.startup_blocks_split ? base::split(line, '|') : std::vector<std::string_view>{line};
    for (const std::string_view block : parts) {
      if (!block.empty()) blocks.emplace_back(RunStartupBlock{.block = std::string{block}});
    }
  }
  insert_front(std::move(blocks));
  return true;
}

bool Foreground::operator()(KeepStartupLine& step) {
  board_.stored.startup_lines.at(step.index) = std::move(step.line);
  board_.store_settings();
  return true;
}

bool Foreground::operator()(RunStartupBlock& step) {
  Steps steps;
  const auto result = add_block_steps(board_, step.block, steps);
  const int code = result ? 0 : vocabulary::number_of(result.error());
  steps.emplace_back(Say{.message = protocol::StartupResult{.block = step.block, .error_code = code}});
  insert_front(std::move(steps));
  return true;
}

}  // namespace kerf::firmware
