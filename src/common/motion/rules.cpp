#include "common/motion/rules.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::motion {

namespace {

// gnea/grbl config.h, planner.h, stepper.h (ATmega328 at 16 MHz).
constexpr MotionRules kGrbl{
    .main_loop_pass = std::chrono::microseconds{10}, .idle_lock_blocks = true, .dwell_mask = 0xFFFF};

// RabbitGRBL Config.h, Planner.h, Stepper.h (ESP32).
constexpr MotionRules kRabbit{.float_rule = FloatRule::DoubleLiterals,
                              .step_timer_hz = 20'000'000,
                              .extra_counts_per_tick = 0,
                              .wake_waits_last_period = true,
                              .acceleration_converted_last = true,
                              .override_ramp_ends_by_distance = true,
                              .dwell_step = std::chrono::milliseconds{1},
                              .dwell_rounds_down = true};

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
                               .arc_chord_mask = 0xFFFF'FFFF,
                               .dwell_tick_counts = 15999,
                               .dwell_tick_phase = std::chrono::microseconds{520}};

/// One pass of the main loop while it waits.
constexpr Duration kPass = std::chrono::microseconds{10};

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

Duration dwell_duration(const MotionRules& rules, float dwell_s) {
  const auto steps_per_s = static_cast<float>(std::chrono::seconds{1} / rules.dwell_step);
  const float steps = rules.dwell_rounds_down ? std::trunc(dwell_s * steps_per_s) : std::ceil(steps_per_s * dwell_s);
  constexpr float kMost = 4.0E9F;
  if (!(steps > 0.0F)) return Duration::zero();
  return rules.dwell_step * (static_cast<std::uint32_t>(std::min(steps, kMost)) & rules.dwell_mask);
}

Instant delay_end(const MotionRules& rules, Instant now, Duration delay) {
  if (rules.dwell_tick_counts == 0 || delay < std::chrono::milliseconds{1}) return now + delay;
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  const std::int64_t hz = rules.step_timer_hz;
  const auto counts_of = [&](Duration duration) {
    const std::int64_t ns = duration.count();
    return ns / kNsPerS * hz + ns % kNsPerS * hz / kNsPerS;
  };
  // What is left of the tick counts as a whole one.
  const std::int64_t tick = rules.dwell_tick_counts;
  const std::int64_t ticks_before = counts_of(now.time_since_epoch() + rules.dwell_tick_phase) / tick;
  const std::int64_t last_counts = (ticks_before + delay / std::chrono::milliseconds{1}) * tick;
  const Duration last{last_counts / hz * kNsPerS + last_counts % hz * kNsPerS / hz};
  const Duration lasted = last - rules.dwell_tick_phase - now.time_since_epoch();
  return now + (lasted + kPass - Duration{1}) / kPass * kPass;
}

Instant dwell_end(const MotionRules& rules, Instant now, Duration dwell) {
  if (rules.dwell_tick_counts == 0 || dwell < rules.dwell_step) return now + dwell;
  // The main loop passes once before each step; the steps follow one another without losing a tick.
  return delay_end(rules, now + kPass, dwell);
}

}  // namespace kerf::motion
