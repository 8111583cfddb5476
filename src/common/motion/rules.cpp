#include "common/motion/rules.hpp"

namespace kerf::motion {

namespace {

// gnea/grbl config.h, planner.h, stepper.h (ATmega328 at 16 MHz).
constexpr MotionRules kGrbl{.idle_lock_blocks = true};

// RabbitGRBL Config.h, Planner.h, Stepper.h (ESP32).
constexpr MotionRules kRabbit{.float_rule = FloatRule::DoubleLiterals,
                              .step_timer_hz = 20'000'000,
                              .extra_counts_per_tick = 0,
                              .wake_waits_last_period = true,
                              .acceleration_converted_last = true,
                              .override_ramp_ends_by_distance = true,
                              .dwell_step = std::chrono::milliseconds{1}};

// grblHAL core config.h, planner.c, stepper.c; the step timer is the driver's, here the simulator's.
constexpr MotionRules kGrblHal{.planner_blocks = 100,
                               .segment_slots = 9,
                               .extra_counts_per_tick = 0,
                               .longest_tick_counts = 0xFFFF'FFFF,
                               .wake_counts = 5000,
                               .sums_from_last_axis = true,
                               .override_caps_first = true,
                               .replan_needs_blocks = true,
                               .restart_resets_bresenham = true,
                               .hold_snap_mm = 0.0001F,
                               .cancel_drops_segments = true,
                               .arc_radius_in_double = true,
                               .arc_moves_all_axes = true,
                               .arc_chord_mask = 0xFFFF'FFFF};

}  // namespace

const MotionRules& rules_of(vocabulary::Firmware firmware) {
  switch (firmware) {
    case vocabulary::Firmware::Unknown:
    case vocabulary::Firmware::Grbl: return kGrbl;
    case vocabulary::Firmware::Rabbit: return kRabbit;
    case vocabulary::Firmware::GrblHal: return kGrblHal;
  }
  return kGrbl;
}

}  // namespace kerf::motion
