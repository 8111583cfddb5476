#include "sender/machine/settings_plan.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "sender/machine/capability_collector.hpp"

namespace kerf::machine {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

Capabilities machine_with(std::string_view lines) {
  CapabilityCollector collector;
  for (const std::string_view line : base::split(lines, '\n')) collector.fold(protocol::decode(line));
  return collector.capabilities(true);
}

Capabilities grbl() {
  return machine_with(
      "[VER:1.1h.20190830:]\n[OPT:V,15,128]\n$13=0\n$20=0\n$22=0\n$24=25.000\n$110=500.000\n$111=500.000");
}

std::vector<std::string> ids(const std::vector<SettingDifference>& steps) {
  std::vector<std::string> found;
  for (const auto& step : steps) found.push_back(step.id);
  return found;
}

TEST(SettingsPlan, HomingComesBeforeSoftLimits) {
  const auto plan = plan_settings(grbl(), {{"110", "600"}, {"20", "1"}, {"22", "1"}});
  ASSERT_TRUE(plan);
  EXPECT_THAT(ids(plan->steps), ElementsAre("110", "22", "20"));
}

TEST(SettingsPlan, SoftLimitsNeedHoming) {
  const auto plan = plan_settings(grbl(), {{"20", "1"}});
  ASSERT_FALSE(plan);
  ASSERT_THAT(plan.error(), SizeIs(1));
  EXPECT_EQ(plan.error()[0].fault, SettingFault::NeedsOther);
}

TEST(SettingsPlan, WhatIsSetIsLeftOutAndTheLastValueCounts) {
  const auto plan = plan_settings(grbl(), {{"110", "500"}, {"111", "700"}, {"111", "500.0"}});
  ASSERT_TRUE(plan);
  EXPECT_THAT(plan->steps, IsEmpty());
}

TEST(SettingsPlan, AllRefusalsAreTold) {
  const auto plan = plan_settings(grbl(), {{"110", "fast"}, {"999", "1"}, {"13", "7"}, {"111", "600"}});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error(), SizeIs(3));
  EXPECT_EQ(plan.error()[1].fault, SettingFault::UnknownSetting);
}

TEST(SettingsPlan, DifferencesNameWhatCameAndWent) {
  const auto found =
      differences(grbl(), {{"110", "500"}, {"111", "1"}, {"5", "1"}}, {{"110", "500.000"}, {"111", "2"}, {"7", "3"}});
  ASSERT_THAT(ids(found), ElementsAre("111", "5", "7"));
  EXPECT_EQ(sentence_of(found[0]), "$111 (Y-axis maximum rate): 1 -> 2 mm/min");
  EXPECT_FALSE(found[1].known_after);
  EXPECT_FALSE(found[2].known_before);
}

TEST(SettingsPlan, WritingAPlanMakesTheMachineWhatWasWanted) {
  EXPECT_TRUE(rc::check("plans", [] {
    Capabilities machine = grbl();
    std::vector<SettingAssignment> wanted;
    for (int count = *rc::gen::inRange(0, 6); count > 0; --count) {
      wanted.push_back({*rc::gen::element<std::string>("20", "22", "110", "111", "24", "13"),
                        std::to_string(*rc::gen::inRange(0, 3))});
    }
    const auto plan = plan_settings(machine, wanted);
    if (!plan) return;
    const auto before = settings_of(machine);
    for (const auto& step : plan->steps) {
      for (auto& setting : machine.settings) {
        if (setting.id == step.id) setting.value = step.after;
      }
    }
    RC_ASSERT(plan_settings(machine, wanted)->steps.empty());
    RC_ASSERT(differences(machine, before, settings_of(machine)).size() == plan->steps.size());
  }));
}

}  // namespace
}  // namespace kerf::machine
