// The operator's verbs in the middle of a job: hold, resume, stop, abort.

#include <chrono>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class HoldsAndStops : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, HoldsAndStops, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

bool is_held(const simulation::World& world) {
  return world.session().job()->phase == JobPhase::Held;
}

TEST_P(HoldsAndStops, AHoldStandsStillAndResumesWhereItWas) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(start(world, zigzag(10), std::chrono::milliseconds{300 + random() % 6000}));
    world.submit(session::HoldJob{});
    ASSERT_TRUE(world.run_until(is_held, 10s));
    const auto stood_at = world.controller().position_steps();
    world.run_for(std::chrono::seconds{1 + random() % 60});
    EXPECT_EQ(world.controller().position_steps(), stood_at);
    world.submit(session::ResumeJob{});
    ASSERT_TRUE(world.run_until(is_over, 10min));
    EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
    EXPECT_NEAR(position_mm(world, 0), 0, 0.01);
    EXPECT_NEAR(position_mm(world, 1), 10, 0.01);
    EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
  }
}

TEST_P(HoldsAndStops, AResumeWhileStillDeceleratingIsRefused) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1 X200 F5000\n", 1s));
  world.submit(session::HoldJob{});
  world.submit(session::ResumeJob{});
  EXPECT_THAT(told<session::CommandRefused>(world), SizeIs(1));
  ASSERT_TRUE(world.run_until(is_held, 10s));
}

TEST_P(HoldsAndStops, AStopKeepsThePositionWithoutAlarm) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(start(world, zigzag(10), std::chrono::milliseconds{300 + random() % 6000}));
    world.submit(session::StopJob{});
    ASSERT_TRUE(world.run_until(is_over, 10s));
    EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped) << world.session().job()->reason;
    EXPECT_FALSE(world.session().job()->position_suspect);
    EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
    const auto lines = lines_sent(world, streaming::Purpose::JobLine);
    ASSERT_TRUE(world.run_until(is_ready, 10s));
    const auto stood_at = world.controller().position_steps();
    world.run_for(30s);
    EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
    EXPECT_EQ(world.controller().position_steps(), stood_at);
    EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
    const auto again = run_job(world, program("G21G90\nG0 X1\n"), 1min);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->phase, JobPhase::Finished) << again->reason;
  }
}

TEST_P(HoldsAndStops, AHeldJobStopsAtOnce) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  world.submit(session::HoldJob{});
  ASSERT_TRUE(world.run_until(is_held, 10s));
  const auto stood_at = world.controller().position_steps();
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 1s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
}

TEST_P(HoldsAndStops, AStopInADwellOrAProgramPauseWorks) {
  for (const char* const text : {"G21G90\nG4 P60\nG0 X10\n", "G21G90\nM0\nG0 X10\n"}) {
    SCOPED_TRACE(text);
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(start(world, text, 2s));
    world.submit(session::StopJob{});
    ASSERT_TRUE(world.run_until(is_over, 10s));
    EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
    world.run_for(10s);
    EXPECT_NEAR(position_mm(world, 0), 0, 0.001);
  }
}

TEST_P(HoldsAndStops, AnAbortInMotionLeavesThePositionSuspect) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1 X200 F5000\nX0\n", 1s));
  world.submit(session::AbortJob{});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
  EXPECT_TRUE(world.session().job()->position_suspect);
  ASSERT_THAT(told<session::AlarmRaised>(world), SizeIs(1));
  EXPECT_EQ(told<session::AlarmRaised>(world)[0].code, 3);
  ASSERT_TRUE(world.run_until(is_ready, 10s));
  world.submit(session::Unlock{});
  world.run_for(1s);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
}

TEST_P(HoldsAndStops, AnOpenDoorHoldsTheJobAndAClosedOneResumesIt) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  world.submit(session::SendRealtime{0x84});
  ASSERT_TRUE(world.run_until(is_held, 20s));
  EXPECT_EQ(world.session().job()->hold_cause, job::HoldCause::Door);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 10min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_NEAR(position_mm(world, 1), 10, 0.01);
}

}  // namespace
}  // namespace kerf::scenarios
