#pragma once
// Play in the drives: when an axis turns round, Rabbit first takes it up with a move of its own.

#include <array>
#include <cstdint>
#include <optional>

#include "common/vocabulary/axis.hpp"

namespace kerf::firmware {

/// Knows which way each axis went last. The first move of an axis counts as a turn in either direction
/// (SourceRabbit/RabbitGRBL BacklashManager.cpp; motion.md 1.6). Millimetres, machine coordinates.
class Backlash {
 public:
  /// Feed of a take-up move: as fast as the axes allow.
  static constexpr float kFeedMmPerMin = 20'000.0F;

  /// Notes a move to `target_mm`. Returns where the move that takes up the play of `play_mm` ends, if one is due.
  [[nodiscard]] std::optional<vocabulary::AxisValues> turn_to(const vocabulary::AxisValues& target_mm,
                                                              const vocabulary::AxisValues& play_mm);
  /// After a reset and homing: the machine stands at `at_mm`, and no direction is known.
  void forget(const vocabulary::AxisValues& at_mm);
  /// After a probe: the machine stands at `at_mm`, the directions stay. A cancelled jog tells nothing, so that the next
  /// turn is measured from where the jog should have ended, as on the real machine.
  void stand_at(const vocabulary::AxisValues& at_mm) { at_mm_ = at_mm; }

 private:
  enum class Direction : std::uint8_t { Unknown, Positive, Negative };

  vocabulary::AxisValues at_mm_{};
  std::array<Direction, vocabulary::kMaxAxes> directions_{};
};

}  // namespace kerf::firmware
