// A line that the controller refuses in the middle of a job: what the policies do, and the account of the lines that
// were on their way behind it, checked against what the machine really did.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::ErrorPolicy;
using job::HoldCause;
using job::JobPhase;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class RefusedLines : public testing::TestWithParam<Firmware> {
 protected:
  [[nodiscard]] bool latches() const { return vocabulary::dialect_of(GetParam()).error_latch; }
  bool start_with(World& world, const std::string& text, ErrorPolicy policy) const {
    if (!connect(world)) return false;
    world.submit(session::StartJob{.program = program(text), .options = {.on_error = policy}});
    return world.session().job().has_value();
  }
  static bool is_held(const simulation::World& world) { return world.session().job()->phase == JobPhase::Held; }
};
INSTANTIATE_TEST_SUITE_P(Firmwares, RefusedLines, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

// Relative, so that a line that is cut twice or left out shows in the end.
constexpr const char* kFaulty = "G21G91\nG1X10F3000\nX10\nX10G77\nX10\nY10\nX10\nY10\nX10\nG90\nM30\n";

TEST_P(RefusedLines, AreHeldAtAndAskedAbout) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start_with(world, kFaulty, ErrorPolicy::HoldAndAsk));
  ASSERT_TRUE(world.run_until(is_held, 1min));
  EXPECT_EQ(world.session().job()->hold_cause, HoldCause::Refusal);
  ASSERT_TRUE(world.session().job()->refusal);
  EXPECT_EQ(world.session().job()->refusal->file_line, 4U);
  EXPECT_EQ(world.session().job()->refusal->code, 20);
  const auto stood_at = world.controller().position_steps();
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  world.run_for(2min);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
}

TEST_P(RefusedLines, AreLeftOutWhenTheOperatorContinues) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start_with(world, kFaulty, ErrorPolicy::HoldAndAsk));
  ASSERT_TRUE(world.run_until(is_held, 1min));
  world.run_for(5s);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 5min));
  const auto& job = *world.session().job();
  EXPECT_EQ(job.phase, JobPhase::Finished) << job.reason;
  EXPECT_EQ(job.lines_refused, 1U);
  EXPECT_EQ(job.aftermath.lines_not_executed, 1U);
  EXPECT_THAT(job.reason, HasSubstr("line 4"));
  // Everything else exactly once, in its order.
  EXPECT_NEAR(position_mm(world, 0), 50, 0.005);
  EXPECT_NEAR(position_mm(world, 1), 20, 0.005);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
}

TEST_P(RefusedLines, StopTheJobWhenTheOperatorSaysSo) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start_with(world, kFaulty, ErrorPolicy::HoldAndAsk));
  ASSERT_TRUE(world.run_until(is_held, 1min));
  const auto stood_at = world.controller().position_steps();
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Refused) << world.session().job()->reason;
  ASSERT_TRUE(world.run_until(is_ready, 10s));
  world.run_for(10s);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
  const auto again = run_job(world, program("G21G90\nG0X1\n"), 1min);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->phase, JobPhase::Finished) << again->reason;
}

TEST_P(RefusedLines, EndTheJobUnderThePolicyStop) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world, program(kFaulty), 5min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Refused) << job->reason;
  EXPECT_FALSE(job->position_suspect);
  EXPECT_EQ(job->aftermath.first_line_not_executed, 4U);
  // All that was sent is accounted for: taken before, refused or lost, taken behind.
  const auto sent = lines_sent(world, streaming::Purpose::JobLine);
  EXPECT_EQ(sent, 3 + job->aftermath.lines_not_executed + job->aftermath.lines_executed_after_refusal);
  if (latches()) {
    EXPECT_EQ(job->aftermath.lines_executed_after_refusal, 0U);
  }
  EXPECT_LE(position_mm(world, 0), 21);
}

TEST_P(RefusedLines, AreReportedUnderThePolicyContinue) {
  World world{quick_serial(GetParam())};
  const std::string two = "G21G91\nG1X10F3000\nX10G77\nX10\nG99999\nX10\nX10\nY5\nG90\nM30\n";
  const auto job = run_job(world, program(two), 5min, {.on_error = ErrorPolicy::Continue});
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  EXPECT_EQ(job->lines_refused, 2U);
  EXPECT_NEAR(position_mm(world, 0), 40, 0.005);
  EXPECT_NEAR(position_mm(world, 1), 5, 0.005);
  std::size_t refused = 0;
  for (const auto& line : told<session::LineRefused>(world)) refused += line.latched_repeat ? 0 : 1;
  EXPECT_EQ(refused, 2U);
}

TEST_P(RefusedLines, SeveralInARowAreAskedAboutOneByOne) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(
      start_with(world, "G21G91\nG1X10F3000\nX10G77\nX10G77\nX10G77\nX10\nG90\nM30\n", ErrorPolicy::HoldAndAsk));
  for (int asked = 0; asked < 10 && !is_over(world); ++asked) {
    ASSERT_TRUE(world.run_until([](const auto& w) { return is_held(w) || is_over(w); }, 1min));
    if (is_held(world)) world.submit(session::ResumeJob{});
    world.run_for(1s);
  }
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_EQ(world.session().job()->lines_refused, 3U);
  EXPECT_NEAR(position_mm(world, 0), 20, 0.005);
}

TEST_P(RefusedLines, OneAtATimeLeavesNothingBehindThem) {
  World world{quick_serial(GetParam())};
  const auto job = run_job(world, program(kFaulty), 5min,
                           {.on_error = ErrorPolicy::Stop, .flow = streaming::FlowPolicy::OneAtATime});
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Refused);
  EXPECT_EQ(job->aftermath.lines_executed_after_refusal, 0U);
  EXPECT_EQ(job->aftermath.lines_not_executed, 1U);
}

}  // namespace
}  // namespace kerf::scenarios
