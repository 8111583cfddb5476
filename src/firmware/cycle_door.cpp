// The safety door: what is switched off while it is open, and how the machine comes back.
#include <algorithm>

#include "firmware/cycle.hpp"

namespace kerf::firmware {

using vocabulary::FeedbackText;

namespace {

// gnea/grbl config.h SAFETY_DOOR_SPINDLE_DELAY and SAFETY_DOOR_COOLANT_DELAY; the others have settings for them.
constexpr double kSpindleRestoreSeconds = 4.0;
constexpr double kCoolantRestoreSeconds = 1.0;
constexpr unsigned kKeepCoolantBit = 1;

double delay_s(const Board& board, int setting_id, double fallback) {
  return board.settings.find(std::to_string(setting_id)) != nullptr ? board.settings.number(setting_id) : fallback;
}

Duration restore_delay(const Board& board, double seconds) {
  const Duration delay = base::from_seconds(seconds);
  if (!board.personality.loop.restore_delays_take_passes) return delay;
  return delay + delay / board.planner.rules().dwell_step * board.personality.loop.pass;
}

}  // namespace

void Cycle::open_door() {
  switch (board_.state) {
    case MachineState::Alarm:
    case MachineState::Check:
    case MachineState::Sleep:
    case MachineState::Home: return;
    case MachineState::Door:
      if (board_.personality.realtime.door_again_ignored && board_.door != DoorPhase::Resuming &&
          !board_.workcell.is_active(Input::Door)) {
        return;
      }
      break;
    default: break;
  }
  board_.say(FeedbackText::CheckDoor);
  const bool was_door = board_.state == MachineState::Door;
  if (!was_door) to_restore_ = board_.accessories;
  restoring_ = Restoring::No;
  restored_at_ = kNever;
  board_.state = MachineState::Door;
  board_.door = DoorPhase::Retracting;
  const Parking::Leg leg = parking_.leg();
  const bool comes_back = leg == Parking::Leg::Return || leg == Parking::Leg::Plunge;
  if (leg != Parking::Leg::None && !comes_back) return;
  if (was_door) parking_.abort();
  // Outputs were coming back: the firmware says it once more when it turns round.
  if (was_door && !comes_back && parking_.is_away()) board_.say(FeedbackText::CheckDoor);
  if (comes_back) return;
  static_cast<void>(may_interrupt_cancel());
  if (moving_ && !was_door) {
    halt(Halt::Door);
  } else if (halt_ == Halt::None) {
    finish_retract();
  } else {
    halt_ = Halt::Door;
  }
}

void Cycle::finish_retract() {
  if (!parking_.begin()) {
    switch_off();
    board_.door = board_.workcell.is_active(Input::Door) ? DoorPhase::Ajar : DoorPhase::Closed;
    return;
  }
  moving_ = parking_.pull_out();
  if (!moving_) end_parking_leg();
}

void Cycle::end_parking_leg() {
  const Parking::Leg ended = parking_.leg();
  parking_.leg_ended();
  moving_ = false;
  switch (ended) {
    case Parking::Leg::None:  // there was nothing to pull out of
    case Parking::Leg::PullOut:
      // The reports that follow do not say so (grblHAL state_machine.c).
      if (board_.personality.has_extended_settings) board_.accessories = what_stays_on();
      board_.set_accessories(what_stays_on());
      moving_ = parking_.retreat();
      if (!moving_) rest_parked();
      break;
    case Parking::Leg::Retreat: rest_parked(); break;
    case Parking::Leg::Return: restore_next(); break;
    case Parking::Leg::Plunge: finish_door(); break;
    case Parking::Leg::Aborted: finish_retract(); break;
  }
}

Accessories Cycle::what_stays_on() const {
  const bool keeps_coolant = board_.state == MachineState::Door && board_.personality.has_extended_settings &&
                             board_.settings.flag(setting::kDoorOptions, kKeepCoolantBit);
  Accessories off;
  if (keeps_coolant) {
    off.flood = board_.accessories.flood;
    off.mist = board_.accessories.mist;
  }
  return off;
}

void Cycle::switch_off() {
  // Told even if everything was off already: all firmwares switch it off again (gnea/grbl protocol.c).
  board_.set_accessories(what_stays_on());
  board_.owe_accessories();
}

void Cycle::rest_parked() {
  if (board_.state == MachineState::Sleep) {
    board_.say(FeedbackText::Sleeping);
    return;
  }
  board_.door = board_.workcell.is_active(Input::Door) ? DoorPhase::Ajar : DoorPhase::Closed;
}

void Cycle::close_door() {
  if (board_.state == MachineState::Door && board_.door == DoorPhase::Ajar) board_.door = DoorPhase::Closed;
}

void Cycle::restore_next() {
  if (restoring_ == Restoring::Hold) {
    finish_resume(true);
    return;
  }
  Accessories wanted = board_.accessories;
  if (restoring_ == Restoring::No && to_restore_.is_spinning()) {
    restoring_ = Restoring::Spindle;
    wanted.spindle = to_restore_.spindle;
    wanted.programmed_rpm = to_restore_.programmed_rpm;
    board_.set_accessories(wanted);
    // A laser needs no time to come to its speed.
    const double wait_s =
        board_.planner.settings().laser_mode
            ? 0.0
            : delay_s(board_, board_.personality.realtime.door_spindle_setting, kSpindleRestoreSeconds);
    restored_at_ = board_.now + restore_delay(board_, wait_s);
    return;
  }
  if (restore_coolant()) return;
  restoring_ = Restoring::No;
  restored_at_ = kNever;
  moving_ = parking_.plunge();
  if (!moving_) finish_door();
}

bool Cycle::restore_coolant() {
  const RealtimeRules& rules = board_.personality.realtime;
  if (restoring_ == Restoring::Coolant || !(to_restore_.flood || to_restore_.mist)) return false;
  Accessories wanted = board_.accessories;
  // SourceRabbit/RabbitGRBL Coolant.cpp setState(): both come on, whichever it was, one after the other.
  const bool mist_first = rules.door_mist_setting != 0 && restoring_ != Restoring::Mist;
  const bool both = rules.door_mist_setting != 0;
  restoring_ = mist_first ? Restoring::Mist : Restoring::Coolant;
  wanted.mist = to_restore_.mist || both;
  wanted.flood = (to_restore_.flood || both) && !mist_first;
  board_.set_accessories(wanted);
  const int setting_id = mist_first ? rules.door_mist_setting : rules.door_coolant_setting;
  restored_at_ = board_.now + restore_delay(board_, delay_s(board_, setting_id, kCoolantRestoreSeconds));
  return true;
}

void Cycle::finish_door() {
  to_restore_ = {};
  parking_.forget();
  board_.door = DoorPhase::Closed;
  const int passes = board_.personality.loop.resume_to_start;
  run_or_idle_after(passes == 0 ? 0 : passes + 1);
}

}  // namespace kerf::firmware
