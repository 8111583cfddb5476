// What must hold for any motion, on all three firmwares.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/motion/motion_test_machine.hpp"

namespace kerf::motion {
namespace {

using testing::at_s;
using testing::Machine;
using testing::router_settings;
using vocabulary::Firmware;

rc::Gen<Firmware> any_firmware() {
  return rc::gen::element(Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal);
}

/// Up to `most` lines through a cube of 60 mm, some rapid.
std::vector<PathLine> any_path(std::size_t most) {
  const auto coordinate =
      rc::gen::map(rc::gen::inRange(-3000, 3001), [](int n) { return static_cast<float>(n) / 100.0F; });
  const auto count = *rc::gen::inRange<std::size_t>(1, most + 1);
  std::vector<PathLine> path;
  for (std::size_t i = 0; i < count; ++i) {
    PathLine line;
    for (std::size_t axis = 0; axis < 3; ++axis) line.target_mm[axis] = *coordinate;
    line.feed.rapid = *rc::gen::inRange(0, 4) == 0;
    line.feed.rate_mm_per_min = static_cast<float>(*rc::gen::inRange(30, 6000));
    path.push_back(line);
  }
  return path;
}

RC_GTEST_PROP(Motion, EndsExactlyOnTheLastTarget, ()) {
  Machine machine(*any_firmware(), router_settings());
  for (const PathLine& line : any_path(40)) machine.move(line);
  machine.run();
  RC_ASSERT(machine.steps() == machine.planner.position_steps());
  RC_ASSERT(machine.executor.phase() == ExecutorPhase::Resting);
  RC_ASSERT(machine.planner.is_empty());
}

RC_GTEST_PROP(Motion, NeverExceedsTheRateOfAnAxis, ()) {
  Machine machine(*any_firmware(), router_settings());
  const MotionSettings settings = router_settings();
  for (const PathLine& line : any_path(14)) machine.planner.plan(line);
  machine.executor.cycle_start(machine.now);
  AxisSteps last = machine.steps();
  constexpr double kWindowS = 0.02;
  for (double t = kWindowS; machine.executor.phase() != ExecutorPhase::Resting; t += kWindowS) {
    machine.run(at_s(t));
    const AxisSteps here = machine.steps();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double most =
          kWindowS / 60.0 * static_cast<double>(settings.max_rate_mm_per_min[axis] * settings.steps_per_mm[axis]);
      RC_ASSERT(std::abs(here[axis] - last[axis]) <= most * 1.001 + 2);
    }
    last = here;
  }
}

RC_GTEST_PROP(Motion, HoldNeverRaisesTheSpeedAndResumeArrives, ()) {
  Machine machine(*any_firmware(), router_settings());
  for (const PathLine& line : any_path(14)) machine.planner.plan(line);
  machine.executor.cycle_start(machine.now);
  for (int holds = *rc::gen::inRange(1, 4); holds > 0; --holds) {
    machine.run(machine.now + std::chrono::milliseconds{*rc::gen::inRange(1, 3000)});
    machine.executor.begin_hold(machine.now);
    float speed = machine.executor.speed_mm_per_min();
    while (machine.executor.next_deadline() != kNever) {
      machine.step(kNever);
      RC_ASSERT(machine.executor.speed_mm_per_min() <= speed);
      speed = machine.executor.speed_mm_per_min();
    }
    machine.executor.cycle_start(machine.now + std::chrono::seconds{1});
  }
  machine.run();
  RC_ASSERT(machine.executor.phase() == ExecutorPhase::Resting);
  const AxisSteps end = machine.steps();
  const AxisSteps wanted = machine.planner.position_steps();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // grblHAL's step interrupt begins the minor axes of a block anew at each resume and may lose or win a step.
    const int slack = machine.planner.rules().restart_resets_bresenham ? 3 : 0;
    RC_ASSERT(std::abs(end[axis] - wanted[axis]) <= slack);
  }
}

RC_GTEST_PROP(Motion, OverridesAtAnyTimeKeepTheEnd, ()) {
  Machine machine(*any_firmware(), router_settings());
  for (const PathLine& line : any_path(40)) {
    machine.move(line);
    if (*rc::gen::inRange(0, 3) == 0) {
      machine.run(machine.now + std::chrono::milliseconds{*rc::gen::inRange(0, 800)});
      machine.planner.set_overrides(*rc::gen::inRange(10, 201), *rc::gen::element(25, 50, 100));
    }
  }
  machine.run();
  RC_ASSERT(machine.steps() == machine.planner.position_steps());
}

RC_GTEST_PROP(Motion, AdvancingInPiecesChangesNothing, ()) {
  const Firmware firmware = *any_firmware();
  const auto path = any_path(14);
  const Instant hold = at_s(0.001 * *rc::gen::inRange(1, 4000));
  const auto run = [&](Duration piece) {
    Machine machine(firmware, router_settings());
    for (const PathLine& line : path) machine.planner.plan(line);
    machine.executor.watch({.axis = vocabulary::Axis::X, .steps = 777, .seen_by_step_interrupt = true});
    machine.executor.watch({.axis = vocabulary::Axis::Y, .steps = -500, .above = false});
    machine.executor.cycle_start(machine.now);
    const Instant end = hold + std::chrono::seconds{20};
    bool held = false;
    std::vector<ExecutorEvent> events;
    for (Instant now{}; now < end;) {
      now = std::min(now + piece, held ? end : hold);
      machine.executor.advance_to(now);
      if (now == hold && !held) {
        machine.executor.begin_hold(now);
        held = true;
      }
      for (const auto& event : machine.executor.take_events()) events.push_back(event);
    }
    return std::pair{events, machine.executor.steps_at(end)};
  };
  const auto whole = run(std::chrono::hours{1});
  RC_ASSERT(run(std::chrono::microseconds{*rc::gen::inRange(300, 40000)}) == whole);
  RC_ASSERT(run(std::chrono::hours{1}) == whole);
}

}  // namespace
}  // namespace kerf::motion
