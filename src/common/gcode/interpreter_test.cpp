#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

TEST(Interpreter, LinesAreTargetsInMachineCoordinates) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("G10L2P2X10Y20"), 0);
    EXPECT_EQ(bench.send("G55G0X1Z-3"), 0);
    EXPECT_EQ(bench.send("G91G1Y2F120"), 0);
    const auto lines = bench.all<LinearMove>();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].target_mm, (AxisValues{11, 0, -3}));
    EXPECT_TRUE(lines[0].feed.rapid);
    EXPECT_EQ(lines[1].target_mm, (AxisValues{11, 2, -3}));
    EXPECT_EQ(lines[1].feed.rate_mm_per_min, 120.0F);
    EXPECT_EQ(bench.state().position_mm, lines[1].target_mm);
  }
}

TEST(Interpreter, InchesScaleWordsButNotTheKeptFeed) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("F100"), 0);
    EXPECT_EQ(bench.send("G20G1X1"), 0);
    EXPECT_EQ(bench.send("X2F10"), 0);
    const auto lines = bench.all<LinearMove>();
    EXPECT_EQ(lines[0].target_mm[0], 25.4F);
    EXPECT_EQ(lines[0].feed.rate_mm_per_min, 100.0F);
    EXPECT_EQ(lines[1].feed.rate_mm_per_min, 254.0F);
  }
}

TEST(Interpreter, FeedIsForgottenBetweenModes) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("G1X1F100"), 0);
    EXPECT_EQ(bench.send("G93X2F2"), 0);
    EXPECT_EQ(bench.send("G94X3"), 22);
  }
}

TEST(Interpreter, RabbitRunsLinesOfNothingButComment) {
  Bench rabbit(Firmware::Rabbit);
  rabbit.send("N7G93G1X1F2");
  EXPECT_EQ(rabbit.send("(note)"), 0);
  EXPECT_EQ(rabbit.state().feed_rate, 0.0F);
  EXPECT_EQ(rabbit.state().line_number, 0);
  Bench grblhal(Firmware::GrblHal);
  grblhal.send("N7G93G1X1F2");
  grblhal.send("(note)");
  EXPECT_EQ(grblhal.state().feed_rate, 2.0F);
}

TEST(Interpreter, ArcsByCenterAndByRadiusAgree) {
  for (const Firmware firmware : kAllFirmwares) {
    for (const char* line : {"G2X2Y0I1J0F100", "G2X2Y0R1F100"}) {
      Bench bench(firmware);
      EXPECT_EQ(bench.send(line), 0);
      const auto arc = bench.all<ArcMove>().at(0);
      EXPECT_FLOAT_EQ(arc.center_offset_mm[0], 1.0F);
      EXPECT_NEAR(arc.center_offset_mm[1], 0.0F, 1e-6F);
      EXPECT_FLOAT_EQ(arc.radius_mm, 1.0F);
      EXPECT_TRUE(arc.clockwise);
      EXPECT_EQ(arc.turns, 1);
    }
  }
}

TEST(Interpreter, ArcPlanes) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("G18G3X2Z4I1K2F100"), 0);
    const auto arc = bench.all<ArcMove>().at(0);
    EXPECT_EQ(arc.plane, Plane::ZX);
    EXPECT_EQ(arc.center_offset_mm, (std::array<float, 2>{2, 1}));
    EXPECT_FALSE(arc.clockwise);
  }
}

TEST(Interpreter, HalfCircleByRadiusDependsOnTheFloats) {
  // motion.md 1.4: from X0.1 back through a half circle of radius 0.1. In single floats the square under the root is
  // not negative.
  const auto answer = [](Firmware firmware) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("G0X0.1"), 0);
    return bench.send("G3X-0.1Y0R0.1F100");
  };
  EXPECT_EQ(answer(Firmware::Grbl), 0);
  EXPECT_EQ(answer(Firmware::Rabbit), 34);
}

TEST(Interpreter, GrblHalTurnsAndFullCircles) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G2I5P3F100"), 0);
  const auto arc = bench.all<ArcMove>().at(0);
  EXPECT_EQ(arc.turns, 3);
  EXPECT_EQ(arc.target_mm, AxisValues{});
}

