#include <gtest/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

constexpr int kUnsupported = 20;
constexpr int kMissing = 28;
constexpr int kUnknownTool = 38;
constexpr int kOutOfRange = 39;

Bench machine_with_tools() {
  Bench bench(Firmware::GrblHal);
  bench.interpreter.settings().tools = 4;
  return bench;
}

TEST(ToolTable, WithoutOneItsWordsDoNotExist) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G43H1"), kUnsupported);
  EXPECT_EQ(bench.send("G43.2H1"), kUnsupported);
  EXPECT_EQ(bench.send("G10L1P1X1"), kUnsupported);
  EXPECT_EQ(bench.send("T99"), 0);
}

TEST(ToolTable, LengthsComeFromIt) {
  Bench bench = machine_with_tools();
  EXPECT_EQ(bench.send("G20G10L1P1Z1R0.5"), 0);
  EXPECT_EQ(bench.send("G21G10L1P2X3"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tools.at(1).radius_mm, 12.7F);
  EXPECT_EQ(bench.send("G43H1"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tool_length, (AxisValues{0, 0, 25.4F}));
  EXPECT_EQ(bench.send("G43.2H2"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tool_length, (AxisValues{3, 0, 25.4F}));
  EXPECT_EQ(bench.send("M61Q2"), 0);
  EXPECT_EQ(bench.send("G43"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tool_length, (AxisValues{3, 0, 0}));
}

TEST(ToolTable, KnowsItsToolsOnly) {
  Bench bench = machine_with_tools();
  EXPECT_EQ(bench.send("T4"), 0);
  EXPECT_EQ(bench.send("T5"), kUnknownTool);
  EXPECT_EQ(bench.send("M61Q5"), kUnknownTool);
  EXPECT_EQ(bench.send("G43H5"), kUnknownTool);
  EXPECT_EQ(bench.send("G10L1P5X1"), kUnknownTool);
  EXPECT_EQ(bench.send("G43.2"), kMissing);
  EXPECT_EQ(bench.send("G43.2H0"), kUnknownTool);
}

TEST(ToolTable, OnlyL1IsKept) {
  Bench bench = machine_with_tools();
  EXPECT_EQ(bench.send("G10L10P1Z5"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tools.at(1), Tool{});
  EXPECT_TRUE(bench.all<ToolTableWrite>().empty());
  EXPECT_EQ(bench.send("G10L1P1Z5"), 0);
  EXPECT_EQ(bench.all<ToolTableWrite>().size(), 1U);
}

TEST(ToolTable, LengthMayComeWithTheTool) {
  Bench bench = machine_with_tools();
  EXPECT_EQ(bench.send("G10L1P3Z7"), 0);
  EXPECT_EQ(bench.send("T3M6G43"), 0);
  EXPECT_EQ(bench.interpreter.offsets().tool_length, AxisValues{});
  bench.interpreter.complete_tool_change();
  EXPECT_EQ(bench.state().tool, 3U);
  EXPECT_EQ(bench.interpreter.offsets().tool_length, (AxisValues{0, 0, 7}));
}

TEST(Ports, WordsNeedThePorts) {
  Bench bench(Firmware::GrblHal);
  for (const char* line : {"M62P0", "M65P0", "M66P0L0", "M67E0Q1", "M68E0Q1"})
    EXPECT_EQ(bench.send(line), kUnsupported);
  bench.interpreter.settings().ports = {.digital_inputs = 2, .digital_outputs = 2};
  EXPECT_EQ(bench.send("M64P1"), 0);
  EXPECT_EQ(bench.send("M64P2"), kOutOfRange);
  EXPECT_EQ(bench.send("M64"), kMissing);
  EXPECT_EQ(bench.send("M68E0Q1"), kUnsupported);
  EXPECT_EQ(bench.send("M66P1L3Q2"), 0);
  EXPECT_EQ(bench.send("M66P1L3"), kOutOfRange);
  EXPECT_EQ(bench.send("M66P2L0"), kOutOfRange);
  EXPECT_EQ(bench.send("M66P1"), kMissing);
}

TEST(Ports, OutputsAreActions) {
  Bench bench(Firmware::GrblHal);
  bench.interpreter.settings().ports = {.digital_outputs = 2, .analog_outputs = 1};
  EXPECT_EQ(bench.send("M62P1"), 0);
  EXPECT_EQ(bench.send("M68E0Q2.5"), 0);
  const auto outputs = bench.all<PortOutput>();
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_EQ(outputs[0], (PortOutput{.digital = true, .with_motion = true, .port = 1, .value = 1}));
  EXPECT_EQ(outputs[1], (PortOutput{.digital = false, .with_motion = false, .port = 0, .value = 2.5F}));
}

}  // namespace
}  // namespace kerf::gcode
