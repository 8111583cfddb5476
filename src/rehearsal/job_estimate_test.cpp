#include "rehearsal/job_estimate.hpp"

#include <gmock/gmock.h>

namespace kerf::rehearsal {
namespace {

using simulation::CaseMachine;
using simulation::trace_program;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;

CaseMachine machine_of(Firmware firmware) {
  CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"1", "255"},    {"100", "100"},  {"101", "100"}, {"102", "100"}, {"110", "6000"},
                             {"111", "6000"}, {"112", "3000"}, {"120", "500"}, {"121", "500"}, {"122", "500"}};
  return machine;
}

std::shared_ptr<const job::Program> program_of(std::string text) {
  return *job::Program::load("part.nc", std::move(text));
}

class Estimates : public testing::TestWithParam<Firmware> {};

TEST_P(Estimates, TotalIsThatOfTheTrace) {
  const auto program = program_of("G21 G90\nG0 X20\nG1 Z-1 F300\nX40 F1200\nG4 P0.5\nG2 X60 I10\nG0 Z5\nM30\n");
  const auto trace = trace_program({.program = std::string{program->text()}}, machine_of(GetParam()));
  const auto estimate = estimate_job(*program, machine_of(GetParam()));
  EXPECT_EQ(estimate.total_s, trace.total_s);
  EXPECT_EQ(estimate.blocks, trace.block_count);
  const UseOfTime& use = estimate.use;
  EXPECT_THAT(use.cutting_s + use.rapid_s + use.dwell_s + use.tool_change_s + use.other_s,
              DoubleNear(trace.total_s, 1e-6));
  EXPECT_THAT(use.dwell_s, DoubleNear(0.5, 0.1));
  EXPECT_THAT(estimate.rapid_mm, DoubleNear(26, 0.01));
  EXPECT_THAT(estimate.cutting_mm, DoubleNear(1 + 20 + 31.416, 0.05));
  EXPECT_THAT(estimate.feeds, SizeIs(2));
}

TEST_P(Estimates, ToolsAndOperationsShareTheTime) {
  const auto program = program_of(
      "G21 G90\n(Toolpath:- Rough)\nT1 M6\nG1 X10 F600\n(Toolpath:- Fine)\nT2 M6\nX30\n(Toolpath:- Rough)\nT1 "
      "M6\nX40\n");
  const auto estimate = estimate_job(*program, machine_of(GetParam()));
  EXPECT_THAT(estimate.errors, IsEmpty());
  ASSERT_THAT(estimate.tools, SizeIs(2));
  EXPECT_EQ(estimate.tools[0].name, "T1");
  EXPECT_THAT(estimate.tools[0].cutting_mm, DoubleNear(20, 1e-3));
  EXPECT_THAT(estimate.tools[1].cutting_mm, DoubleNear(20, 1e-3));
  ASSERT_THAT(estimate.operations, SizeIs(2));
  EXPECT_EQ(estimate.operations[0].name, "Rough");
  EXPECT_EQ(estimate.operations[0].first_line, 4U);
  EXPECT_EQ(estimate.operations[0].last_line, 10U);
}

TEST_P(Estimates, GoOnWhereTheProgramWaits) {
  const auto program = program_of("G21 G90\nG1 X1 F600\nM0\nX2\nM30\nX100\n");
  const auto estimate = estimate_job(*program, machine_of(GetParam()));
  EXPECT_THAT(estimate.stops, ElementsAre(3U));
  EXPECT_EQ(estimate.lines_answered, 5U) << "nothing is sent behind M30";
  EXPECT_THAT(estimate.cutting_mm, DoubleNear(2, 1e-3));
}

TEST_P(Estimates, ASlowLinkIsFoundWhereTheMovesAreShort) {
  std::string text = "G21 G90\nG1 X50 F600\n";
  for (int line = 0; line < 400; ++line) text += "G1 X" + std::to_string(50 + line % 2) + ".125 F6000\n";
  text += "G1 X0 F600\n";
  const auto program = program_of(text);
  const auto machine = machine_of(GetParam());
  const auto planner = estimate_job(*program, machine);
  const auto world = estimate_job(*program, machine, {.baud = 1200});
  const auto losses = lost_on_the_link(planner, world);
  ASSERT_FALSE(losses.empty());
  EXPECT_THAT(losses.front().lost_s, DoubleNear(world.total_s - planner.total_s, 1.0));
  EXPECT_GT(losses.front().first_line, 2U);
  EXPECT_THAT(lost_on_the_link(planner, planner), IsEmpty());
}

TEST_P(Estimates, SayWhatWouldBeRefused) {
  const auto program = program_of("G21\nG1 X1\nG1 X5 F100\n");
  const auto estimate = estimate_job(*program, machine_of(GetParam()));
  ASSERT_FALSE(estimate.errors.empty());
  EXPECT_EQ(estimate.errors.front().line, 2U);
}

INSTANTIATE_TEST_SUITE_P(Firmwares, Estimates, testing::Values(Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal),
                         [](const auto& value) {
                           return std::string{boost::describe::enum_to_string(value.param, "?")};
                         });

}  // namespace
}  // namespace kerf::rehearsal
