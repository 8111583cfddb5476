#include "firmware/backlash.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

using vocabulary::AxisValues;

constexpr AxisValues kPlay{0.1F, 0.2F};

TEST(Backlash, TheFirstMoveCountsAsATurn) {
  Backlash backlash;
  EXPECT_EQ(backlash.turn_to({1.0F}, kPlay), AxisValues{0.1F});
  EXPECT_FALSE(backlash.turn_to({2.0F}, kPlay));
}

TEST(Backlash, AllAxesThatTurnAreTakenUpTogether) {
  Backlash backlash;
  static_cast<void>(backlash.turn_to({1.0F, 1.0F}, kPlay));
  EXPECT_EQ(backlash.turn_to({0.0F, 0.0F}, kPlay), (AxisValues{1.0F - 0.1F, 1.0F - 0.2F}));
}

TEST(Backlash, AxesWithoutPlayNeverTurn) {
  Backlash backlash;
  EXPECT_FALSE(backlash.turn_to({1.0F, -1.0F, 3.0F}, {}));
  EXPECT_FALSE(backlash.turn_to({0.0F, 0.0F, 0.0F}, {}));
}

TEST(Backlash, AStandingAxisKeepsItsDirection) {
  Backlash backlash;
  static_cast<void>(backlash.turn_to({1.0F}, kPlay));
  EXPECT_EQ(backlash.turn_to({1.0F, 1.0F}, kPlay), (AxisValues{1.0F, 0.2F}));
  EXPECT_FALSE(backlash.turn_to({2.0F, 1.0F}, kPlay));
}

TEST(Backlash, HomingForgetsDirectionsAProbeDoesNot) {
  Backlash backlash;
  static_cast<void>(backlash.turn_to({1.0F}, kPlay));
  backlash.stand_at({0.5F});
  EXPECT_FALSE(backlash.turn_to({2.0F}, kPlay));
  backlash.forget({});
  EXPECT_TRUE(backlash.turn_to({1.0F}, kPlay));
}

}  // namespace
}  // namespace kerf::firmware
