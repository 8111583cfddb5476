#include "common/motion/arc.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::motion {
namespace {

using vocabulary::Firmware;

constexpr Firmware kAll[] = {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};
constexpr MotionSettings kSettings{.axes = 3, .arc_tolerance_mm = 0.002F};

std::vector<AxisValues> chords_of(const Arc& arc, Firmware firmware, const MotionSettings& settings = kSettings) {
  ArcChords chords(arc, rules_of(firmware), settings);
  std::vector<AxisValues> ends;
  while (const auto end = chords.next()) ends.push_back(*end);
  return ends;
}

Arc full_circle(float radius) {
  return {.start_mm = {radius}, .target_mm = {radius}, .center_offset_mm = {-radius, 0}, .radius_mm = radius};
}

TEST(ArcChords, CountFollowsTheTolerance) {
  // ⌊½·2π·10 / √(0.002·(2·10 − 0.002))⌋ = ⌊31.416 / 0.19999⌋
  for (const Firmware firmware : kAll) EXPECT_EQ(chords_of(full_circle(10), firmware).size(), 157U);
}

TEST(ArcChords, StayWithinTheToleranceAndEndOnTheTarget) {
  for (const Firmware firmware : kAll) {
    for (const bool clockwise : {false, true}) {
      Arc arc = full_circle(25);
      arc.clockwise = clockwise;
      const auto ends = chords_of(arc, firmware);
      for (const auto& end : ends) EXPECT_NEAR(std::hypot(end[0], end[1]), 25.0, 0.002);
      EXPECT_EQ(ends.back()[0], 25.0F);
      EXPECT_EQ(ends.back()[1], 0.0F);
      EXPECT_EQ(ends.front()[1] < 0, clockwise);
    }
  }
}

TEST(ArcChords, TooSmallAnArcIsOneLine) {
  for (const Firmware firmware : kAll) {
    // Radius of the tolerance, and one so small that the tolerance does not fit into it.
    for (const float radius : {0.002F, 0.0005F}) {
      const Arc arc{
          .start_mm = {radius}, .target_mm = {0, radius}, .center_offset_mm = {-radius, 0}, .radius_mm = radius};
      const auto ends = chords_of(arc, firmware);
      ASSERT_EQ(ends.size(), 1U);
      EXPECT_EQ(ends[0], arc.target_mm);
      EXPECT_TRUE(ArcChords(arc, rules_of(firmware), kSettings).is_one_line());
      EXPECT_EQ(ArcChords(arc, rules_of(firmware), kSettings).inverse_time_factor(), 1);
    }
  }
}

TEST(ArcChords, HelixRisesEvenlyAndInverseTimeCountsChords) {
  Arc arc = full_circle(10);
  arc.target_mm[2] = 15.7F;
  for (const Firmware firmware : kAll) {
    const auto ends = chords_of(arc, firmware);
    EXPECT_NEAR(ends[0][2], 0.1, 1e-5);
    EXPECT_NEAR(ends[78][2], 7.9, 1e-3);
    EXPECT_EQ(ends.back()[2], 15.7F);
    EXPECT_EQ(ArcChords(arc, rules_of(firmware), kSettings).inverse_time_factor(), 157);
  }
}

TEST(ArcChords, WorksInTheOtherPlanes) {
  // G18: Z is the first axis, X the second.
  const Arc arc{.start_mm = {0, 0, 10},
                .target_mm = {10, 0, 0},
                .center_offset_mm = {-10, 0},
                .radius_mm = 10,
                .plane_axes = {2, 0, 1}};
  const auto ends = chords_of(arc, Firmware::Grbl);
  EXPECT_EQ(ends.size(), 39U);
  for (const auto& end : ends) EXPECT_NEAR(std::hypot(end[0], end[2]), 10.0, 0.002);
  EXPECT_EQ(ends.back(), arc.target_mm);
}

TEST(ArcChords, OnlyGrblhalTakesOtherAxesAlong) {
  MotionSettings four_axes = kSettings;
  four_axes.axes = 4;
  Arc arc = full_circle(10);
  arc.target_mm[3] = 90;
  EXPECT_EQ(chords_of(arc, Firmware::Rabbit, four_axes)[100][3], 0.0F);
  EXPECT_NEAR(chords_of(arc, Firmware::GrblHal, four_axes)[100][3], 90.0 * 101 / 157, 1e-2);
  EXPECT_EQ(chords_of(arc, Firmware::Rabbit, four_axes).back()[3], 90.0F);
}

TEST(ArcChords, TurnsComeBeforeTheRest) {
  // Two full turns and a quarter, 9 mm up: 4 mm a turn.
  Arc arc = full_circle(10);
  arc.target_mm = {0, 10, 9};
  arc.turns = 3;
  const auto ends = chords_of(arc, Firmware::GrblHal);
  EXPECT_EQ(ends.size(), 157U + 157U + 39U);
  EXPECT_NEAR(ends[156][2], 4.0, 1e-4);
  EXPECT_EQ(ends[156][0], 10.0F);
  EXPECT_NEAR(ends[313][2], 8.0, 1e-4);
  EXPECT_EQ(ends.back(), arc.target_mm);
}

}  // namespace
}  // namespace kerf::motion
