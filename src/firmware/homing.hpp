#pragma once
// One homing cycle: seek, pull off, locate, pull off, each a motion of its own (motion.md 1.6).

#include <algorithm>
#include <cstdint>
#include <optional>

#include "firmware/board.hpp"
#include "firmware/cycle.hpp"

namespace kerf::firmware {

/// Homes the axes of one cycle at a time. The owner calls advance() whenever time has passed.
class Homing {
 public:
  enum class Outcome : std::uint8_t { Moving, Done, SwitchNotFound, SwitchStuck };

  Homing(Board& board, Cycle& cycle) : board_(board), cycle_(cycle) {}

  /// Begins to home `axes` together.
  void begin(AxisMask axes);
  /// Goes on after contacts, ends of motion and delays.
  Outcome advance();
  /// Switches may have been pressed by hand.
  void look_at_switches();
  void abandon() {
    moves_left_ = 0;
    settled_at_ = ends_at_ = kNever;
    failure_ = Outcome::Moving;
  }
  [[nodiscard]] bool is_active() const { return moves_left_ > 0; }
  [[nodiscard]] Instant next_deadline() const { return std::min(settled_at_, ends_at_); }

 private:
  void begin_move();
  void end_move();
  /// The main loop has to see that the move is over.
  void end_move_after(int passes);
  void lock(AxisMask axes);
  void set_position();

  Board& board_;
  Cycle& cycle_;
  AxisMask axes_ = 0;
  AxisMask unlocked_ = 0;
  bool approaching_ = true;
  bool moving_ = false;
  int moves_left_ = 0;
  float distance_mm_ = 0;
  float rate_mm_per_min_ = 0;
  /// How the cycle fails at `settled_at_`.
  Outcome failure_ = Outcome::Moving;
  Instant settled_at_ = kNever;
  Instant ends_at_ = kNever;
};

}  // namespace kerf::firmware
