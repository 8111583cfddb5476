#include "simulation/case_runner.hpp"

#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using vocabulary::Firmware;

CaseMachine machine_of(Firmware firmware) {
  CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  return machine;
}

TEST(CaseRunner, AnswersAndWhereTheMachineStands) {
  const auto record = run_case({.id = "a", .lines = {"G0X1", "G20", "nonsense"}}, machine_of(Firmware::GrblHal));
  EXPECT_EQ(record.id, "a");
  ASSERT_EQ(record.answers.size(), 3U);
  EXPECT_EQ(record.answers[0], "ok");
  EXPECT_EQ(record.answers[2].substr(0, 6), "error:");
  EXPECT_EQ(record.parser_state.substr(0, 15), "[GC:G0 G54 G17 ");
  ASSERT_EQ(record.position_mm.size(), 3U);
  EXPECT_NEAR(record.position_mm[0], 1.0, 0.01);
  EXPECT_FALSE(record.offsets.empty());
}

TEST(CaseRunner, GrblRefusesToListOffsetsWhileItMoves) {
  EXPECT_TRUE(run_case({.id = "a", .lines = {"G0X1"}}, machine_of(Firmware::Grbl)).offsets.empty());
  EXPECT_FALSE(run_case({.id = "b", .lines = {"G0X1", "G4P0"}}, machine_of(Firmware::Grbl)).offsets.empty());
}

TEST(CaseRunner, AnAlarmOfGrblIsResetAndSwallowsTheNextLine) {
  const auto record = run_case({.id = "a", .lines = {"G38.4Z-5F100"}}, machine_of(Firmware::Grbl));
  EXPECT_EQ(record.answers, std::vector<std::string>{"ok"});
  EXPECT_EQ(record.alarms, std::vector<std::string>{"ALARM:4"});
  EXPECT_TRUE(record.parser_state.empty());
  EXPECT_FALSE(record.offsets.empty());
}

TEST(CaseRunner, InjectedBytesArriveInTheirTime) {
  const auto record =
      run_case({.id = "a", .lines = {"M0"}, .inject = {{.after = 600ms, .byte = '~'}}}, machine_of(Firmware::GrblHal));
  EXPECT_EQ(record.answers, std::vector<std::string>{"ok"});
}

TEST(CaseRunner, RestoringSettingsCostsNoLineOnGrblHal) {
  const auto record = run_case({.id = "a", .lines = {"$RST=#", "G0X1"}}, machine_of(Firmware::GrblHal));
  EXPECT_EQ(record.answers, (std::vector<std::string>{"ok", "ok"}));
  EXPECT_FALSE(record.parser_state.empty());
}

TEST(CaseRunner, AProbeThatBeginsInContactLeavesItsTarget) {
  const auto record = run_case({.id = "a", .lines = {"G38.4Z-5F100"}}, machine_of(Firmware::GrblHal));
  EXPECT_EQ(record.alarms, std::vector<std::string>{"ALARM:4"});
  const auto probe =
      std::ranges::find(record.offsets, std::string{"PRB"}, [](const auto& entry) { return entry.first; });
  ASSERT_NE(probe, record.offsets.end());
  EXPECT_EQ(probe->second, "0.000,0.000,-5.000:0");
}

TEST(CaseRunner, AToolChangeLetsTheRestOfItsBlockPass) {
  const auto record = run_case({.id = "a", .lines = {"M6M3T1S100"}}, machine_of(Firmware::GrblHal));
  EXPECT_EQ(record.answers, std::vector<std::string>{"ok"});
}

TEST(CaseRunner, SetupLeavesNoAnswers) {
  const auto record =
      run_case({.id = "a", .lines = {"G4P0"}, .setup = {"G21", "nonsense"}}, machine_of(Firmware::Grbl));
  EXPECT_EQ(record.answers, std::vector<std::string>{"ok"});
  EXPECT_TRUE(record.messages.empty());
}

TEST(CaseRunner, AProbeMovePrintsAnOffsetByItself) {
  const auto record = run_case({.id = "a", .lines = {"G0Z5", "G38.3Z-1F200", "G0Z5"}}, machine_of(Firmware::Grbl));
  ASSERT_EQ(record.offsets.size(), 1U);
  EXPECT_EQ(record.offsets.front().first, "PRB");
  EXPECT_EQ(record.offsets.front().second, "0.000,0.000,-1.000:0");
}

TEST(CaseRunner, GrblCarriesOutStartupLinesThatItCannotKeep) {
  const auto record =
      run_case({.id = "a", .lines = {"$N7=G20", "$N1=G0X", "$N0=G0X1", "$N"}}, machine_of(Firmware::Grbl));
  EXPECT_EQ(record.answers, (std::vector<std::string>{"ok", "error:2", "ok", "ok"}));
  EXPECT_EQ(record.messages, (std::vector<std::string>{"$N0=G0X1", "$N1="}));
  EXPECT_EQ(record.parser_state.substr(0, 23), "[GC:G0 G54 G17 G20 G90 ");
}

TEST(CaseRunner, GrblMindsTheSignBeforeTheSettingsNumber) {
  const auto record = run_case({.id = "a", .lines = {"$200=-1", "$200=1", "$300=-1"}}, machine_of(Firmware::Grbl));
  EXPECT_EQ(record.answers, (std::vector<std::string>{"error:4", "error:3", "error:3"}));
}

TEST(CaseRunner, ChordsBeforeTheSoftLimitStillMoveOnGrbl) {
  const std::vector<std::string> setup = {"$100=80",  "$101=80",  "$110=5000", "$111=5000", "$120=310",
                                          "$121=290", "$11=0.02", "$1=255",    "$130=10",   "$131=10",
                                          "$132=10",  "$22=1",    "$20=1",     "$12=0.002"};
  const auto record = run_case({.id = "a", .lines = {"G2X-20I-10F200"}, .setup = setup}, machine_of(Firmware::Grbl));
  EXPECT_EQ(record.alarms, std::vector<std::string>{"ALARM:2"});
  EXPECT_EQ(record.position_steps, (std::vector<std::int32_t>{-346, -658, 0}));
}

}  // namespace
}  // namespace kerf::simulation
