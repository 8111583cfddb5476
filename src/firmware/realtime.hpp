#pragma once
// Realtime bytes: what each one does the moment it arrives (protocol.md 2).

#include <cstdint>

#include "firmware/board.hpp"
#include "firmware/cycle.hpp"
#include "firmware/foreground.hpp"

namespace kerf::firmware {

/// Carries out realtime bytes. Those that this firmware does not act on are swallowed.
class Realtime {
 public:
  Realtime(Board& board, Cycle& cycle, Foreground& foreground, Receiver& receiver, Reporter& reporter)
      : board_(board), cycle_(cycle), foreground_(foreground), receiver_(receiver), reporter_(reporter) {}

  void act(std::uint8_t byte);
  /// The reset button or byte.
  void reset();

 private:
  bool act_on_motion(vocabulary::Realtime byte);
  bool act_on_reports(vocabulary::Realtime byte);
  void act_on_switches(vocabulary::Realtime byte);
  void act_on_overrides(vocabulary::Realtime byte);
  void toggle_coolant(bool flood);
  [[nodiscard]] bool is_repeated(std::uint8_t byte);

  Board& board_;
  Cycle& cycle_;
  Foreground& foreground_;
  Receiver& receiver_;
  Reporter& reporter_;
  Instant overridden_at_{};
  vocabulary::RealtimeSet overridden_;
};

}  // namespace kerf::firmware
