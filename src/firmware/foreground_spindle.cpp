// Steps of lines that wait for the spindle, or follow it (grblHAL with an encoder).

#include <variant>

#include "firmware/foreground.hpp"

namespace kerf::firmware {

using vocabulary::AlarmCode;

bool Foreground::operator()(WaitForSpindle& step) {
  // grblHAL/core spindle_control.c: it looks after each of these.
  constexpr std::chrono::milliseconds kLook{200};
  if (board_.state == MachineState::Check) return true;
  if (!step.until) step.until = board_.now + kLook;
  until_ = step.until;
  if (board_.now < *step.until) return wait_for(WaitingFor::Time);
  step.waited += kLook;
  if (step.waited > step.limit) {
    until_.reset();
    board_.interpreter.stop_spindle();
    Accessories wanted = board_.accessories;
    wanted.spindle = gcode::SpindleDirection::Off;
    wanted.programmed_rpm = 0;
    board_.set_accessories(wanted);
    insert_front({RaiseAlarm{.code = AlarmCode::SpindleAtSpeedTimeout}});
    return true;
  }
  if (!board_.is_spindle_at_speed()) {
    until_ = step.until = board_.now + kLook;
    return wait_for(WaitingFor::Time);
  }
  until_.reset();
  return true;
}

// grblHAL/core gcode.c init_sync_motion.
bool Foreground::operator()(BeginThread& step) {
  if (board_.state == MachineState::Check) return true;
  constexpr float kShareOfMaxRate = 0.9F;
  constexpr std::size_t kZ = 2;
  overrides_before_thread_ = board_.overrides;
  board_.overrides.spindle = 100;
  board_.overrides.feed_acts = board_.overrides.spindle_acts = false;
  board_.apply_overrides();
  const float rate = step.pitch_mm * static_cast<float>(board_.encoder.rpm());
  const float most = board_.planner.settings().max_rate_mm_per_min.at(kZ) * kShareOfMaxRate;
  if (rate != 0.0F && rate <= most) return true;
  board_.interpreter.sync_position(step.start_mm);
  give_up_line(rate == 0.0F ? ErrorCode::SpindleNotRunning : ErrorCode::MaxFeedRateExceeded);
  return true;
}

bool Foreground::operator()(EndThread& /*step*/) {
  if (!overrides_before_thread_) return true;
  board_.overrides.feed_acts = overrides_before_thread_->feed_acts;
  board_.overrides.spindle_acts = overrides_before_thread_->spindle_acts;
  overrides_before_thread_.reset();
  board_.apply_overrides();
  return true;
}

void Foreground::give_up_line(ErrorCode code) {
  while (!steps_.empty() && !std::holds_alternative<Answer>(steps_.front())) steps_.pop_front();
  if (!steps_.empty()) std::get<Answer>(steps_.front()).code = code;
}

}  // namespace kerf::firmware
