#include "common/motion/executor.hpp"

#include <gtest/gtest.h>

#include "common/motion/motion_test_machine.hpp"

namespace kerf::motion {
namespace {

using testing::at_s;
using testing::feed;
using testing::line_to;
using testing::Machine;
using testing::plain_settings;
using vocabulary::Axis;
using vocabulary::Firmware;

constexpr Firmware kAll[] = {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

double mm(std::int32_t steps) {
  return steps / 100.0;
}

/// From cycle start to the first step: the timer's first period.
double wake_s(Firmware firmware) {
  if (firmware == Firmware::Rabbit) return 65535 / 20e6;
  return firmware == Firmware::GrblHal ? 5000 / 16e6 : 0.0;
}

TEST(Executor, RunsATrapezoid) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    // 100 mm/s at 100 mm/s²: 1 s and 50 mm up, 1 s flat, 1 s down.
    machine.move(line_to({200}, feed(6000)));
    const double start = wake_s(firmware);
    for (const auto& [t, x] : {std::pair{0.5, 12.5}, {1.0, 50.0}, {1.5, 100.0}, {2.0, 150.0}, {2.5, 187.5}}) {
      machine.run(at_s(start + t));
      EXPECT_NEAR(mm(machine.steps()[0]), x, 0.15) << name_of(firmware) << " at " << t;
    }
    machine.run();
    EXPECT_NEAR(machine.end_s(), start + 3.0, 0.002) << name_of(firmware);
    EXPECT_EQ(machine.steps()[0], 20000);
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Resting);
    EXPECT_EQ(machine.executor.next_deadline(), kNever);
  }
}

TEST(Executor, RunsATriangle) {
  Machine machine(Firmware::Grbl, plain_settings());
  // 25 mm is too short for 100 mm/s: 0.5 s up to 50 mm/s and 0.5 s down.
  machine.move(line_to({25}, feed(6000)));
  machine.run();
  EXPECT_NEAR(machine.end_s(), 1.0, 0.002);
}

TEST(Executor, TakesAStraightCornerWithoutSlowing) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({100}, feed(6000)));
  machine.move(line_to({200}, feed(6000)));
  machine.run();
  EXPECT_NEAR(machine.end_s(), 3.0, 0.003);
  const auto finished = machine.all<BlockFinished>();
  ASSERT_EQ(finished.size(), 2U);
  EXPECT_NEAR(base::to_seconds(finished[0].at), 1.5, 0.002);
  EXPECT_EQ(finished[0].steps[0], 10000);
  EXPECT_EQ(machine.all<BlockStarted>()[1].at, finished[0].at);
}

TEST(Executor, StopsAtAReversal) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({100}, feed(6000)));
  machine.move(line_to({0}, feed(6000)));
  machine.run();
  EXPECT_NEAR(machine.end_s(), 4.0, 0.005);
  EXPECT_EQ(machine.steps()[0], 0);
}

TEST(Executor, HoldStopsAfterThePreparedSegmentsAndResumesExactly) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    machine.move(line_to({400}, feed(6000)));
    machine.run(at_s(2));
    const double x = mm(machine.steps()[0]);
    machine.executor.begin_hold(machine.now);
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Decelerating);
    machine.run();
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Held);
    ASSERT_EQ(machine.all<HoldComplete>().size(), 1U);
    // 40 to 50 ms (grblHAL: 80 to 90 ms) at 100 mm/s, then v²/2a = 50 mm.
    const double latency_mm = firmware == Firmware::GrblHal ? 8.5 : 4.5;
    EXPECT_NEAR(mm(machine.steps()[0]) - x - 50.0, latency_mm, 0.6) << name_of(firmware);
    EXPECT_TRUE(machine.all<MotionEnded>().empty());
    EXPECT_EQ(machine.executor.speed_mm_per_min(), 0.0F);

    machine.executor.cycle_start(at_s(10));
    machine.run();
    EXPECT_EQ(machine.steps()[0], 40000);
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Resting);
    EXPECT_EQ(machine.all<BlockFinished>().size(), 1U);
  }
}

TEST(Executor, HoldMayRunIntoTheNextBlocks) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    for (int i = 1; i <= 15; ++i) machine.move(line_to({20.0F * static_cast<float>(i)}, feed(6000)));
    machine.run(at_s(1.5));
    const double x = mm(machine.steps()[0]);
    machine.executor.begin_hold(machine.now);
    machine.run();
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Held);
    EXPECT_NEAR(mm(machine.steps()[0]) - x, firmware == Firmware::GrblHal ? 58.5 : 54.5, 0.7) << name_of(firmware);
    machine.executor.cycle_start(machine.now);
    machine.run();
    EXPECT_EQ(machine.steps()[0], 30000);
  }
}

