#pragma once
// Arcs as the chords that firmware cuts them into.

#include <array>
#include <cstdint>
#include <optional>

#include "common/motion/rules.hpp"

namespace kerf::motion {

/// An arc in machine coordinates, mm.
struct Arc {
  AxisValues start_mm{};
  AxisValues target_mm{};
  /// Centre from the start, along the plane's two axes.
  std::array<float, 2> center_offset_mm{};
  float radius_mm = 0;
  /// First and second axis of the plane, and the axis of the helix (axis numbers).
  std::array<std::uint8_t, 3> plane_axes = {0, 1, 2};
  bool clockwise = false;
  /// Full turns in all (grblHAL's P); 1 is a plain arc.
  int turns = 1;
};

/// Hands out the ends of an arc's chords one at a time, so that the caller can stop whenever the planner is full
/// (gnea/grbl motion_control.c mc_arc; motion.md 1.4).
class ArcChords {
 public:
  ArcChords(const Arc& arc, const MotionRules& rules, const MotionSettings& settings);

  /// End of the next chord; the last one is the programmed target, after which nothing comes.
  std::optional<AxisValues> next();
  /// Chords left, the last one included.
  [[nodiscard]] int remaining() const;
  /// Inverse-time feeds count for the whole arc: the rate of each chord in 1/min is this times the programmed one, and
  /// the chord is then fed as mm/min (a firmware oddity). 1 when the arc is one straight line, which stays inverse
  /// time.
  [[nodiscard]] int inverse_time_factor() const { return segments_; }

 private:
  int segments_ = 0;
};

}  // namespace kerf::motion
