#include "sender/machine/machine_model.hpp"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/protocol/decode.hpp"
#include "sender/machine/lexicon.hpp"

namespace kerf::machine {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Optional;
using vocabulary::MachineState;

class MachineModelTest : public testing::Test {
 protected:
  void hear(std::string_view line) { model_.fold(Instant{}, protocol::decode(line)); }
  const Snapshot& known() const { return model_.snapshot(); }
  MachineModel model_;
};

TEST_F(MachineModelTest, WorkPositionFollowsTheLastOffset) {
  hear("<Idle|MPos:10.000,20.000,30.000|FS:0,0>");
  EXPECT_FALSE(known().work_position_mm);
  hear("<Idle|MPos:10.000,20.000,30.000|FS:0,0|WCO:1.000,2.000,3.000>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(9, 18, 27)));
  hear("<Run|MPos:11.000,20.000,30.000|FS:0,0>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(10, 18, 27)));
}

TEST_F(MachineModelTest, MachinePositionFollowsFromAWorkPosition) {
  hear("<Idle|WPos:1.000,1.000,1.000|FS:0,0|WCO:5.000,6.000,7.000>");
  EXPECT_THAT(known().machine_position_mm, Optional(ElementsAre(6, 7, 8)));
  // `$10` was changed in the middle of the session.
  hear("<Idle|MPos:5.000,5.000,5.000|FS:0,0>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(0, -1, -2)));
}

TEST_F(MachineModelTest, InchesBecomeMillimetres) {
  hear("<Idle|MPos:1.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>");
  hear("$13=1");
  EXPECT_FALSE(known().machine_position_mm);
  hear("<Idle|MPos:1.0000,0.0000,0.0000|FS:10.0,0|WCO:0.0000,0.0000,0.0000>");
  EXPECT_THAT(known().machine_position_mm, Optional(ElementsAre(DoubleNear(25.4, 1e-9), 0, 0)));
  EXPECT_THAT(known().feed_mm_per_min, Optional(DoubleNear(254, 1e-9)));
  model_.on_line_accepted("$13 = 0");
  EXPECT_FALSE(known().reports_inches);
}

TEST_F(MachineModelTest, AbsentInputsAreOffAndOverridesWithoutAccessoriesMeanAllOff) {
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|Pn:XP|Ov:100,100,100|A:SF>");
  EXPECT_EQ(known().pins, "XP");
  EXPECT_EQ(known().accessories, "SF");
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_EQ(known().pins, "");
  EXPECT_EQ(known().accessories, "SF");
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|Ov:90,50,100>");
  EXPECT_EQ(known().accessories, "");
  EXPECT_EQ(known().overrides, (OverridePercentages{.feed = 90, .rapid = 50, .spindle = 100}));
}

TEST_F(MachineModelTest, AlarmStaysUntilAnotherStateIsReported) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::Grbl));
  hear("ALARM:1");
  EXPECT_EQ(known().state, MachineState::Alarm);
  EXPECT_EQ(known().alarm_code, 1);
  EXPECT_TRUE(known().reset_required);
  hear("<Alarm|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_EQ(known().alarm_code, 1);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_FALSE(known().alarm_code);
  EXPECT_FALSE(known().reset_required);
}

TEST_F(MachineModelTest, APendantIsSeenAndReleased) {
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:1>");
  EXPECT_TRUE(known().pendant_in_control);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_TRUE(known().pendant_in_control);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:0>");
  EXPECT_FALSE(known().pendant_in_control);
}

TEST_F(MachineModelTest, AFileOnTheCardIsSeen) {
  hear("<Run|MPos:0.000,0.000,0.000|FS:0,0|SD:10.5,part.nc>");
  EXPECT_EQ(known().controller_file, "part.nc");
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|SD:1>");
  EXPECT_EQ(known().controller_file, "");
}

TEST_F(MachineModelTest, ParserStateGivesWorkCoordinatesAndTool) {
  hear("[GC:G0 G59.3 G17 G21 G90 G94 M5 M9 T7 F0 S0.]");
  EXPECT_EQ(known().work_coordinate_system, "G59.3");
  EXPECT_EQ(known().tool, 7);
}

TEST_F(MachineModelTest, KeepsTheLastMessages) {
  for (int number = 0; number < 30; ++number) hear("[MSG:number " + std::to_string(number) + "]");
  hear("[MSG:]");
  EXPECT_EQ(known().messages.size(), kMessagesKept);
  EXPECT_EQ(known().messages.back(), "number 29");
}

TEST(Lexicon, TheControllersOwnWordsWin) {
  const auto& grbl = vocabulary::dialect_of(vocabulary::Firmware::Grbl);
  Lexicon lexicon;
  const auto ours = lexicon.error(grbl, 20);
  EXPECT_EQ(ours.source, FactSource::Inferred);
  EXPECT_FALSE(ours.title.empty());
  lexicon.learn(protocol::ErrorCodeRow{.id = 20, .title = "", .text = "Not supported. See the manual."});
  EXPECT_EQ(lexicon.error(grbl, 20).title, "Not supported");
  EXPECT_EQ(lexicon.error(grbl, 20).source, FactSource::Told);
  EXPECT_EQ(lexicon.error(grbl, 999).source, FactSource::Assumed);
  EXPECT_EQ(lexicon.alarms(grbl).size(), grbl.alarms.size());
  EXPECT_EQ(lexicon.errors(grbl).size(), 1U);
}

// Fields in any order, with unknown ones between them, give the same snapshot.
RC_GTEST_PROP(MachineModel, OrderAndUnknownFieldsChangeNothing, ()) {
  std::vector<std::string> fields{"MPos:1.000,2.000,3.000", "Bf:15,128",     "FS:500,8000", "Pn:XZ",
                                  "WCO:0.500,0.500,0.500",  "Ov:100,50,120", "A:SM",        "Ln:42"};
  const auto line_of = [](const std::vector<std::string>& parts) {
    std::string line = "<Run";
    for (const auto& part : parts) line += "|" + part;
    return line + ">";
  };
  MachineModel expected;
  expected.fold(Instant{}, protocol::decode(line_of(fields)));
  std::mt19937 random{*rc::gen::arbitrary<unsigned>()};
  const auto strangers = *rc::gen::inRange(0, 5);
  for (int number = 0; number < strangers; ++number) {
    fields.push_back("Q" + std::to_string(number) + ":" + std::to_string(random() % 100));
  }
  std::ranges::shuffle(fields, random);
  MachineModel shuffled;
  shuffled.fold(Instant{}, protocol::decode(line_of(fields)));
  auto snapshot = shuffled.snapshot();
  RC_ASSERT(snapshot.other_fields.size() == static_cast<std::size_t>(strangers));
  snapshot.other_fields.clear();
  RC_ASSERT(snapshot == expected.snapshot());
}

}  // namespace
}  // namespace kerf::machine
