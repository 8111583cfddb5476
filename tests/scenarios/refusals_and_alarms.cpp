// What goes wrong at the controller in the middle of a job: errors, alarms, resets, pendants.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using vocabulary::Axis;
using vocabulary::Firmware;
using vocabulary::MachineState;

class RefusalsAndAlarms : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, RefusalsAndAlarms, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

constexpr const char* kFaulty = "G21G90\nG1 X10 F3000\nG1 X20\nG1 X30 G77\nG1 X40\nG1 X50\nM30\n";

TEST_P(RefusalsAndAlarms, ARefusedLineIsNamed) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world, program(kFaulty), 5min);
  ASSERT_TRUE(job);
  ASSERT_EQ(job->phase, JobPhase::Refused) << job->reason;
  ASSERT_TRUE(job->refusal);
  EXPECT_EQ(job->refusal->file_line, 4U);
  EXPECT_EQ(job->refusal->text, "G1X30G77");
  EXPECT_EQ(job->refusal->code, 20);
  EXPECT_THAT(job->refusal->meaning, Not(IsEmpty()));
  EXPECT_EQ(job->aftermath.first_line_not_executed, 4U);
  // The next job is not refused on behalf of this one.
  const auto again = run_job(world, program("G21G90\nG0X1\n"), 1min);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->phase, JobPhase::Finished) << again->reason;
}

TEST_P(RefusalsAndAlarms, NoLineLeavesAfterTheErrorHasBeenSeen) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world, program(kFaulty + zigzag(200)), 5min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Refused) << job->reason;
  bool refused = false;
  for (const auto& event : world.events()) {
    if (std::holds_alternative<session::LineRefused>(event)) refused = true;
    const auto* sent = std::get_if<session::LineSent>(&event);
    EXPECT_FALSE(refused && sent != nullptr && sent->purpose == streaming::Purpose::JobLine);
  }
}

TEST_P(RefusalsAndAlarms, AManualLineThatFailsDoesNotPoisonTheNext) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.submit(session::SendLine{"G77"});
  world.run_for(1s);
  world.submit(session::SendLine{"G21G91G0X1"});
  world.run_for(2s);
  EXPECT_NEAR(position_mm(world, 0), 1, 0.01);
  EXPECT_THAT(told<session::LineRefused>(world), SizeIs(1));
}

TEST_P(RefusalsAndAlarms, AHardLimitEndsTheJob) {
  auto options = quick_serial(GetParam());
  options.stored.settings["21"] = "1";
  World world{options};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  world.touch(firmware::LimitHeld{.axis = Axis::X, .active = true});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  const auto job = *world.session().job();
  EXPECT_EQ(job.phase, JobPhase::Alarmed) << job.reason;
  EXPECT_EQ(job.alarm_code, 1);
  EXPECT_TRUE(job.position_suspect);
  EXPECT_EQ(world.session().bytes_in_flight(), 0U);
  const auto stood_at = world.controller().position_steps();
  world.run_for(1min);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  // The way out: release, reset, unlock.
  world.touch(firmware::LimitHeld{.axis = Axis::X, .active = false});
  world.submit(session::SoftReset{});
  ASSERT_TRUE(world.run_until(is_ready, 20s));
  world.submit(session::Unlock{});
  world.run_for(1s);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
}

TEST_P(RefusalsAndAlarms, AProbeThatFindsNothingEndsTheJob) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world, program("G21G90\nG38.2 Z-5 F500\nG0 Z10\n"), 1min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Alarmed) << job->reason;
  EXPECT_EQ(job->alarm_code, 5);
  EXPECT_THAT(job->reason, HasSubstr("Alarm 5"));
}

TEST_P(RefusalsAndAlarms, AResetFromOutsideInterruptsForGood) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(20), 3s));
  world.inject_to_controller("\x18");
  ASSERT_TRUE(world.run_until(is_over, 10s));
  const auto job = *world.session().job();
  EXPECT_EQ(job.phase, JobPhase::Interrupted) << job.reason;
  EXPECT_GT(job.aftermath.lines_not_executed, 0U);
  EXPECT_GT(job.aftermath.first_line_not_executed, 5U);
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  const auto stood_at = world.controller().position_steps();
  world.run_for(2min);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  EXPECT_TRUE(is_ready(world));
}

TEST_P(RefusalsAndAlarms, ABrownOutInterrupts) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(20), 3s));
  world.restart_controller();
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
}

TEST(ToolChange, OnGrblHalIsWaitedForAndResumed) {
  World world{quick_serial(Firmware::GrblHal)};
  ASSERT_TRUE(start(world, "G21G90\nG1X10F3000\nT2M6\nG1X20\nM30\n", 10s));
  ASSERT_EQ(world.session().job()->phase, JobPhase::Held);
  EXPECT_EQ(world.session().job()->hold_cause, job::HoldCause::ToolChange);
  EXPECT_NEAR(position_mm(world, 0), 10, 0.01);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_NEAR(position_mm(world, 0), 20, 0.01);
}

TEST_P(RefusalsAndAlarms, APendantInTheMiddleInterruptsAndKerfKeepsQuiet) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(20), 3s));
  world.inject_to_session("<Run|MPos:0.000,0.000,0.000|FS:0,0|MPG:1>\r\n");
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
  const auto lines = told<session::LineSent>(world).size();
  world.run_for(5s);
  EXPECT_EQ(told<session::LineSent>(world).size(), lines);
}

}  // namespace
}  // namespace kerf::scenarios