TEST(Executor, HoldOverAnEmptyQueueStillCompletes) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({1}, feed(6000)));
  machine.run(at_s(0.195));
  ASSERT_TRUE(machine.planner.is_empty()) << "the last segment is prepared before it is stepped";
  machine.executor.begin_hold(machine.now);
  machine.run();
  EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Held);
  EXPECT_EQ(machine.steps()[0], 100);
  machine.executor.cycle_start(machine.now);
  EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Resting);
}

TEST(Executor, CancelIsAHoldThatIsForgotten) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({400}, feed(6000)));
  machine.move(line_to({500}, feed(6000)));
  machine.run(at_s(2));
  machine.executor.begin_hold(machine.now);
  machine.run();
  const AxisSteps stopped = machine.steps();
  machine.planner.clear();
  machine.executor.reset(machine.now);
  machine.planner.sync_position(stopped);
  EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Resting);
  EXPECT_EQ(machine.steps(), stopped);
  machine.move(line_to({0}, feed(6000)));
  machine.run();
  EXPECT_EQ(machine.steps()[0], 0);
}

TEST(Executor, ResetStopsDead) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({400}, feed(6000)));
  machine.run(at_s(2));
  const AxisSteps before = machine.steps();
  machine.planner.clear();
  machine.executor.reset(machine.now);
  machine.run(at_s(5));
  EXPECT_EQ(machine.steps(), before);
  EXPECT_EQ(machine.executor.next_deadline(), kNever);
  EXPECT_TRUE(machine.all<MotionEnded>().empty());
}

TEST(Executor, OverrideActsAtTheNextPreparedSegment) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    machine.move(line_to({1000}, feed(6000)));
    machine.run(at_s(2));
    machine.planner.set_feed_override(50);
    machine.run(at_s(2.03));
    const std::int32_t from = machine.steps()[0];
    machine.run(at_s(2.04));
    EXPECT_NEAR(machine.steps()[0] - from, 100, 2) << "not yet";
    // 0.5 s from 100 to 50 mm/s, in two more at the latest.
    machine.run(at_s(3));
    EXPECT_NEAR(machine.executor.speed_mm_per_min(), 3000, 1);
    machine.planner.set_feed_override(150);
    machine.run(at_s(5));
    EXPECT_NEAR(machine.executor.speed_mm_per_min(), 9000, 1);
    machine.run();
    EXPECT_EQ(machine.steps()[0], 100000);
  }
}

TEST(Executor, LoweredOverrideCanTakeSeveralBlocks) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    for (int i = 1; i <= 40; ++i) {
      machine.move(line_to({10.0F * static_cast<float>(i)}, feed(6000)));
      if (i == 30) machine.planner.set_feed_override(10);
    }
    machine.run();
    EXPECT_EQ(machine.steps()[0], 40000) << name_of(firmware);
    EXPECT_EQ(machine.all<BlockFinished>().size(), 40U);
  }
}

TEST(Executor, PlannerRoomComesWithPreparedSegments) {
  Machine machine(Firmware::Grbl, plain_settings());
  for (int i = 1; i <= 15; ++i) machine.planner.plan(line_to({static_cast<float>(i)}, feed(6000)));
  ASSERT_TRUE(machine.planner.is_full());
  machine.executor.cycle_start(machine.now);
  // 1 mm from rest takes 0.141 s. Five segments wait, so the block leaves the queue 40 to 50 ms before it ends.
  while (machine.planner.is_full()) machine.step(kNever);
  const double room = base::to_seconds(machine.now);
  EXPECT_GT(room, 0.08);
  EXPECT_LT(room, 0.11);
  EXPECT_TRUE(machine.all<BlockFinished>().empty());
}

TEST(Executor, StartsPlannedBlocksBeforeItRunsDry) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.move(line_to({1}, feed(6000)));
  // In the last 50 ms the queue is empty; a new block then starts without a gap, but from rest.
  machine.run(at_s(0.19));
  ASSERT_TRUE(machine.planner.is_empty());
  machine.planner.plan(line_to({2}, feed(6000)));
  EXPECT_EQ(machine.executor.next_deadline(), machine.now) << "wants to prepare";
  machine.run();
  EXPECT_NEAR(machine.end_s(), 0.4, 0.002);
  EXPECT_EQ(machine.all<MotionEnded>().size(), 1U);
}

