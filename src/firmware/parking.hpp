#pragma once
// Where the tool goes while the safety door is open or the machine sleeps (grblHAL `$41`, state_machine.c).

#include <cstdint>

#include "firmware/board.hpp"

namespace kerf::firmware {

/// Knows the way out and back, and starts its legs; Cycle asks for the next one when a leg has ended. Each leg returns
/// false if there is nothing to move.
class Parking {
 public:
  explicit Parking(Board& board) : board_(board) {}

  enum class Leg : std::uint8_t { None, PullOut, Retreat, Return, Plunge, Aborted };

  /// The machine has come to rest: true if it parks, which needs a homed axis that stands below the parking place.
  bool begin();
  /// Slowly out of the work, outputs still on.
  bool pull_out();
  /// Fast to the parking place.
  bool retreat();
  /// Fast back to where the slow part began.
  bool go_back();
  /// Slowly into the work.
  bool plunge();
  /// The door opened on the way back: brake if it moves, then begin again.
  void abort();
  void leg_ended();
  void forget();

  [[nodiscard]] Leg leg() const { return leg_; }
  [[nodiscard]] bool is_away() const { return moved_; }

 private:
  [[nodiscard]] bool is_enabled() const;
  [[nodiscard]] float number(int id) const { return static_cast<float>(board_.settings.number(id)); }
  [[nodiscard]] std::size_t axis() const { return board_.settings.mask(setting::kParkingAxis); }
  bool start(Leg leg, float axis_mm, int rate_setting);

  Board& board_;
  Leg leg_ = Leg::None;
  AxisValues work_place_mm_{};
  float waypoint_mm_ = 0;
  bool active_ = false;
  bool restarts_ = false;
  bool moved_ = false;
};

}  // namespace kerf::firmware
