#pragma once
// Arcs as the chords that firmware cuts them into.

#include <array>
#include <cstdint>
#include <optional>

#include "common/gcode/action.hpp"
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

/// The arc that a move asks for which begins at `start_mm`.
[[nodiscard]] Arc arc_of(const gcode::ArcMove& move, const AxisValues& start_mm);

/// Hands out the ends of an arc's chords one at a time, so that the caller can stop whenever the planner is full
/// (gnea/grbl motion_control.c mc_arc; motion.md 1.4).
class ArcChords {
 public:
  ArcChords(const Arc& arc, const MotionRules& rules, const MotionSettings& settings);

  /// End of the next chord; the last one is the programmed target, after which nothing comes.
  std::optional<AxisValues> next();
  /// What the firmware multiplies an inverse-time feed (1/min) by before it treats the result as mm/min. 1, with the
  /// feed staying inverse-time, when is_one_line().
  [[nodiscard]] int inverse_time_factor() const { return is_one_line() ? 1 : first_chords_; }
  /// The angle to the target, without the full turns before. Within 5e-7 of nothing it is a full circle.
  [[nodiscard]] float swept_rad() const;
  /// The arc is too small to be cut.
  [[nodiscard]] bool is_one_line() const { return first_chords_ == 0; }

 private:
  /// A full turn, or the arc that remains after the full turns.
  void begin_leg();
  template <class Wide>
  [[nodiscard]] float travel(const std::array<float, 2>& end) const;
  template <class Wide>
  [[nodiscard]] std::uint32_t chord_count(float travel) const;
  void turn_radius();
  void correct_radius();

  Arc arc_;
  MotionRules rules_;
  float tolerance_mm_;
  std::size_t axes_;
  bool wide_;

  AxisValues position_{};
  AxisValues leg_target_{};
  AxisValues per_turn_mm_{};
  AxisValues per_chord_mm_{};
  /// 64 bits for grblHAL; the others round it to 32 after every operation.
  std::array<double, 2> radius_{};
  std::array<double, 2> center_{};
  float theta_ = 0;
  float sin_ = 0;
  float cos_ = 0;
  int turns_left_ = 0;
  int first_chords_ = 0;
  std::uint32_t chords_ = 0;
  std::uint32_t chord_ = 0;
  int since_correction_ = 0;
  bool finished_ = false;
};

}  // namespace kerf::motion
