#pragma once
// What differs between the firmwares' motion, as values, and the machine's settings that motion depends on.
//
// Units inside common/motion are the firmware's own, because its 32-bit results depend on them: mm, minutes, mm/min,
// mm/min² and motor steps; time outside (events, deadlines) is kerf::base's nanoseconds.

#include <array>
#include <cstdint>

#include "common/base/time.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::motion {

using vocabulary::AxisMask;
using vocabulary::AxisSteps;
using vocabulary::AxisValues;
using vocabulary::kMaxAxes;

/// How the compiler of a firmware reads `0.5` and computes `sqrt(x)`: AVR has no double and grblHAL writes `0.5f`;
/// on the ESP32 (Rabbit) literals and library calls are double, and each assignment rounds back to 32 bits.
enum class FloatRule : std::uint8_t { Single, DoubleLiterals };

/// A firmware's motion in numbers (motion.md 1.2 to 1.5).
struct MotionRules {
  FloatRule float_rule = FloatRule::Single;
  /// Blocks that the planner can hold; grblHAL's `$398` replaces it (MotionSettings::planner_blocks).
  int planner_blocks = 15;
  /// Prepared step segments that can wait, the executing one included.
  int segment_slots = 5;
  /// Segments are prepared in passes of the main loop, which lie on a grid from time zero: a place that becomes free is
  /// filled by the next pass, after whatever that pass is told. Zero: at once.
  Duration main_loop_pass{};
  /// Segments per second (ACCELERATION_TICKS_PER_SECOND).
  int segments_per_s = 100;
  std::uint32_t step_timer_hz = 16'000'000;
  /// Timer counts added to each programmed period (an AVR compare match at N lasts N + 1).
  std::uint32_t extra_counts_per_tick = 1;
  /// Longest period that fits the step timer, in counts.
  std::uint32_t longest_tick_counts = 0xFFFF;
  /// Timer counts from the start of the stepper to its first interrupt: 0 on Grbl, whose timer never stops; grblHAL's
  /// driver loads a period of its own.
  std::uint32_t wake_counts = 0;
  /// True: the first interrupt comes after the period that was written last, at power-up the longest one (Rabbit).
  bool wake_waits_last_period = false;
  /// Step interrupts per second below which adaptive step smoothing doubles, quadruples and octuples them.
  std::array<std::uint32_t, 3> smoothing_below_hz = {8000, 4000, 2000};
  /// Slowest nominal speed of any block.
  float minimum_rate_mm_per_min = 1.0F;
  /// True: sums over the axes run from the last axis to the first (grblHAL), which changes their last bit.
  bool sums_from_last_axis = false;
  /// True: an overridden feed is first capped at the rapid rate, then scaled, then capped again (grblHAL).
  bool override_caps_first = false;
  /// True: accelerations are limited in mm/s² and converted afterwards (Rabbit); else the settings are converted first.
  bool acceleration_converted_last = false;
  /// True: a replan with an empty queue does nothing (grblHAL). On the others it walks over blocks that are long done
  /// and may leave the mark of "optimal so far" on one of them.
  bool replan_needs_blocks = false;
  /// True: slowing down for a lower override ends by distance (Rabbit); else by speed.
  bool override_ramp_ends_by_distance = false;
  /// True: each start of the stepper begins its block's Bresenham counters anew, also in mid-block after a hold
  /// (grblHAL).
  bool restart_resets_bresenham = false;
  /// A hold that would end within this distance of the block's end ends at the block's end (grblHAL).
  float hold_snap_mm = 0.0F;
  /// True: a stop waits for `$1` inside the step interrupt before the machine counts as idle (Grbl).
  bool idle_lock_blocks = false;
  /// True: a motion cancel may drop segments that are already prepared (grblHAL).
  bool cancel_drops_segments = false;
  /// True: arcs turn their radius vector in 64 bits (grblHAL).
  bool arc_radius_in_double = false;
  /// True: all axes outside the arc's plane move along with it (grblHAL); else only the helix axis, the others follow
  /// in the last chord.
  bool arc_moves_all_axes = false;
  /// Bits of the chord counter: 16 on Grbl and Rabbit.
  std::uint32_t arc_chord_mask = 0xFFFF;
  /// Dwells last a whole number of these (50 ms on Grbl and grblHAL, 1 ms on Rabbit).
  Duration dwell_step = std::chrono::milliseconds{50};
  /// True: a dwell is cut down to whole steps (Rabbit); else it is rounded up.
  bool dwell_rounds_down = false;
  /// Timer counts of the tick that dwells are counted in: each step of a dwell is so many of them as it has ms, and
  /// ends on one. 0: dwells last as long as they say. The simulator's tick is one count short of 1 ms (Simulator
  /// driver.c).
  std::uint32_t dwell_tick_counts = 0;
  /// How long before time zero the tick last came.
  Duration dwell_tick_phase{};
  /// Bits of the dwell counter: 16 on Grbl, where G4P3276.8 is no dwell at all.
  std::uint32_t dwell_mask = 0xFFFF'FFFF;

  bool operator==(const MotionRules&) const = default;
};

/// The rules of `firmware`; those of Grbl for an unknown one.
[[nodiscard]] const MotionRules& rules_of(vocabulary::Firmware firmware);

/// How long G4 P`dwell_s` lasts, once the motion before it has ended (gnea/grbl nuts_bolts.c; motion.md 1.5).
[[nodiscard]] Duration dwell_duration(const MotionRules& rules, float dwell_s);

/// When a wait of whole milliseconds ends that begins `now`: with a tick, where the firmware counts ticks.
[[nodiscard]] Instant delay_end(const MotionRules& rules, Instant now, Duration delay);

/// When a dwell of that duration ends which begins `now`.
[[nodiscard]] Instant dwell_end(const MotionRules& rules, Instant now, Duration dwell);

/// `$` settings that shape motion, in the units of the settings.
struct MotionSettings {
  int axes = 3;
  AxisValues steps_per_mm{};
  AxisValues max_rate_mm_per_min{};
  AxisValues acceleration_mm_per_s2{};
  float junction_deviation_mm = 0.01F;
  float arc_tolerance_mm = 0.002F;
  bool laser_mode = false;
  /// `$1`; 255 keeps the motors locked.
  std::uint8_t idle_delay_ms = 25;
  /// `$398`; 0 takes MotionRules::planner_blocks.
  int planner_blocks = 0;

  bool operator==(const MotionSettings&) const = default;
};

}  // namespace kerf::motion
