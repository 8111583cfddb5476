#pragma once
// For tests: a planner and an executor, fed like a machine whose sender always has the next line ready.

#include <algorithm>
#include <vector>

#include "common/motion/arc.hpp"
#include "common/motion/executor.hpp"

namespace kerf::motion::testing {

/// 80 steps/mm on X and Y, 400 on Z.
inline MotionSettings router_settings() {
  return {.axes = 3,
          .steps_per_mm = {80, 80, 400},
          .max_rate_mm_per_min = {5000, 5000, 1500},
          .acceleration_mm_per_s2 = {310, 290, 110},
          .junction_deviation_mm = 0.02F,
          .idle_delay_ms = 255};
}

/// 100 steps/mm, 12000 mm/min, 100 mm/s² on all axes: figures that can be computed by hand.
inline MotionSettings plain_settings() {
  MotionSettings settings{.axes = 3, .junction_deviation_mm = 0.01F, .idle_delay_ms = 255};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    settings.steps_per_mm[axis] = 100;
    settings.max_rate_mm_per_min[axis] = 12000;
    settings.acceleration_mm_per_s2[axis] = 100;
  }
  return settings;
}

inline gcode::Feed feed(float mm_per_min) {
  return {.rate_mm_per_min = mm_per_min};
}
inline gcode::Feed rapid() {
  return {.rapid = true};
}
inline PathLine line_to(const AxisValues& target_mm, const gcode::Feed& feed) {
  return {.target_mm = target_mm, .feed = feed};
}

inline Instant at_s(double seconds) {
  return Instant{base::from_seconds(seconds)};
}

class Machine {
 public:
  Machine(vocabulary::Firmware firmware, const MotionSettings& settings)
      : planner(rules_of(firmware), settings), executor(planner, rules_of(firmware)) {}

  /// Queues a line as soon as there is room; the cycle starts with the first line.
  void move(const PathLine& line) {
    while (planner.is_full()) step(kNever);
    planner.plan(line);
    if (executor.phase() == ExecutorPhase::Resting) executor.cycle_start(now);
    step(now);
  }

  /// Runs to `limit`, or until nothing more happens.
  void run(Instant limit = kNever) {
    while (executor.next_deadline() <= limit && executor.next_deadline() != kNever) step(limit);
    if (limit != kNever) step(limit);
  }

  void step(Instant limit) {
    now = std::max(now, std::min(limit, executor.next_deadline()));
    executor.advance_to(now);
    const auto fresh = executor.take_events();
    events.insert(events.end(), fresh.begin(), fresh.end());
  }

  template <class Event>
  [[nodiscard]] std::vector<Event> all() const {
    std::vector<Event> found;
    for (const auto& event : events) {
      if (const auto* match = std::get_if<Event>(&event)) found.push_back(*match);
    }
    return found;
  }

  /// When the last motion ended, s.
  [[nodiscard]] double end_s() const {
    const auto ends = all<MotionEnded>();
    return ends.empty() ? -1.0 : base::to_seconds(ends.back().at);
  }

  [[nodiscard]] AxisSteps steps() const { return executor.steps_at(now); }

  Planner planner;
  Executor executor;
  Instant now{};
  std::vector<ExecutorEvent> events;
};

}  // namespace kerf::motion::testing