TEST(Interpreter, OffsetsFollowThePosition) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    bench.send("G0X10Y5Z2");
    EXPECT_EQ(bench.send("G92X0"), 0);
    EXPECT_EQ(bench.interpreter.offsets().g92[0], 10.0F);
    EXPECT_EQ(bench.send("G43.1Z1"), 0);
    EXPECT_EQ(bench.send("G10L20P1X4Z0"), 0);
    EXPECT_EQ(bench.interpreter.offsets().work[0][0], -4.0F);
    EXPECT_EQ(bench.interpreter.offsets().work[0][2], 1.0F);
    EXPECT_EQ(bench.interpreter.work_coordinate_offset(), (AxisValues{6, 0, 2}));
    EXPECT_EQ(bench.send("G92.1"), 0);
    EXPECT_EQ(bench.interpreter.offsets().g92, AxisValues{});
    EXPECT_EQ(bench.all<StoredOffsetWrite>().at(firmware == Firmware::GrblHal ? 1 : 0).which, StoredOffset::G54);
  }
}

TEST(Interpreter, GrblHalG92CanBeSuspended) {
  Bench bench(Firmware::GrblHal);
  bench.send("G92X-5");
  EXPECT_EQ(bench.send("G92.2"), 0);
  EXPECT_EQ(bench.interpreter.offsets().g92[0], 0.0F);
  EXPECT_EQ(bench.send("G92.3"), 0);
  EXPECT_EQ(bench.interpreter.offsets().g92[0], 5.0F);
}

TEST(Interpreter, StoredPlaces) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    bench.send("G0X5Y6Z7");
    EXPECT_EQ(bench.send("G28.1"), 0);
    bench.send("G0X0Y0Z0");
    bench.actions.clear();
    EXPECT_EQ(bench.send("G28X1"), 0);
    const auto lines = bench.all<LinearMove>();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].target_mm, (AxisValues{1, 0, 0}));
    EXPECT_EQ(lines[1].target_mm, (AxisValues{5, 0, 0}));
    EXPECT_EQ(bench.state().position_mm, lines[1].target_mm);
  }
}

TEST(Interpreter, ProgramEndResetsTheModes) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    bench.send("G10L2P2X1");
    bench.send("G55G18G91G20M3S100M8G93F1");
    EXPECT_EQ(bench.send("M30"), 0);
    ModalState expected;
    expected.motion = MotionMode::Linear;
    expected.inches = true;
    EXPECT_EQ(bench.state().modal, expected);
    EXPECT_EQ(bench.state().spindle_rpm, 100.0F);
    EXPECT_EQ(bench.state().work_offset_mm, AxisValues{});
    EXPECT_EQ(bench.all<ProgramEnd>().at(0).restores_overrides, firmware != Firmware::GrblHal);
  }
}

TEST(Interpreter, SpindleAndCoolant) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    EXPECT_EQ(bench.send("M3S500"), 0);
    EXPECT_EQ(bench.send("S700"), 0);
    EXPECT_EQ(bench.send("M5"), 0);
    EXPECT_EQ(bench.actions.at(0), Action(SpindleChange{SpindleDirection::Clockwise, 500.0F}));
    EXPECT_EQ(bench.actions.at(1), Action(SpindleSpeedChange{700.0F}));
    EXPECT_EQ(bench.actions.at(2), Action(SpindleChange{SpindleDirection::Off, 700.0F}));
    bench.actions.clear();
    bench.send("M8");
    bench.send("M9");
    bench.send("M9");
    EXPECT_EQ(bench.all<CoolantChange>().size(), firmware == Firmware::Rabbit ? 3U : 2U);
  }
}

TEST(Interpreter, LaserChangesPowerWithTheMotion) {
  Bench bench(Firmware::Grbl, {.laser_mode = true});
  bench.send("M4S100");
  bench.actions.clear();
  bench.send("G1X1F100S200");
  bench.send("G0X2");
  EXPECT_TRUE(bench.all<SpindleSpeedChange>().empty());
  const auto lines = bench.all<LinearMove>();
  EXPECT_EQ(lines[0].feed.spindle_rpm, 200.0F);
  EXPECT_TRUE(lines[0].feed.laser_dynamic);
  EXPECT_EQ(lines[1].feed.spindle_rpm, 0.0F);
}

