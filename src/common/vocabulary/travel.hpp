#pragma once
// Where an axis may go, in machine coordinates (motion.md 1.6).

#include <cstdint>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

enum class TravelRule : std::uint8_t {
  NegativeSpace,        ///< Grbl: always below zero
  MirroredByDirection,  ///< Rabbit: above zero on axes that home towards minus
  HomedEnvelope,        ///< grblHAL: less the pull-off with hard limits on; zero at the switch with `$22` bit 3
};
BOOST_DESCRIBE_ENUM(TravelRule, NegativeSpace, MirroredByDirection, HomedEnvelope)

/// An unknown firmware is taken for Grbl.
[[nodiscard]] constexpr TravelRule travel_rule_of(Firmware firmware) {
  switch (firmware) {
    case Firmware::Rabbit: return TravelRule::MirroredByDirection;
    case Firmware::GrblHal: return TravelRule::HomedEnvelope;
    default: return TravelRule::NegativeSpace;
  }
}

/// What the settings say about one axis.
struct TravelFacts {
  float length_mm = 0;
  /// `$23`.
  bool homes_to_minus = false;
  /// Rabbit: machine position of the switch.
  float switch_at_mm = 0;
  /// `$27` where hard limits are on, else 0.
  float pull_off_mm = 0;
  /// grblHAL `$22` bit 3.
  bool zero_at_switch = false;
};

struct Travel {
  float min_mm = 0;
  float max_mm = 0;
};

/// gnea/grbl system.c: negative space. Rabbit mirrors axes that home towards minus; grblHAL keeps the pull-off distance
/// when hard limits are on, and puts zero at the switch with `$22` bit 3 (machine_limits.c).
[[nodiscard]] constexpr Travel travel_of(TravelRule rule, const TravelFacts& axis) {
  switch (rule) {
    case TravelRule::MirroredByDirection:
      return axis.homes_to_minus ? Travel{.min_mm = axis.switch_at_mm, .max_mm = axis.switch_at_mm + axis.length_mm}
                                 : Travel{.min_mm = axis.switch_at_mm - axis.length_mm, .max_mm = axis.switch_at_mm};
    case TravelRule::HomedEnvelope:
      if (!axis.zero_at_switch) return {.min_mm = -axis.length_mm + axis.pull_off_mm, .max_mm = -axis.pull_off_mm};
      return axis.homes_to_minus ? Travel{.min_mm = 0, .max_mm = axis.length_mm - axis.pull_off_mm}
                                 : Travel{.min_mm = -axis.length_mm + axis.pull_off_mm, .max_mm = 0};
    case TravelRule::NegativeSpace: break;
  }
  return {.min_mm = -axis.length_mm, .max_mm = 0};
}

/// Where an axis stands behind homing, `axis.pull_off_mm` from its switch.
[[nodiscard]] constexpr float home_of(TravelRule rule, const TravelFacts& axis) {
  const Travel travel = travel_of(rule, axis);
  const float end = axis.homes_to_minus ? travel.min_mm : travel.max_mm;
  if (rule == TravelRule::HomedEnvelope) return end;
  return axis.homes_to_minus ? end + axis.pull_off_mm : end - axis.pull_off_mm;
}

}  // namespace kerf::vocabulary
