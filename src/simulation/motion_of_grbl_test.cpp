// Figures of unchanged Grbl 1.1h on a simulated clock: what happens around its motion, to the pass of its main loop.

#include <array>
#include <chrono>

#include <gtest/gtest.h>

#include "simulation/motion_trace.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;

constexpr double kTick_s = 0.000'4;

CaseMachine grbl_with(const char* homing) {
  CaseMachine machine{.personality = firmware::personality_of(vocabulary::Firmware::Grbl)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"100", "80"},   {"101", "80"},  {"102", "400"}, {"110", "5000"}, {"111", "5000"},
                             {"112", "1500"}, {"120", "310"}, {"121", "290"}, {"122", "110"},  {"130", "30"},
                             {"131", "30"},   {"132", "20"},  {"1", "25"},    {"11", "0.02"},  {"12", "0.0005"},
                             {"24", "100"},   {"25", "1000"}, {"26", "100"},  {"27", "1.5"},   {"22", homing}};
  return machine;
}

void place_switches(CaseMachine& machine, std::array<double, 3> distance_mm) {
  for (std::size_t axis = 0; axis < distance_mm.size(); ++axis) {
    machine.workcell.emplace_back(
        firmware::HomingSwitchMoved{.axis = static_cast<vocabulary::Axis>(axis), .distance_mm = distance_mm.at(axis)});
  }
}

TEST(MotionOfGrbl, HomingMovesAreBlocksOfTheTrace) {
  CaseMachine machine = grbl_with("1");
  place_switches(machine, {10, 12, 5});
  const MotionTrace trace = trace_program({.program = "$H\nG0X-5\n"}, machine);
  ASSERT_EQ(trace.blocks.size(), 9U);
  const double ends_s[] = {0.376'05,  0.709'714, 1.717'05,  2.050'714, 2.899'67,
                           3.147'192, 4.147'34,  4.394'862, 4.732'486};
  for (std::size_t i = 0; i < trace.blocks.size(); ++i) EXPECT_NEAR(trace.blocks[i].end_s, ends_s[i], 0.002) << i;
  EXPECT_NEAR(trace.blocks[4].length_mm, 63.639'61, 1e-5);
  EXPECT_NEAR(trace.blocks[6].rate_mm_per_min, 141.421, 1e-3);
  EXPECT_EQ(trace.blocks[1].end_steps, (vocabulary::AxisSteps{0, 0, -600}));
  EXPECT_EQ(trace.final_steps, (std::vector<std::int32_t>{-400, -120, -600}));
}

TEST(MotionOfGrbl, AJogCancelStopsAndItsRowEndsBeforeTheMotorsAreReleased) {
  const MotionTrace trace =
      trace_program({.program = "$J=G91X20F2000\n", .inject = {{.after = 250ms, .byte = 0x85}}}, grbl_with("0"));
  ASSERT_EQ(trace.blocks.size(), 1U);
  EXPECT_NEAR(trace.blocks[0].end_s, 0.399'272, kTick_s);
  EXPECT_EQ(trace.final_steps.front(), 799);
}

TEST(MotionOfGrbl, LinesAreReadWhileAHoldSlowsDown) {
  const ProgramRun run{.program = "G1X40F1800\nG1X40Y1\nG1X41Y2\nG1X42Y0\nG1X50\n",
                       .inject = {{.after = 700ms, .byte = '!'},
                                  {.after = 1400ms, .byte = '~'},
                                  {.after = 1750ms, .byte = '!'},
                                  {.after = 2500ms, .byte = '~'}}};
  const MotionTrace trace = trace_program(run, grbl_with("0"));
  ASSERT_EQ(trace.blocks.size(), 5U);
  EXPECT_NEAR(trace.blocks[0].start_s, 0.000'02, 1e-6);
  EXPECT_NEAR(trace.blocks[0].end_s, 0.838'856, kTick_s);
  EXPECT_EQ(trace.blocks[0].end_steps.front(), 1799);
  EXPECT_NEAR(trace.blocks[1].end_s, 2.860'819, kTick_s);
  EXPECT_NEAR(trace.total_s, 3.439'983, kTick_s);
}

TEST(MotionOfGrbl, ASettingCountsAsItWasWritten) {
  // `$$` prints $12 as 0.000 or 0.001.
  const MotionTrace trace = trace_program({.program = "G2X10I5F900\n"}, grbl_with("0"));
  EXPECT_EQ(trace.blocks.size(), 111U);
  EXPECT_NEAR(trace.total_s, 1.100'132, kTick_s);
}

}  // namespace
}  // namespace kerf::simulation