TEST(Interpreter, ConstantLaserPowerIsOffWithoutCuttingMode) {
  Bench bench(Firmware::Grbl, {.laser_mode = true});
  bench.send("G1F100M3S100");
  bench.actions.clear();
  bench.send("G0");
  EXPECT_EQ(bench.all<SpindleSpeedChange>().at(0).rpm, 0.0F);
}

TEST(Interpreter, ToolWords) {
  Bench grbl(Firmware::Grbl);
  grbl.send("T3");
  EXPECT_EQ(grbl.state().tool, 3U);
  grbl.send("G0");
  EXPECT_EQ(grbl.state().tool, 0U);

  Bench rabbit(Firmware::Rabbit);
  EXPECT_EQ(rabbit.send("T3G99"), 20);
  EXPECT_EQ(rabbit.state().tool, 3U);

  Bench grblhal(Firmware::GrblHal);
  grblhal.send("T3");
  EXPECT_EQ(grblhal.state().tool, 0U);
  EXPECT_EQ(grblhal.send("M6"), 0);
  EXPECT_EQ(grblhal.all<ToolChange>().at(0).tool, 3);
  EXPECT_EQ(grblhal.send("G0X1"), 40);
  grblhal.interpreter.complete_tool_change();
  EXPECT_EQ(grblhal.state().tool, 0U) << "the failed line dropped the new tool";
  grblhal.send("M6");
  grblhal.interpreter.complete_tool_change();
  EXPECT_EQ(grblhal.state().tool, 3U);
  EXPECT_EQ(grblhal.send("M6T3"), 0);
  EXPECT_FALSE(grblhal.state().tool_change_pending);
}

TEST(Interpreter, GrblHalMessages) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("(MSG, Mind the gap)"), 0);
  EXPECT_EQ(bench.send("G0X1 (msg,x)(MSG,y) ; (MSG,z)"), 0);
  EXPECT_EQ(bench.send("G0X (MSG,never)"), 2);
  const auto messages = bench.all<OperatorMessage>();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].text, "Mind the gap");
  EXPECT_EQ(messages[1].text, "x");
}

TEST(Interpreter, GrblHalBlockDeleteAndOptionalStop) {
  Bench bench(Firmware::GrblHal);
  bench.send("M1");
  EXPECT_EQ(bench.all<ProgramPause>().size(), 1U);
  bench.interpreter.settings().optional_stop_disabled = true;
  bench.interpreter.settings().block_delete = true;
  bench.send("M1");
  bench.send("/M0");
  EXPECT_EQ(bench.all<ProgramPause>().size(), 1U);
}

TEST(Interpreter, GrblHalOverrideControl) {
  Bench bench(Firmware::GrblHal);
  bench.send("M48");
  EXPECT_TRUE(bench.actions.empty());
  bench.send("M50P0");
  bench.send("G1X1F100");
  EXPECT_FALSE(bench.all<OverrideControl>().at(0).feed_enabled);
  EXPECT_TRUE(bench.all<LinearMove>().at(0).feed.no_override);
}

TEST(Interpreter, GrblHalDrillsAndRepeats) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G81X1Z-1R1F100"), 0);
  EXPECT_EQ(bench.send("X2"), 0);
  EXPECT_EQ(bench.send("G80"), 0);
  std::vector<float> heights;
  for (const LinearMove& line : bench.all<LinearMove>()) heights.push_back(line.target_mm[2]);
  EXPECT_EQ(heights, (std::vector<float>{1, 1, -1, 1, 1, -1, 1}));
  EXPECT_EQ(bench.state().position_mm, (AxisValues{2, 0, 1}));
}

TEST(Interpreter, GrblHalPecksWithDwell) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G73Z-2R0Q1F100"), 0);
  std::vector<float> heights;
  for (const LinearMove& line : bench.all<LinearMove>()) heights.push_back(line.target_mm[2]);
  EXPECT_EQ(heights, (std::vector<float>{0, -1, -0.9F, -2, 0}));
  EXPECT_EQ(bench.all<Dwell>().size(), 2U);
}

TEST(Interpreter, GrblHalScales) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G51X2Y-1"), 0);
  EXPECT_EQ(bench.send("G0X11Y1"), 0);
  EXPECT_EQ(bench.state().position_mm, (AxisValues{22, -1, 0}));
  EXPECT_EQ(bench.send("G2X12Y1I.5F100"), 0);
  EXPECT_FALSE(bench.all<ArcMove>().at(0).clockwise) << "mirrored";
  EXPECT_EQ(bench.send("G50"), 0);
  EXPECT_EQ(bench.send("G0X11"), 0);
  EXPECT_EQ(bench.state().position_mm[0], 11.0F);
}