TEST(Executor, IdleLockDelaysTheEndOnGrblOnly) {
  for (const Firmware firmware : kAll) {
    MotionSettings settings = plain_settings();
    settings.idle_delay_ms = 25;
    Machine machine(firmware, settings);
    machine.move(line_to({25}, feed(6000)));
    machine.run();
    EXPECT_NEAR(machine.end_s(), 1.0 + wake_s(firmware) + (firmware == Firmware::Grbl ? 0.025 : 0.0), 0.002);
  }
}

TEST(Executor, GrblsMainProgramWaitsForTheLock) {
  MotionSettings settings = plain_settings();
  settings.idle_delay_ms = 25;
  Machine machine(Firmware::Grbl, settings);
  machine.move(line_to({25}, feed(6000)));
  machine.run(at_s(1.01));
  EXPECT_TRUE(machine.executor.is_locking());
  EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Running);
  EXPECT_EQ(machine.all<BlockFinished>().size(), 1U);
  machine.run();
  EXPECT_FALSE(machine.executor.is_locking());
}

TEST(MotionRules, DwellsLastWholeSteps) {
  using std::chrono::milliseconds;
  EXPECT_EQ(dwell_duration(rules_of(Firmware::Grbl), 0.001F), milliseconds{50});
  EXPECT_EQ(dwell_duration(rules_of(Firmware::GrblHal), 0.333F), milliseconds{350});
  EXPECT_EQ(dwell_duration(rules_of(Firmware::Rabbit), 0.3339F), milliseconds{333});
  EXPECT_EQ(dwell_duration(rules_of(Firmware::Rabbit), 0.0F), milliseconds{0});
  EXPECT_EQ(dwell_duration(rules_of(Firmware::Grbl), 3276.8F), milliseconds{0}) << "a counter of 16 bits";
  EXPECT_EQ(dwell_duration(rules_of(Firmware::GrblHal), 3276.8F), milliseconds{3276800});
}

TEST(Executor, SlowestStepIsTheTimers) {
  // 0.1 mm in 10 steps at 1 mm/min would be 0.6 s a step; the AVR timer gives 32.8 ms, the ESP32's 26.2 ms.
  for (const auto& [firmware, step_s] :
       {std::pair{Firmware::Grbl, 8 * 65536 / 16e6}, {Firmware::Rabbit, 8 * 65535 / 20e6}, {Firmware::GrblHal, 0.6}}) {
    Machine machine(firmware, plain_settings());
    machine.move(line_to({0.1F}, feed(1)));
    machine.run();
    EXPECT_NEAR(machine.end_s() - wake_s(firmware), 10 * step_s, step_s * 0.1) << name_of(firmware);
  }
}

TEST(Executor, ProbeIsReadByTheStepInterrupt) {
  Machine machine(Firmware::Grbl, plain_settings());
  machine.planner.plan(line_to({0, 0, -50}, feed(600)));
  machine.executor.watch({.axis = Axis::Z, .steps = -1234, .above = false, .seen_by_step_interrupt = true});
  machine.executor.cycle_start(machine.now);
  while (machine.all<ThresholdCrossed>().empty()) machine.step(kNever);
  const auto crossed = machine.all<ThresholdCrossed>()[0];
  EXPECT_EQ(crossed.at, machine.now) << "the deadline is exact";
  EXPECT_EQ(crossed.steps[2], -1234);
  // One interrupt later, at 10 mm/s 1 ms a step.
  EXPECT_LE(machine.steps()[2], -1234);
  EXPECT_GE(machine.steps()[2], -1235);
  machine.executor.begin_hold(machine.now);
  machine.run();
  // Decelerates beyond the contact: 0.4 to 0.5 mm of prepared segments and v²/2a = 0.5 mm.
  EXPECT_NEAR(mm(machine.steps()[2]), -12.34 - 0.95, 0.07);
}

TEST(Executor, HomingFreezesEachAxisAtItsSwitch) {
  Machine machine(Firmware::Grbl, plain_settings());
  gcode::Feed homing = feed(3000);
  homing.no_override = true;
  for (const Axis axis : {Axis::X, Axis::Y}) {
    machine.executor.watch({.axis = axis, .steps = axis == Axis::X ? 2000 : 3000, .above = true, .freezes_axis = true});
  }
  EXPECT_EQ(machine.executor.start_system_motion(machine.now, line_to({100, 100}, homing), SystemMotion::Homing),
            Planner::Added::Queued);
  while (machine.all<ThresholdCrossed>().size() < 2) machine.step(kNever);
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[0], 2000);
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[1], 3000);
  EXPECT_EQ(machine.steps()[0], 3000) << "the reported position counts on";
  machine.executor.reset(machine.now);

  machine.executor.start_system_motion(machine.now, line_to({25, 25}, homing), SystemMotion::Homing);
  machine.run();
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[0], 2000 - 500);
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[1], 2500);
  const AxisSteps zero{};
  machine.executor.set_position(zero);
  EXPECT_EQ(machine.steps(), zero);
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[0], 1500);
}

