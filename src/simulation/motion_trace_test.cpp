#include "simulation/motion_trace.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using vocabulary::Firmware;

CaseMachine machine_of(Firmware firmware) {
  CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"1", "255"}, {"100", "100"}, {"110", "6000"}, {"120", "500"}};
  return machine;
}

TEST(MotionTrace, RowsNameTheLinesThatPlannedThem) {
  const ProgramRun run{.program = "(first)\r\n\r\nG1X10F600\r\nG4P0.1\r\nX0\r\n", .sample_every = 10ms};
  for (const Firmware firmware : {Firmware::Grbl, Firmware::GrblHal, Firmware::Rabbit}) {
    const MotionTrace trace = trace_program(run, machine_of(firmware));
    ASSERT_EQ(trace.blocks.size(), 2U);
    EXPECT_EQ(trace.blocks[0].line, 3U);
    EXPECT_EQ(trace.blocks[1].line, 5U);
    EXPECT_EQ(trace.blocks[0].end_steps.front(), 1000);
    EXPECT_EQ(trace.blocks[0].length_mm, 10.0);
    EXPECT_GT(trace.blocks[1].start_s, trace.blocks[0].end_s + 0.05);
    EXPECT_EQ(trace.final_steps.front(), 0);
    EXPECT_EQ(trace.lines_answered, 5U);
    EXPECT_NEAR(trace.total_s, 2.15, 0.05);
    EXPECT_NEAR(static_cast<double>(trace.positions.size()) * 0.01, trace.total_s, 0.03);
  }
}

TEST(MotionTrace, AHoldEndsItsRowAtTheStop) {
  const ProgramRun run{.program = "G1X10F600\n", .inject = {{.after = 500ms, .byte = '!'}, {.after = 2s, .byte = '~'}}};
  const MotionTrace trace = trace_program(run, machine_of(Firmware::Grbl));
  ASSERT_EQ(trace.blocks.size(), 1U);
  EXPECT_LT(trace.blocks[0].end_s, 0.7);
  EXPECT_EQ(trace.final_steps.front(), 1000);
}

TEST(MotionTrace, ASlowLinkStarvesThePlanner) {
  const ProgramRun fast{.program = "G1X1F6000\nX2\nX3\nX4\nX5\n"};
  ProgramRun slow = fast;
  slow.link.baud = 300;
  const auto machine = machine_of(Firmware::GrblHal);
  EXPECT_GT(trace_program(slow, machine).total_s, trace_program(fast, machine).total_s + 0.3);
}

TEST(MotionTrace, RabbitDoesNotStopForAnEmptyDwell) {
  const ProgramRun run{.program = "G1X5F600\nG4P0\nG1X10\n"};
  const MotionTrace rabbit = trace_program(run, machine_of(Firmware::Rabbit));
  EXPECT_EQ(rabbit.blocks.at(1).start_s, rabbit.blocks.at(0).end_s);
  const MotionTrace grbl = trace_program(run, machine_of(Firmware::Grbl));
  EXPECT_GT(grbl.blocks.at(1).start_s, grbl.blocks.at(0).end_s);
}

TEST(MotionTrace, ALengthBeyondTheStepCounterEnds) {
  for (const Firmware firmware : {Firmware::Grbl, Firmware::GrblHal, Firmware::Rabbit}) {
    const MotionTrace trace = trace_program({.program = "G1X16777217F1000\n"}, machine_of(firmware));
    EXPECT_EQ(trace.lines_answered, 1U);
  }
}

TEST(MotionTrace, RefusedLinesAndThoseNeverAnswered) {
  const auto machine = machine_of(Firmware::Grbl);
  const MotionTrace trace = trace_program({.program = "G1X1\nG0X1\nM0\nG0X2\n"}, machine);
  ASSERT_EQ(trace.errors.size(), 1U);
  EXPECT_EQ(trace.errors[0].line, 1U);
  EXPECT_LT(trace.lines_answered, trace.lines);
}

}  // namespace
}  // namespace kerf::simulation
