#pragma once
// Where the tool goes while the safety door is open or the machine sleeps (grblHAL `$41`, state_machine.c; built into
// Rabbit)

#include <cstdint>

#include "firmware/board.hpp"

namespace kerf::firmware {

/// Where parking leads and how fast.
struct ParkingPlace {
  std::size_t axis = 0;
  float target_mm = 0;
  float rate_mm_per_min = 0;
  float pull_out_mm = 0;
  float pull_out_rate_mm_per_min = 0;
};

/// Knows the way out and back, and starts its legs; Cycle asks for the next one when a leg has ended. Each leg returns
/// false if there is nothing to move.
class Parking {
 public:
  explicit Parking(Board& board) : board_(board) {}

  enum class Leg : std::uint8_t { None, PullOut, Retreat, Return, Plunge, Aborted };

  /// The machine has come to rest: true if it parks, which needs an axis that stands below the parking place, and is
  /// homed where the settings say how to park.
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
  [[nodiscard]] ParkingPlace place() const;
  bool start(Leg leg, float axis_mm, float rate_mm_per_min);

  Board& board_;
  Leg leg_ = Leg::None;
  AxisValues work_place_mm_{};
  float waypoint_mm_ = 0;
  bool active_ = false;
  bool restarts_ = false;
  bool moved_ = false;
};

}  // namespace kerf::firmware