TEST(Executor, ParkingLeavesTheHeldBlockAlone) {
  for (const Firmware firmware : kAll) {
    Machine machine(firmware, plain_settings());
    machine.move(line_to({100, 40}, feed(3000)));
    machine.run(at_s(1));
    machine.executor.begin_hold(machine.now);
    machine.run();
    const AxisSteps held = machine.steps();
    const double x = mm(held[0]);
    gcode::Feed pull_out = feed(1000);
    pull_out.no_override = true;
    const auto to = [&](float z) {
      return line_to({static_cast<float>(x), static_cast<float>(mm(held[1])), z}, pull_out);
    };
    EXPECT_EQ(machine.executor.start_system_motion(machine.now, to(5), SystemMotion::Parking), Planner::Added::Queued);
    machine.run();
    EXPECT_EQ(machine.steps()[2], 500);
    EXPECT_EQ(machine.executor.phase(), ExecutorPhase::Held);
    machine.executor.start_system_motion(machine.now, to(0), SystemMotion::Parking);
    machine.run();
    EXPECT_EQ(machine.steps(), held);
    machine.executor.cycle_start(machine.now);
    machine.run();
    EXPECT_EQ(machine.steps()[0], 10000);
    // The step interrupt begins the block's minor axis anew after another motion: at most a step, on real firmware too.
    EXPECT_NEAR(machine.steps()[1], 4000, 1);
  }
}

TEST(Executor, BacklashMovesMotorsOnly) {
  Machine machine(Firmware::Rabbit, plain_settings());
  PathLine take_up = line_to({0.25F}, feed(20000));
  take_up.is_backlash = true;
  machine.move(take_up);
  machine.move(line_to({10}, feed(1000)));
  machine.run();
  EXPECT_EQ(machine.steps()[0], 1000);
  EXPECT_EQ(machine.executor.motor_steps_at(machine.now)[0], 1025);
}

TEST(Executor, LaserPowerFollowsTheSpeed) {
  Machine machine(Firmware::Grbl, plain_settings());
  gcode::Feed burn = feed(6000);
  burn.spindle_rpm = 1000;
  burn.laser_dynamic = true;
  machine.move(line_to({200}, burn));
  machine.run(at_s(0.5));
  EXPECT_NEAR(machine.executor.dynamic_rpm().value_or(0), 500, 11);
  machine.run(at_s(1.5));
  EXPECT_NEAR(machine.executor.dynamic_rpm().value_or(0), 1000, 1);
  machine.run();
  EXPECT_FALSE(machine.executor.dynamic_rpm().has_value());
}

TEST(Executor, StopDropsPreparedSegmentsOnGrblhal) {
  double way[2] = {};
  for (const bool fast : {false, true}) {
    Machine machine(Firmware::GrblHal, plain_settings());
    machine.move(line_to({400}, feed(6000)));
    machine.run(at_s(2));
    const double x = mm(machine.steps()[0]);
    if (fast) {
      machine.executor.begin_stop(machine.now);
    } else {
      machine.executor.begin_hold(machine.now);
    }
    machine.run();
    way[fast ? 1 : 0] = mm(machine.steps()[0]) - x;
  }
  EXPECT_NEAR(way[0] - way[1], 6.5, 0.7) << "six or seven segments of 1 mm";
}

TEST(Executor, StopDropsSegmentsBetweenTwoOfThemToo) {
  // One step takes a good part of a segment here, and the last step of each is still due when the next one is taken.
  MotionSettings settings = plain_settings();
  settings.acceleration_mm_per_s2.fill(100.0F);
  double longest_ms = 0;
  for (int ms = 40; ms < 60; ++ms) {
    Machine machine(Firmware::GrblHal, settings);
    machine.move(line_to({400}, feed(1500)));
    machine.run(at_s(ms / 1000.0));
    const Instant asked = machine.now;
    machine.executor.begin_stop(machine.now);
    machine.run();
    longest_ms = std::max(longest_ms, base::to_seconds(machine.now - asked) * 1000.0);
  }
  EXPECT_LT(longest_ms, 130) << "without the prepared segments";
}

}  // namespace
}  // namespace kerf::motion
