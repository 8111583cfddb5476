// Jobs that run to their end, on every firmware and link.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class Jobs : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, Jobs, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

void expect_complete(simulation::World& world, const std::optional<job::JobState>& job, int rows) {
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  EXPECT_THAT(told<session::LineRefused>(world), IsEmpty());
  EXPECT_THAT(told<session::JobEnded>(world), SizeIs(1));
  EXPECT_NEAR(position_mm(world, 0), 0, 0.01);
  EXPECT_NEAR(position_mm(world, 1), rows, 0.01);
  EXPECT_LE(world.most_bytes_in_flight(), world.session().window_bytes());
  EXPECT_EQ(world.session().bytes_in_flight(), 0U);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
}

TEST_P(Jobs, CompleteAt115200Baud) {
  World world{quick_serial(GetParam())};
  expect_complete(world, run_job(world, program(zigzag(20)), 10min), 20);
}

TEST_P(Jobs, CompleteOverASlowNetwork) {
  auto options = quick_network(GetParam());
  options.wire.latency = 40ms;
  World world{options};
  expect_complete(world, run_job(world, program(zigzag(20)), 10min), 20);
}

TEST_P(Jobs, CompleteAt9600Baud) {
  auto options = serial_world(GetParam(), 9600);
  options.stored = quick_machine();
  World world{options};
  const auto job = run_job(world, program(zigzag(6)), 10min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
}

TEST_P(Jobs, ASecondJobFollowsTheFirst) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(run_job(world, program(zigzag(2)), 10min));
  const auto job = run_job(world, program(zigzag(3)), 10min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  EXPECT_NEAR(position_mm(world, 1), 3, 0.01);
}

TEST_P(Jobs, ArcsDwellsAndOffsetsComeThrough) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world,
                           program("G21G90G17\nG10 L20 P1 X0 Y0 Z0\nG0 X10\nG2 X20 Y0 I5 J0 F2000\nG4 P0.5\n"
                                   "G3 X10 Y0 R5 F2000\nG92 X0\nG1 X5 F1000\nG92.1\nG0 X0 Y0\nM30\n"),
                           10min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  EXPECT_NEAR(position_mm(world, 0), 0, 0.01);
}

TEST_P(Jobs, DoNotEndBeforeTheMotionHas) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1 X100 F1000\n", 100ms));
  ASSERT_TRUE(world.run_until(is_over, 1min));
  // 100 mm at 1000 mm/min.
  EXPECT_GE(world.session().job()->progress.elapsed_s, 6.0);
  EXPECT_NEAR(position_mm(world, 0), 100, 0.01);
}

TEST_P(Jobs, ArePausedByTheProgramAndGoOnWhenAsked) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1 X10 F3000\nM0\nG1 X20\n", 5s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Held);
  EXPECT_NEAR(position_mm(world, 0), 10, 0.01);
  world.run_for(30s);
  EXPECT_EQ(world.session().job()->phase, JobPhase::Held);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished);
  EXPECT_NEAR(position_mm(world, 0), 20, 0.01);
  EXPECT_GE(world.session().job()->progress.held_s, 30.0);
}

TEST_P(Jobs, InCheckModeMoveNothing) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.submit(session::SendLine{"$C"});
  world.run_for(1s);
  ASSERT_EQ(world.session().snapshot().state, MachineState::Check);
  const auto job = run_job(world, program(zigzag(3)), 1min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  EXPECT_NEAR(position_mm(world, 1), 0, 0.001);
}

TEST_P(Jobs, GiveTheSameBytesTwice) {
  const auto once = [] {
    World world{quick_network(GetParam())};
    static_cast<void>(run_job(world, program(zigzag(5)), 10min));
    return world.transcript_text();
  };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace kerf::scenarios
