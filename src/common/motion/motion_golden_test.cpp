// Figures of real firmware: unchanged sources run against a simulated clock. The first step is at t = 0 here.

#include <gtest/gtest.h>

#include "common/motion/motion_test_machine.hpp"

namespace kerf::motion {
namespace {

using testing::at_s;
using testing::feed;
using testing::line_to;
using testing::Machine;
using testing::rapid;
using testing::router_settings;
using vocabulary::Firmware;

/// A recorded run: when the first step was, when the last motion ended, s after the first byte.
struct Recorded {
  Firmware firmware;
  double first_step_s;
  double end_s;
};

void set_clock_to_first_step(Machine& machine, double first_step_s) {
  const MotionRules& rules = machine.planner.rules();
  const double wake_counts = rules.wake_waits_last_period ? 65535 : rules.wake_counts;
  machine.now = at_s(first_step_s - wake_counts / rules.step_timer_hz);
}

/// A square with rounded-off corners of feed and rapid moves, long enough to cruise.
void run_square(Machine& machine) {
  machine.move(line_to({60}, feed(1500)));
  machine.move(line_to({60, 40}, feed(1500)));
  machine.move(line_to({0, 40}, feed(2400)));
  machine.move(line_to({0, 0}, rapid()));
  machine.move(line_to({30, 30}, feed(900)));
  machine.move(line_to({0, 0}, rapid()));
}

TEST(MotionGolden, SquareTakesAsLongAsOnFirmware) {
  for (const auto& [firmware, first, end] : {Recorded{Firmware::Grbl, 0.000020, 9.988438},
                                             {Firmware::Rabbit, 0.003293, 9.983691},
                                             {Firmware::GrblHal, 0.000513, 9.981542}}) {
    Machine machine(firmware, router_settings());
    set_clock_to_first_step(machine, first);
    run_square(machine);
    machine.run();
    EXPECT_NEAR(machine.end_s(), end, 0.00002) << name_of(firmware);
    EXPECT_EQ(machine.steps(), AxisSteps{});
  }
}

TEST(MotionGolden, HoldsStopWhereFirmwareStops) {
  struct Held {
    Recorded run;
    std::int32_t first_x;
    std::int32_t second_y;
  };
  for (const auto& [run, first_x, second_y] : {Held{{Firmware::Grbl, 0.000020, 12.000290}, 2080, 267},
                                               {{Firmware::Rabbit, 0.003293, 11.995219}, 2080, 267},
                                               {{Firmware::GrblHal, 0.000513, 11.915727}, 2160, 427}}) {
    Machine machine(run.firmware, router_settings());
    set_clock_to_first_step(machine, run.first_step_s);
    run_square(machine);
    machine.run(at_s(1.0));
    machine.executor.begin_hold(machine.now);
    machine.run(at_s(2.5));
    EXPECT_EQ(machine.steps()[0], first_x) << name_of(run.firmware);
    machine.executor.cycle_start(machine.now);
    machine.run(at_s(4.0));
    machine.executor.begin_hold(machine.now);
    machine.run(at_s(4.6));
    EXPECT_EQ(machine.steps()[1], second_y) << name_of(run.firmware);
    machine.executor.cycle_start(machine.now);
    machine.run();
    EXPECT_NEAR(machine.end_s(), run.end_s, 0.00002) << name_of(run.firmware);
    EXPECT_EQ(machine.steps(), AxisSteps{});
  }
}

TEST(MotionGolden, SlowFeedsMeetTheStepTimersLimit) {
  for (const auto& [firmware, first, end] : {Recorded{Firmware::Grbl, 0.000020, 5.605895},
                                             {Firmware::Rabbit, 0.003293, 4.888186},
                                             {Firmware::GrblHal, 0.000513, 11.503360}}) {
    Machine machine(firmware, router_settings());
    set_clock_to_first_step(machine, first);
    AxisValues at{};
    const auto by = [&](float x, float y, float z, float rate) {
      at = {at[0] + x, at[1] + y, at[2] + z};
      machine.move(line_to(at, feed(rate)));
    };
    by(0.5F, 0, 0, 10);
    by(0.02F, 0, 0, 1);
    by(0, 0.1F, 0, 3);
    by(1, 0.001F, 0, 30);
    by(0, 0, 0.05F, 2);
    by(-0.5F, 0, 0, 20);
    machine.run();
    EXPECT_NEAR(machine.end_s(), end, 0.00002) << name_of(firmware);
    EXPECT_EQ(machine.steps(), (AxisSteps{82, 8, 20}));
  }
}

}  // namespace
}  // namespace kerf::motion
