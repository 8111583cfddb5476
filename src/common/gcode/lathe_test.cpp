// grblHAL's lathe words ($32=2): G7, G8, G96 and G97.

#include <numbers>

#include <gtest/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

Bench lathe() {
  InterpreterSettings settings;
  settings.lathe_mode = true;
  settings.spindle_rpm_max = 12000.0F;
  return Bench(Firmware::GrblHal, settings);
}

TEST(Lathe, WordsExistInLatheModeOnly) {
  for (const char* line : {"G7", "G8", "G96S100", "G97", "G7.1"}) EXPECT_EQ(Bench(Firmware::GrblHal).send(line), 20);
  for (const char* line : {"G7", "G8", "G96S100", "G97"}) EXPECT_EQ(lathe().send(line), 0) << line;
  EXPECT_EQ(lathe().send("G7.1"), 23);
}

TEST(Lathe, DiametersAreHalved) {
  Bench bench = lathe();
  EXPECT_EQ(bench.send("G7G0X10Z3"), 0);
  EXPECT_EQ(bench.send("G8X10"), 0);
  const auto lines = bench.all<LinearMove>();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].target_mm, (AxisValues{5, 0, 3}));
  EXPECT_EQ(lines[1].target_mm, (AxisValues{10, 0, 3}));
}

TEST(Lathe, SurfaceSpeedWantsSpeedAndARunningSpindle) {
  EXPECT_EQ(lathe().send("G96"), 28);
  EXPECT_EQ(lathe().send("G96S100D-1"), 4);
  Bench bench = lathe();
  EXPECT_EQ(bench.send("G18G96S100D2000"), 0);
  EXPECT_EQ(bench.send("G1X5F100"), 41);
}

TEST(Lathe, SpeedFollowsTheRadius) {
  Bench bench = lathe();
  EXPECT_EQ(bench.send("G18M3S500"), 0);
  EXPECT_EQ(bench.send("G0X20"), 0);
  EXPECT_EQ(bench.send("G96S100D2000"), 0);
  EXPECT_EQ(bench.send("G1X10F100"), 0);
  EXPECT_NEAR(bench.state().spindle_rpm, 100'000.0 / (20.0 * 2.0 * std::numbers::pi), 0.01);
  EXPECT_EQ(bench.send("G97"), 0);
  EXPECT_FALSE(bench.state().modal.surface_speed);
}

}  // namespace
}  // namespace kerf::gcode