TEST(Interpreter, GrblHalSplinesEndAtTheTarget) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G5X10Y10I3J0P0Q-3F100"), 0);
  const auto lines = bench.all<LinearMove>();
  ASSERT_GT(lines.size(), 5U);
  EXPECT_EQ(lines.back().target_mm, (AxisValues{10, 10, 0}));
  EXPECT_EQ(bench.send("G5X20Y10I1P1Q1"), 0);
  EXPECT_EQ(bench.send("G5.1X20Y10I1"), 28);
}

TEST(Interpreter, GrblHalModalMacroFailsAfterTheMotion) {
  Bench bench(Firmware::GrblHal);
  EXPECT_EQ(bench.send("G66P100"), 0);
  EXPECT_EQ(bench.send("G0X1"), 39);
  EXPECT_EQ(bench.all<LinearMove>().size(), 1U);
  EXPECT_EQ(bench.send("G0X2"), 0) << "any failure ends G66";
}

TEST(Interpreter, GrblHalSavesAndRestoresModes) {
  Bench bench(Firmware::GrblHal);
  bench.send("G91G18F100G55");
  bench.send("M70");
  bench.send("G90G17F200G54");
  EXPECT_EQ(bench.send("M72"), 0);
  EXPECT_TRUE(bench.state().modal.incremental);
  EXPECT_EQ(bench.state().modal.plane, Plane::ZX);
  EXPECT_EQ(bench.state().modal.work_offset, 1);
  EXPECT_EQ(bench.state().feed_rate, 100.0F);
}

TEST(Interpreter, Jogs) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    bench.send("G0X5");
    const auto jog = bench.interpreter.interpret_jog("G91G20X1F10");
    ASSERT_TRUE(jog);
    EXPECT_FLOAT_EQ(jog->target_mm[0], 30.4F);
    EXPECT_EQ(jog->feed.rate_mm_per_min, 254.0F);
    EXPECT_EQ(bench.state().position_mm[0], 5.0F) << "until the owner accepts it";
    EXPECT_FALSE(bench.state().modal.incremental);

    const auto code = [&bench](std::string_view text) {
      return static_cast<int>(bench.interpreter.interpret_jog(text).error());
    };
    EXPECT_EQ(code(""), 22);
    EXPECT_EQ(code("G91X1"), 22);
    EXPECT_EQ(code("G91X1F100S1"), 36);
    EXPECT_EQ(code("G91X1F100M3"), 16);
    EXPECT_EQ(code("G92X1F100"), 16);
    EXPECT_EQ(code("X"), 2);
  }
}

TEST(Interpreter, ResetKeepsWhatTheFirmwareKeeps) {
  for (const Firmware firmware : kAllFirmwares) {
    const bool keeps = firmware == Firmware::GrblHal;
    Bench bench(firmware);
    bench.send(keeps ? "M61Q2" : "T2");
    bench.send("G0X1T2");
    bench.send("G92X0T2");
    bench.send("G43.1Z3T2");
    bench.interpreter.reset();
    EXPECT_EQ(bench.state().modal, ModalState{});
    EXPECT_EQ(bench.state().position_mm[0], 1.0F);
    EXPECT_EQ(bench.state().tool, keeps ? 2U : 0U);
    EXPECT_EQ(bench.interpreter.offsets().g92[0], keeps ? 1.0F : 0.0F);
    EXPECT_EQ(bench.interpreter.offsets().tool_length[2], keeps ? 3.0F : 0.0F);
  }
}

TEST(Interpreter, AxesBeyondThree) {
  Bench rabbit(Firmware::Rabbit, {.axes = 4});
  EXPECT_EQ(rabbit.send("G0A90"), 0);
  EXPECT_EQ(rabbit.send("G0B90"), 20);
  Bench grblhal(Firmware::GrblHal, {.axes = 5, .rotary_axes = 0x18});
  EXPECT_EQ(grblhal.send("G20G0X1A90"), 0);
  EXPECT_EQ(grblhal.state().position_mm[0], 25.4F);
  EXPECT_EQ(grblhal.state().position_mm[3], 90.0F);
}

}  // namespace
}  // namespace kerf::gcode
