#include "firmware/workcell.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

using vocabulary::Axis;
using vocabulary::AxisSteps;

Workcell::Geometry machine() {
  return {.axes = 3, .steps_per_mm = {100, 100, 100}, .travel_mm = {200, 200, 50}, .homing_negative = 0b010};
}

TEST(Workcell, HomingSwitchesSitAtTheEndOfTravel) {
  const Workcell workcell;
  EXPECT_EQ(workcell.limits_at(AxisSteps{}, machine()), 0);
  EXPECT_EQ(workcell.homing_switch_step(0, machine()), 20000);
  EXPECT_EQ(workcell.homing_switch_step(1, machine()), -20000);
  EXPECT_EQ(workcell.limits_at(AxisSteps{20000, -19999, 5000}, machine()), 0b101);
  EXPECT_EQ(workcell.limits_at(AxisSteps{0, -20000, 0}, machine()), 0b010);
}

TEST(Workcell, SwitchesMoveAndVanish) {
  Workcell workcell;
  workcell.apply(HomingSwitchMoved{.axis = Axis::X, .distance_mm = 12.5});
  workcell.apply(HomingSwitchMoved{.axis = Axis::Z, .distance_mm = std::nullopt});
  EXPECT_EQ(workcell.homing_switch_step(0, machine()), 1250);
  EXPECT_EQ(workcell.homing_switch_step(2, machine()), std::nullopt);
}

TEST(Workcell, HandsHoldSwitches) {
  Workcell workcell;
  workcell.apply(LimitHeld{.axis = Axis::Y, .active = true});
  EXPECT_EQ(workcell.limits_at(AxisSteps{}, machine()), 0b010);
  workcell.apply(LimitHeld{.axis = Axis::Y, .active = false});
  EXPECT_EQ(workcell.limits_at(AxisSteps{}, machine()), 0);
}

TEST(Workcell, ProbeTouchesTheSurfaceOrIsPressed) {
  Workcell workcell;
  EXPECT_FALSE(workcell.probe_at(AxisSteps{0, 0, -100000}, machine()));
  workcell.apply(ProbeSurfaceMoved{.z_mm = -3.0});
  EXPECT_FALSE(workcell.probe_at(AxisSteps{0, 0, -299}, machine()));
  EXPECT_TRUE(workcell.probe_at(AxisSteps{0, 0, -300}, machine()));
  workcell.apply(ProbeSurfaceMoved{});
  workcell.apply(InputChanged{.input = Input::Probe, .active = true});
  EXPECT_TRUE(workcell.probe_at(AxisSteps{}, machine()));
}

}  // namespace
}  // namespace kerf::firmware
