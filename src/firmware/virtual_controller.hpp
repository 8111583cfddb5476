#pragma once
// A controller that is not there: the firmware side of the wire as a value that is fed bytes and time.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "firmware/equipment.hpp"
#include "firmware/motion_log.hpp"
#include "firmware/personality.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/workcell.hpp"

namespace kerf::firmware {

/// Answers, moves and fails as the firmware named by its personality. Bytes, workcell events and the time go in; an
/// outbox and the next deadline come out. Instants never run backwards. The same inputs give the same bytes, however
/// bytes are cut into calls.
class VirtualController {
 public:
  /// `stored` is what an earlier life left behind; a default one is a memory fresh from the factory. Stored settings
  /// that the firmware would refuse are dropped; `rejected_settings()` names them.
  explicit VirtualController(const Personality& personality, StoredState stored = {}, Equipment equipment = {});
  ~VirtualController();
  VirtualController(VirtualController&&) noexcept;
  VirtualController& operator=(VirtualController&&) noexcept;

  /// Applies power: start-up text, startup lines. Call it once, before anything else.
  void power_on(Instant now);
  /// Bytes arrive at the receiver. A realtime byte acts at once, everything else goes through the receive buffer.
  void on_bytes(Instant now, std::string_view bytes);
  /// The same from the pendant, where one is fitted. Text counts only while it is in command, and then the main wire is
  /// deaf.
  void on_pendant_bytes(Instant now, std::string_view bytes);
  /// Something happens to the machine.
  void submit(Instant now, const WorkcellEvent& event);
  /// The main loop stands still for `time`: bytes fill the receive buffer, everything else waits, motion goes on.
  void stall(Instant now, Duration time);
  /// Lets time pass up to `now`.
  void advance_to(Instant now);
  /// When this controller next does something by itself; `kNever` when idle.
  [[nodiscard]] Instant next_deadline() const;
  /// Everything that was sent since the last call, in order.
  [[nodiscard]] std::string take_outbox();
  [[nodiscard]] std::string take_pendant_outbox();

  /// Bytes that fit into the receive buffer of the main wire without loss; a link with back-pressure (TCP) hands over
  /// no more than this.
  [[nodiscard]] std::size_t receive_room() const;
  [[nodiscard]] const StoredState& stored() const;
  /// What is plugged into it.
  [[nodiscard]] const Equipment& equipment() const;
  /// Increases whenever `stored()` changes, so that an owner knows when to save it.
  [[nodiscard]] unsigned stored_revision() const;
  /// Ids of stored settings that were dropped at construction.
  [[nodiscard]] const std::vector<std::string>& rejected_settings() const;
  [[nodiscard]] const Personality& personality() const;
  [[nodiscard]] vocabulary::MachineState state() const;
  /// The number behind the state's colon, as a status report with everything switched on would have it.
  [[nodiscard]] std::optional<int> substate() const;
  /// The pendant has command, and the main wire is deaf.
  [[nodiscard]] bool pendant_commands() const;
  /// Motors turn, or will by themselves: between the moves of a homing cycle.
  [[nodiscard]] bool is_moving() const;
  /// The motors execute a rapid motion.
  [[nodiscard]] bool is_rapid() const;
  [[nodiscard]] bool is_spindle_on() const;
  /// G-code lines that were begun since power-on; `$` lines and empty ones do not count.
  [[nodiscard]] std::uint32_t lines_begun() const;
  /// The world around it. Somebody who replaces a controller takes it along, before power_on().
  [[nodiscard]] const Workcell& workcell() const;
  void set_workcell(const Workcell& workcell);
  /// Where the motors stand, counted from power-on.
  [[nodiscard]] vocabulary::AxisSteps motor_steps() const;
  /// Machine position in motor steps at the last instant that went in.
  [[nodiscard]] vocabulary::AxisSteps position_steps() const;
  /// The same in mm, one value for each axis that the machine has.
  [[nodiscard]] std::vector<double> position_mm() const;

  /// From now on every block is written down in this log, which lives as long as the controller.
  MotionLog& keep_motion_log();
  /// Empty unless it is kept.
  [[nodiscard]] const MotionLog& motion_log() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kerf::firmware
