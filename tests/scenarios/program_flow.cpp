// Where a program pauses, waits for a tool, speaks and ends.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::HoldCause;
using job::JobPhase;
using job::ProgramSwitch;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using vocabulary::Firmware;
using vocabulary::MachineState;

class ProgramFlows : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, ProgramFlows, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

bool is_held(const simulation::World& world) {
  return world.session().job()->phase == JobPhase::Held;
}

std::vector<std::string> job_lines(const simulation::World& world) {
  std::vector<std::string> lines;
  for (const auto& line : told<session::LineSent>(world)) {
    if (line.purpose == streaming::Purpose::JobLine) lines.push_back(line.text);
  }
  return lines;
}

/// What the operator was told, whoever told it.
std::vector<std::string> messages(const simulation::World& world) {
  std::vector<std::string> texts;
  for (const auto& event : world.events()) {
    if (const auto* spoke = std::get_if<session::ProgramSpoke>(&event)) texts.push_back(spoke->text);
    const auto* line = std::get_if<session::LineReceived>(&event);
    const auto* feedback = line != nullptr ? std::get_if<protocol::Feedback>(&line->message) : nullptr;
    if (feedback != nullptr) texts.push_back(feedback->text);
  }
  return texts;
}

TEST_P(ProgramFlows, M0WaitsForTheOperatorAndSaysWhatHeIsToDo) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X10F3000\nM0 (MSG, Turn the part)\nG1X20\nM30\n", 10s));
  ASSERT_EQ(world.session().job()->phase, JobPhase::Held);
  EXPECT_EQ(world.session().job()->hold_cause, HoldCause::ProgramPause);
  EXPECT_THAT(messages(world), Contains(HasSubstr("Turn")));
  EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
  world.run_for(1min);
  EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_NEAR(position_mm(world, 0), 20, 0.005);
}

TEST_P(ProgramFlows, OptionalStopsAreAChoice) {
  for (const bool on : {true, false}) {
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(connect(world));
    world.submit(session::StartJob{.program = program("G21G90\nG1X10F3000\nM01\nG1X20\nM30\n"),
                                   .options = {.optional_stop = on ? ProgramSwitch::On : ProgramSwitch::Off}});
    world.run_for(10s);
    EXPECT_EQ(is_held(world), on);
    EXPECT_NEAR(position_mm(world, 0), on ? 10 : 20, 0.005);
    if (!on) continue;
    EXPECT_EQ(world.session().job()->hold_cause, HoldCause::ProgramPause);
    world.submit(session::ResumeJob{});
    ASSERT_TRUE(world.run_until(is_over, 1min));
    EXPECT_NEAR(position_mm(world, 0), 20, 0.005);
  }
}

TEST_P(ProgramFlows, DeletedBlocksAreAChoice) {
  for (const auto choice : {ProgramSwitch::On, ProgramSwitch::Off, ProgramSwitch::AsMachine}) {
    World world{quick_serial(GetParam())};
    const auto job = run_job(world, program("G21G90\nG1X10F3000\n/G1X20\nG1Y5\nM30\n"), 1min,
                             {.on_error = job::ErrorPolicy::Stop, .block_delete = choice});
    ASSERT_TRUE(job);
    EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
    EXPECT_NEAR(position_mm(world, 0), choice == ProgramSwitch::On ? 10 : 20, 0.005);
  }
}

TEST_P(ProgramFlows, NothingBehindTheEndIsSent) {
  for (const char* const end : {"M30\n", "M2\n", "%\n", "M30\n%\n"}) {
    SCOPED_TRACE(end);
    World world{quick_serial(GetParam())};
    const auto job = run_job(
        world, program("%\nG21G90\nG1X10F3000\n" + std::string(end) + "G1X99\nThis is a letter to the next shift.\n"),
        1min);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
    EXPECT_EQ(job->end_line, 4U);
    EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
    EXPECT_THAT(job_lines(world), Not(Contains("G1X99")));
  }
}

TEST_P(ProgramFlows, MessagesReachTheOperatorWhenTheirPlaceIsReached) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "(MSG,First)\nG21G90\nG1X10F3000\nM0\n(MSG,Second)\nG1X20\nM30\n", 10s));
  ASSERT_TRUE(is_held(world));
  EXPECT_THAT(messages(world), Contains(HasSubstr("First")));
  EXPECT_THAT(messages(world), Not(Contains(HasSubstr("Second"))));
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_THAT(messages(world), Contains(HasSubstr("Second")));
}

TEST_P(ProgramFlows, AToolChangeStandsStillAndNamesTheTool) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X10F3000\nT2 M6\nG1X20\nM30\n", 15s));
  ASSERT_TRUE(is_held(world)) << world.session().job()->reason;
  const auto job = *world.session().job();
  EXPECT_EQ(job.hold_cause, HoldCause::ToolChange);
  ASSERT_TRUE(job.tool_change);
  EXPECT_EQ(job.tool_change->tool, 2);
  EXPECT_EQ(job.tool_change->file_line, 3U);
  EXPECT_TRUE(world.session().ledger().empty());
  EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
  world.run_for(5min);
  EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_NEAR(position_mm(world, 0), 20, 0.005);
  EXPECT_THAT(told<session::LineRefused>(world), IsEmpty());
}

TEST_P(ProgramFlows, AtAToolChangeTheOperatorTouchesOffAndTheJobGoesOnFromItsPlace) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X10Z5F3000\nT2 M6\nG1X20\nM30\n", 15s));
  ASSERT_TRUE(is_held(world)) << world.session().job()->reason;
  world.submit(session::SendLine{"G1X50F100"});
  ASSERT_FALSE(told<session::CommandRefused>(world).empty());
  EXPECT_EQ(told<session::CommandRefused>(world).back().reason, session::Refused::NotAtToolChange);
  // Over the plate, down to it, and zero is there: the new tool is 2 mm shorter.
  for (const auto* line : {"$J=G21G91X30F3000", "$J=G21G91Z-7F3000", "G10L20P1Z0"}) {
    world.submit(session::SendLine{line});
    world.run_for(5s);
    EXPECT_TRUE(is_held(world)) << line;
  }
  EXPECT_NEAR(position_mm(world, 0), 40, 0.005);
  EXPECT_NEAR(position_mm(world, 2), -2, 0.005);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 2min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_NEAR(position_mm(world, 0), 20, 0.005);
  EXPECT_NEAR(position_mm(world, 2), 3, 0.005) << "5 mm above the new zero";
  EXPECT_THAT(told<session::LineRefused>(world), IsEmpty());
}

TEST_P(ProgramFlows, AStopWhileTheOperatorJogsKeepsThePosition) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X10F3000\nT2 M6\nG1X20\nM30\n", 15s));
  ASSERT_TRUE(is_held(world)) << world.session().job()->reason;
  world.submit(session::SendLine{"$J=G21G91X100F600"});
  world.run_for(2s);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Jog);
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
  EXPECT_FALSE(world.session().job()->position_suspect);
  ASSERT_TRUE(world.run_until(is_ready, 10s));
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
}

TEST_P(ProgramFlows, AToolChangeCanBeTheEndOfTheJob) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X10F3000\nT2\nM6\nG1X20\nM30\n", 15s));
  ASSERT_TRUE(is_held(world)) << world.session().job()->reason;
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
  EXPECT_FALSE(world.session().job()->position_suspect);
  ASSERT_TRUE(world.run_until(is_ready, 10s));
  world.run_for(5s);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
  EXPECT_NEAR(position_mm(world, 0), 10, 0.005);
}

}  // namespace
}  // namespace kerf::scenarios
