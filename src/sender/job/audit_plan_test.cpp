#include "sender/job/audit_plan.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::job {
namespace {

using machine::Capabilities;
using machine::Snapshot;
using testing::HasSubstr;
using vocabulary::Firmware;
using vocabulary::MachineState;

Capabilities machine_with(const std::map<std::string, std::string>& changes, Firmware family = Firmware::Grbl) {
  std::map<std::string, std::string> settings{
      {"20", "0"},    {"21", "0"},    {"22", "1"},    {"23", "0"},    {"24", "25.0"}, {"25", "500.0"},  {"27", "1.000"},
      {"100", "250"}, {"101", "250"}, {"102", "400"}, {"130", "200"}, {"131", "200"}, {"132", "60.000"}};
  for (const auto& [id, value] : changes) settings[id] = value;
  Capabilities machine;
  machine.family = family;
  for (const auto& [id, value] : settings) machine.settings.push_back({.id = id, .value = value});
  return machine;
}

Snapshot at_rest() {
  Snapshot now;
  now.state = MachineState::Idle;
  now.machine_position_mm = {-10, -20, -5};
  now.inputs = machine::Inputs{};
  return now;
}

std::string refusal(const Capabilities& machine, const Snapshot& now, std::string_view letters = {}) {
  const auto plan = plan_audit(machine, now, letters);
  return plan ? "" : plan.error();
}

TEST(AuditPlan, MeasuresZFirst) {
  const auto plan = plan_audit(machine_with({}), at_rest());
  ASSERT_TRUE(plan) << plan.error();
  ASSERT_EQ(plan->axes.size(), 3U);
  EXPECT_EQ(plan->axes[0].letter, 'Z');
  EXPECT_EQ(plan->axes[1].letter, 'X');
  EXPECT_EQ(plan->axes[0].steps_per_mm, 400);
  EXPECT_EQ(plan->axes[1].home_mm, -1);
  EXPECT_TRUE(plan->protections.empty());
  EXPECT_FALSE(plan->is_known_homed);
}

TEST(AuditPlan, KnowsWhereEachFirmwareHomesTo) {
  const auto home_of_x = [](Firmware family, const std::map<std::string, std::string>& settings) {
    const auto plan = plan_audit(machine_with(settings, family), at_rest());
    return plan ? plan->axes.at(1).home_mm : 1e9;
  };
  EXPECT_EQ(home_of_x(Firmware::Grbl, {{"23", "1"}}), -199);
  EXPECT_EQ(home_of_x(Firmware::GrblHal, {{"23", "1"}, {"44", "7"}}), -199);
  EXPECT_EQ(home_of_x(Firmware::GrblHal, {{"22", "9"}, {"44", "7"}}), 0);
  EXPECT_EQ(home_of_x(Firmware::Rabbit, {{"23", "1"}, {"50", "4"}, {"51", "3"}}), 1);
  EXPECT_EQ(home_of_x(Firmware::Rabbit, {{"X/Home/Mpos", "10"}, {"50", "7"}}), 9);
}

TEST(AuditPlan, SwitchesProtectionsOffAndBackAsTheyWere) {
  const auto plan = plan_audit(machine_with({{"20", "1"}, {"21", "3"}}), at_rest());
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->protections_off, (std::vector<machine::SettingAssignment>{{"20", "0"}, {"21", "0"}}));
  EXPECT_EQ(plan->protections, (std::vector<machine::SettingAssignment>{{"20", "1"}, {"21", "3"}}));
}

TEST(AuditPlan, PutsBackWhatAnEarlierAuditLeftOff) {
  const auto plan = plan_audit(machine_with({{"20", "1"}}), at_rest(), {}, {{"20", "1"}, {"21", "3"}});
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->protections_off, (std::vector<machine::SettingAssignment>{{"20", "0"}}));
  EXPECT_EQ(plan->protections, (std::vector<machine::SettingAssignment>{{"20", "1"}, {"21", "3"}}));
}

TEST(AuditPlan, TakesOnlyAxesThatHome) {
  const auto letters_of = [](const Capabilities& machine, std::string_view wanted) {
    std::string letters;
    const auto plan = plan_audit(machine, at_rest(), wanted);
    if (plan) {
      for (const AuditAxis& axis : plan->axes) letters += axis.letter;
    }
    return letters;
  };
  EXPECT_EQ(letters_of(machine_with({{"44", "4"}, {"45", "1"}}, Firmware::GrblHal), ""), "ZX");
  EXPECT_EQ(letters_of(machine_with({}), "Y"), "ZY");
  EXPECT_EQ(letters_of(machine_with({{"44", "3"}}, Firmware::GrblHal), "XY"), "XY");
  EXPECT_THAT(refusal(machine_with({{"44", "3"}}, Firmware::GrblHal), at_rest()), HasSubstr("Z does not home"));
  EXPECT_THAT(refusal(machine_with({}), at_rest(), "XA"), HasSubstr("A is no axis"));
}

TEST(AuditPlan, RefusesWhatCannotBeMeasured) {
  const Capabilities machine = machine_with({});
  EXPECT_THAT(refusal(machine_with({{"22", "0"}}), at_rest()), HasSubstr("Homing is off"));
  EXPECT_THAT(refusal(machine_with({{"23", "4"}}), at_rest()), HasSubstr("Z homes downwards"));
  Snapshot now = at_rest();
  now.homing.all = false;
  EXPECT_THAT(refusal(machine, now), HasSubstr("not homed"));
  now = at_rest();
  now.state = MachineState::Run;
  EXPECT_THAT(refusal(machine, now), HasSubstr("not idle"));
  now.state = MachineState::Alarm;
  EXPECT_THAT(refusal(machine, now), HasSubstr("in alarm"));
  now = at_rest();
  now.pendant_in_control = true;
  EXPECT_THAT(refusal(machine, now), HasSubstr("pendant"));
  now = at_rest();
  now.inputs.reset();
  EXPECT_THAT(refusal(machine, now), HasSubstr("$10"));
  now = at_rest();
  now.inputs->limits = "X";
  EXPECT_THAT(refusal(machine, now), HasSubstr("closed (X)"));
}

}  // namespace
}  // namespace kerf::job
