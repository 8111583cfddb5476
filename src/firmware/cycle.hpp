#pragma once
// The machine's state while it moves: cycle start, hold, resume, jog, cancel, stop, safety door, sleep.

#include <cstdint>
#include <vector>

#include "firmware/board.hpp"
#include "firmware/parking.hpp"

namespace kerf::firmware {

/// Owns the changes of `Board::state` that motion brings. Requests that the state does not allow are ignored, as the
/// firmwares do (protocol.md 2, 6.6, 6.8, 9.7).
class Cycle {
 public:
  explicit Cycle(Board& board) : board_(board), parking_(board) {}

  /// Runs queued motion if the machine is idle.
  void auto_start() { auto_start(0); }
  /// The same, but the main loop had nothing else to do.
  void auto_start_idle() { auto_start(board_.personality.loop.idle_to_start); }
  /// `~`: starts queued motion, ends a finished hold, resumes from a closed door.
  void cycle_start();
  /// `!`
  void feed_hold();
  /// Program pause: a hold with nothing moving.
  void pause();
  /// Stops a jog and drops what is left of it.
  void jog_cancel();
  /// The probe has touched: decelerate and become idle, in a hold when that ends.
  void cancel_motion();
  /// 0x19: decelerate, then forget everything; no alarm.
  void stop();
  /// The safety door opens (or 0x84 says so).
  void open_door();
  void close_door();
  void sleep();
  /// 0x9E: stops the spindle in a finished hold, or starts it again.
  void toggle_spindle_stop();
  /// A soft limit is ahead: decelerate and become idle.
  void stop_before_limit();
  void start_jog();
  /// Reset: stops dead. True if something was moving, so that the position is lost.
  bool kill();

  /// Lines wait, and so do the steps of the line being executed.
  [[nodiscard]] bool is_suspended() const;
  [[nodiscard]] bool is_decelerating() const { return halt_ != Halt::None; }
  /// 0x19 is still decelerating.
  [[nodiscard]] bool is_stopping() const { return halt_ == Halt::Stop; }
  /// Motion has come to rest and nothing is queued.
  [[nodiscard]] bool is_finished() const;

  /// Lets motion and delays go on to `board.now`; contacts and ends are kept for take_contacts() and
  /// system_motion_ended().
  void advance();
  [[nodiscard]] Instant next_deadline() const;
  [[nodiscard]] std::vector<motion::ThresholdCrossed> take_contacts() { return std::exchange(contacts_, {}); }
  /// True once after each motion that ended without being halted.
  [[nodiscard]] bool take_motion_ended() { return std::exchange(motion_ended_, false); }

 private:
  /// Why the machine is decelerating.
  enum class Halt : std::uint8_t { None, Hold, JogCancel, MotionCancel, Stop, Door, SoftLimit };
  enum class Restoring : std::uint8_t { No, Spindle, Mist, Coolant, Hold };

  void auto_start(int more_passes);
  void run_or_idle_after(int passes);
  void guard_limits();
  void handle(const motion::ExecutorEvent& event);
  void halt(Halt reason);
  bool may_interrupt_cancel();
  void come_to_rest();
  void end_motion();
  [[nodiscard]] MachineState resting_state() const {
    return board_.changes_tool ? MachineState::Tool : MachineState::Idle;
  }
  void resume();
  /// How long the motion at the front of the queue waits for the spindle; none if it waits in vain.
  [[nodiscard]] std::optional<Duration> wait_for_index() const;
  /// No index came, or the spindle stands.
  void miss_spindle();
  /// The motion may not be held before it ends.
  [[nodiscard]] bool cuts_thread() const;
  void run_or_idle(Duration after = Duration::zero());
  void finish_stop();
  void finish_retract();
  void end_parking_leg();
  void switch_off();
  /// Coolant, if the door may leave it on.
  [[nodiscard]] Accessories what_stays_on() const;
  void rest_parked();
  void restore_next();
  /// False if there is none left to switch on.
  bool restore_coolant();
  void finish_door();
  void finish_resume(bool was_stopped);

  Board& board_;
  Parking parking_;
  Halt halt_ = Halt::None;
  Restoring restoring_ = Restoring::No;
  Instant restored_at_ = kNever;
  Accessories to_restore_;
  bool motion_ended_ = false;
  bool moving_ = false;
  bool holds_after_thread_ = false;
  Instant spindle_missed_at_ = kNever;
  /// The probe has touched in a hold: what is left goes when the hold ends.
  bool drops_rest_ = false;
  std::vector<motion::ThresholdCrossed> contacts_;
};

}  // namespace kerf::firmware
