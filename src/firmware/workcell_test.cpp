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

TEST(Workcell, SurfacesNeedNotBeFlat) {
  Workcell workcell;
  workcell.apply(ProbeSurfaceMoved{.z_mm = -3.0, .shape = {.tilt_x = 0.01, .tilt_y = -0.02}});
  EXPECT_EQ(workcell.surface_step(AxisSteps{}, machine()), -300);
  EXPECT_EQ(workcell.surface_step(AxisSteps{10000, 5000, 0}, machine()), -300);
  EXPECT_EQ(workcell.surface_step(AxisSteps{10000, 0, 0}, machine()), -200);
  workcell.apply(ProbeSurfaceMoved{.z_mm = -3.0, .shape = {.wave_mm = 0.5, .wave_length_mm = 40}});
  EXPECT_EQ(workcell.surface_step(AxisSteps{}, machine()), -300);
  EXPECT_EQ(workcell.surface_step(AxisSteps{1000, 1000, 0}, machine()), -250);
  EXPECT_EQ(workcell.surface_step(AxisSteps{1000, 3000, 0}, machine()), -350);
}

TEST(Workcell, TheWorldStaysWhereItIsWhenTheMotorsCountAgain) {
  Workcell workcell;
  workcell.apply(ProbeSurfaceMoved{.z_mm = -3.0});
  workcell.restart_count(AxisSteps{500, 0, -100});
  EXPECT_EQ(workcell.homing_switch_step(0, machine()), 19500);
  EXPECT_EQ(workcell.surface_step(AxisSteps{}, machine()), -200);
  EXPECT_FALSE(workcell.probe_at(AxisSteps{0, 0, -199}, machine()));
  EXPECT_TRUE(workcell.probe_at(AxisSteps{0, 0, -200}, machine()));
}

TEST(Workcell, AMotorThatDoesNotFollowMeetsItsSwitchLater) {
  Workcell workcell;
  workcell.apply(StepsLost{.axis = Axis::X, .steps = 40});
  workcell.apply(StepsLost{.axis = Axis::Y, .steps = -7});
  EXPECT_EQ(workcell.homing_switch_step(0, machine()), 20040);
  EXPECT_EQ(workcell.homing_switch_step(1, machine()), -20007);
  EXPECT_EQ(workcell.homing_switch_step(2, machine()), 5000);
}

}  // namespace
}  // namespace kerf::firmware
