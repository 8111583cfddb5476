#include "common/motion/planner.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "common/motion/motion_test_machine.hpp"

namespace kerf::motion {
namespace {

using testing::feed;
using testing::line_to;
using testing::plain_settings;
using testing::rapid;
using vocabulary::Firmware;

constexpr Firmware kAll[] = {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

TEST(Planner, HoldsAsManyBlocksAsTheFirmware) {
  Planner grbl(rules_of(Firmware::Grbl), plain_settings());
  EXPECT_EQ(grbl.free_blocks(), 15);
  Planner grblhal(rules_of(Firmware::GrblHal), plain_settings());
  EXPECT_EQ(grblhal.free_blocks(), 100);
  MotionSettings small = plain_settings();
  small.planner_blocks = 35;
  Planner board(rules_of(Firmware::GrblHal), small);
  EXPECT_EQ(board.free_blocks(), 35);

  for (int i = 1; i <= 15; ++i) grbl.plan(line_to({static_cast<float>(i)}, rapid()));
  EXPECT_TRUE(grbl.is_full());
  EXPECT_EQ(grbl.block_count(), 15);
  grbl.clear();
  EXPECT_TRUE(grbl.is_empty());
}

TEST(Planner, DropsALineOfLessThanHalfAStep) {
  Planner planner(rules_of(Firmware::Grbl), plain_settings());
  EXPECT_EQ(planner.plan(line_to({0.004F}, rapid())), Planner::Added::Dropped);
  EXPECT_TRUE(planner.is_empty());
  EXPECT_EQ(planner.plan(line_to({0.006F}, rapid())), Planner::Added::Queued);
  EXPECT_EQ(planner.position_steps()[0], 1);
  // The length is that of the steps, not of the numbers.
  EXPECT_FLOAT_EQ(planner.current()->length_mm, 0.01F);
}

TEST(Planner, LimitsRateAndAccelerationByTheSlowestAxis) {
  for (const Firmware firmware : kAll) {
    Planner planner(rules_of(firmware), testing::router_settings());
    // Direction 0.6, 0, 0.8: Z allows 1500 / 0.8 mm/min and 110 / 0.8 mm/s².
    planner.plan(line_to({6, 0, 8}, rapid()));
    EXPECT_FLOAT_EQ(planner.current()->rapid_rate, 1875.0F);
    EXPECT_FLOAT_EQ(planner.current()->programmed_rate, 1875.0F);
    EXPECT_FLOAT_EQ(planner.current()->acceleration, 137.5F * 3600.0F);
  }
}

TEST(Planner, InverseTimeMakesTheRateFromTheLength) {
  Planner planner(rules_of(Firmware::Grbl), plain_settings());
  planner.plan(line_to({30, 40}, {.rate_mm_per_min = 2, .inverse_time = true}));
  EXPECT_FLOAT_EQ(planner.current()->programmed_rate, 100.0F);
}

/// Junction limit of the second of two lines.
float second_junction(Firmware firmware, const AxisValues& corner, const AxisValues& end) {
  Planner planner(rules_of(firmware), plain_settings());
  planner.plan(line_to(corner, feed(1200)));
  planner.plan(line_to(end, feed(1200)));
  return planner.at(1).max_junction_speed_sqr;
}

TEST(Planner, JunctionSpeedFollowsTheDeviation) {
  for (const Firmware firmware : kAll) {
    // Right angle: the acceleration along the turn is 100·√2 mm/s², sin(θ/2) = √½, v² = a·d·s/(1 − s), here in
    // (mm/min)².
    const double s = std::sqrt(0.5);
    const double expected = 100.0 * std::sqrt(2.0) * 3600.0 * 0.01 * s / (1.0 - s);
    EXPECT_NEAR(second_junction(firmware, {50}, {50, 50}), expected, expected * 1e-5);
    EXPECT_EQ(second_junction(firmware, {50}, {0}), 0.0F) << "reversal";
    EXPECT_GT(second_junction(firmware, {50}, {100}), 1e37F) << "straight on";
  }
}

TEST(Planner, EntrySpeedsCanAlwaysStopInWhatIsQueued) {
  Planner planner(rules_of(Firmware::Grbl), plain_settings());
  // 1 mm at 100 mm/s²: v² = 2·a·s, in mm²/min² 2·360000·1 for one block, twice that for two.
  planner.plan(line_to({1}, feed(12000)));
  planner.plan(line_to({2}, feed(12000)));
  planner.plan(line_to({3}, feed(12000)));
  EXPECT_EQ(planner.at(0).entry_speed_sqr, 0.0F);
  EXPECT_FLOAT_EQ(planner.at(1).entry_speed_sqr, 720000.0F);
  EXPECT_FLOAT_EQ(planner.at(2).entry_speed_sqr, 720000.0F);
  planner.plan(line_to({4}, feed(12000)));
  EXPECT_FLOAT_EQ(planner.at(2).entry_speed_sqr, 1440000.0F);
  EXPECT_FLOAT_EQ(planner.at(3).entry_speed_sqr, 720000.0F);
}

TEST(Planner, OverridesReplanWhatIsQueued) {
  Planner planner(rules_of(Firmware::Grbl), plain_settings());
  planner.plan(line_to({50}, feed(1200)));
  planner.plan(line_to({100}, feed(1200)));
  planner.plan(line_to({150}, {.rate_mm_per_min = 1200, .no_override = true}));
  planner.plan(line_to({200}, rapid()));
  EXPECT_FLOAT_EQ(planner.at(1).max_entry_speed_sqr, 1200.0F * 1200.0F);
  planner.set_feed_override(50);
  EXPECT_FLOAT_EQ(planner.at(1).max_entry_speed_sqr, 600.0F * 600.0F);
  EXPECT_FLOAT_EQ(planner.at(2).max_entry_speed_sqr, 600.0F * 600.0F) << "slower neighbour";
  EXPECT_FLOAT_EQ(planner.at(3).max_entry_speed_sqr, 1200.0F * 1200.0F) << "not overridden";
  planner.set_feed_override(200);
  EXPECT_FLOAT_EQ(planner.at(1).max_entry_speed_sqr, 2400.0F * 2400.0F);
  planner.set_rapid_override(5);
  EXPECT_FLOAT_EQ(planner.at(3).max_entry_speed_sqr, 600.0F * 600.0F);
}

TEST(Planner, OnlyGrblhalCapsAFeedBeforeItsOverride) {
  for (const auto& [firmware, expected] : {std::pair{Firmware::Grbl, 12000.0F}, {Firmware::GrblHal, 6000.0F}}) {
    Planner planner(rules_of(firmware), plain_settings());
    planner.set_feed_override(50);
    planner.plan(line_to({50}, feed(24000)));
    planner.plan(line_to({100}, feed(24000)));
    EXPECT_FLOAT_EQ(planner.at(1).max_entry_speed_sqr, expected * expected) << name_of(firmware);
  }
}

TEST(Planner, BacklashTakeUpMovesNoPosition) {
  Planner planner(rules_of(Firmware::Rabbit), plain_settings());
  PathLine take_up = line_to({0.1F}, feed(20000));
  take_up.is_backlash = true;
  EXPECT_EQ(planner.plan(take_up), Planner::Added::Queued);
  EXPECT_EQ(planner.position_steps()[0], 0);
}

TEST(Rules, DwellsOfGrblHalEndOnATick) {
  using namespace std::chrono_literals;
  const MotionRules& rules = rules_of(vocabulary::Firmware::GrblHal);
  // 49 ticks of 0.9999375 ms and what is left of the first one.
  const Instant begun{1ms};
  const Instant end = dwell_end(rules, begun, dwell_duration(rules, 0.02F));
  EXPECT_GT(end - begun, 49ms);
  EXPECT_LT(end - begun, 50ms);
  EXPECT_EQ(dwell_end(rules, begun, Duration{}), begun);
  EXPECT_EQ(dwell_end(rules_of(vocabulary::Firmware::Grbl), begun, 50ms), begun + 50ms);
}

}  // namespace
}  // namespace kerf::motion
