#include <chrono>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// A controller that keeps its settings: every `$n=v` changes what `$$` and `$n` say.
class SettingsTalk : public Conversation {
 public:
  using Conversation::Conversation;

  /// Submits and plays the controller's memory until the change is over.
  SettingsResult change(std::vector<machine::SettingAssignment> settings) {
    submit(ChangeSettings{.settings = std::move(settings), .reason = "test"});
    pass(20s);
    const auto ends = told<SettingsChanged>();
    return ends.empty() ? SettingsResult{} : ends.back().result;
  }
};

ReplyTable grbl_with_homing() {
  ReplyTable table = grbl_replies();
  table.settings = {{"13", "0"}, {"20", "0"}, {"22", "0"}, {"110", "500.000"}, {"111", "500.000"}};
  return table;
}

ReplyTable grblhal_with_settings() {
  ReplyTable table = grblhal_replies();
  table.settings = {{"13", "0"}, {"20", "0"}, {"22", "0"}, {"110", "500.000"}, {"481", "0"}};
  table.lines["$ES"] =
      "[SETTING:110|43|X-axis maximum rate|mm/min|6|#####0.000|||0|0]\r\n"
      "[SETTING:481|1|Autoreport interval|ms|5|###0|100|1000|1|1]\r\nok\r\n";
  return table;
}

TEST(SessionSettings, GrblIsWrittenLineByLineAndListedAtTheEnd) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.lines_sent.clear();
  const auto result = talk.change({{"20", "1"}, {"110", "600"}, {"22", "1"}});
  EXPECT_EQ(result.outcome, SettingsOutcome::Done);
  EXPECT_THAT(talk.lines_sent, ElementsAre("$110=600", "$22=1", "$20=1", "$$", "$N"));
  EXPECT_THAT(result.changed, SizeIs(3));
  EXPECT_EQ(talk.session.capabilities().find_setting("110")->value, "600");
  EXPECT_THAT(talk.told<SettingWritten>(), SizeIs(3));
  EXPECT_EQ(talk.session.ledger().size(), 0U);
}

TEST(SessionSettings, GrblHalIsReadBackAfterEachLine) {
  SettingsTalk talk{grblhal_with_settings()};
  talk.connect();
  talk.lines_sent.clear();
  const auto result = talk.change({{"110", "600"}, {"481", "200"}});
  EXPECT_EQ(result.outcome, SettingsOutcome::Done);
  EXPECT_THAT(talk.lines_sent, ElementsAre("$110=600", "$110", "$481=200", "$481", "$$", "$N"));
  EXPECT_THAT(result.reboot_required, ElementsAre("481"));
  EXPECT_THAT(result.sentence, HasSubstr("$481"));
}

TEST(SessionSettings, WhatIsInvalidIsNotSent) {
  SettingsTalk talk{grblhal_with_settings()};
  talk.connect();
  talk.lines_sent.clear();
  const auto result = talk.change({{"110", "600"}, {"481", "50"}});
  EXPECT_EQ(result.outcome, SettingsOutcome::Invalid);
  EXPECT_THAT(talk.lines_sent, IsEmpty());
}

TEST(SessionSettings, WhatIsSetAlreadyIsNotSent) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.lines_sent.clear();
  EXPECT_EQ(talk.change({{"110", "500"}}).outcome, SettingsOutcome::Unchanged);
  EXPECT_THAT(talk.lines_sent, IsEmpty());
}

TEST(SessionSettings, ARefusedLinePutsEverythingBack) {
  auto replies = grblhal_with_settings();
  replies.lines["$481=200"] = "error:53\r\n";
  SettingsTalk talk{replies};
  talk.connect();
  talk.lines_sent.clear();
  const auto result = talk.change({{"110", "600"}, {"481", "200"}, {"13", "1"}});
  EXPECT_EQ(result.outcome, SettingsOutcome::RolledBack);
  ASSERT_THAT(result.refused, SizeIs(1));
  EXPECT_EQ(result.refused[0].id, "481");
  EXPECT_THAT(result.changed, IsEmpty());
  EXPECT_THAT(talk.lines_sent, Contains("$110=500.000"));
  EXPECT_THAT(talk.lines_sent, Not(Contains("$13=1")));
  EXPECT_EQ(talk.replies.settings.at("110"), "500.000");
}

TEST(SessionSettings, AValueThatReadsBackDifferentlyPutsEverythingBack) {
  auto replies = grblhal_with_settings();
  replies.lines["$481"] = "$481=100\r\nok\r\n";
  SettingsTalk talk{replies};
  talk.connect();
  const auto result = talk.change({{"110", "600"}, {"481", "200"}});
  EXPECT_EQ(talk.replies.settings.at("110"), "500.000");
  EXPECT_THAT(result.refused, Not(IsEmpty()));
}

TEST(SessionSettings, AMovingMachineIsNotWrittenTo) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.replies.status = "<Run|MPos:0.000,0.000,0.000|FS:100,0>\r\n";
  talk.pass(1s);
  talk.lines_sent.clear();
  talk.change({{"110", "600"}});
  EXPECT_THAT(talk.lines_sent, IsEmpty());
  EXPECT_EQ(talk.told<CommandRefused>().back().reason, Refused::ForeignMotion);
}

TEST(SessionSettings, AMachineThatBeginsToMoveIsLeftAlone) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.lines_sent.clear();
  // The report in which the machine was at rest is old: a new one is asked for before every line.
  talk.replies.status = "<Jog|MPos:0.000,0.000,0.000|FS:100,0>\r\n";
  const auto result = talk.change({{"110", "600"}});
  EXPECT_EQ(result.outcome, SettingsOutcome::Interrupted);
  EXPECT_THAT(talk.lines_sent, IsEmpty());
}

TEST(SessionSettings, SilenceEndsIt) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.replies.answers_lines = false;
  EXPECT_EQ(talk.change({{"110", "600"}}).outcome, SettingsOutcome::Unanswered);
}

TEST(SessionSettings, SilenceInAHoldIsToldApart) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.replies.answers_lines = false;
  talk.submit(ChangeSettings{.settings = {{"110", "600"}}, .reason = "test"});
  talk.replies.status = "<Hold:0|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  talk.pass(20s);
  ASSERT_THAT(talk.told<SettingsChanged>(), SizeIs(1));
  const auto result = talk.told<SettingsChanged>()[0].result;
  EXPECT_EQ(result.outcome, SettingsOutcome::Held);
  EXPECT_THAT(result.sentence, HasSubstr("held (Hold)"));
}

TEST(SessionSettings, AResetEndsIt) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.replies.answers_lines = false;
  talk.submit(ChangeSettings{.settings = {{"110", "600"}}, .reason = "test"});
  talk.hear("\r\nGrbl 1.1h ['$' for help]\r\n");
  ASSERT_THAT(talk.told<SettingsChanged>(), SizeIs(1));
  EXPECT_EQ(talk.told<SettingsChanged>()[0].result.outcome, SettingsOutcome::Interrupted);
}

TEST(SessionSettings, NothingElseIsSentMeanwhile) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.replies.answers_lines = false;
  talk.submit(ChangeSettings{.settings = {{"110", "600"}}, .reason = "test"});
  talk.submit(SendLine{"G0X1"});
  EXPECT_EQ(talk.told<CommandRefused>().back().reason, Refused::SettingsUnderWay);
}

TEST(SessionSettings, DriftIsToldOnce) {
  SettingsTalk talk{grbl_with_homing()};
  talk.open();
  talk.submit(RecallSettings{.settings = {{"110", "450.000"}, {"111", "500"}, {"13", "0"}, {"20", "0"}, {"22", "0"}},
                             .since = "2026-11-20"});
  talk.pass(10s);
  const auto drifts = talk.told<SettingsDrifted>();
  ASSERT_THAT(drifts, SizeIs(1));
  EXPECT_EQ(drifts[0].sentence,
            "1 setting is not as Kerf last saw it (2026-11-20): $110 (X-axis maximum rate): 450.000 -> 500.000 "
            "mm/min.");
  EXPECT_THAT(talk.session.settings_drift(), SizeIs(1));
}

TEST(SessionSettings, WhatIsSetByHandIsKnown) {
  SettingsTalk talk{grbl_with_homing()};
  talk.connect();
  talk.submit(SendLine{"$110=321"});
  talk.pass(1s);
  EXPECT_EQ(talk.session.capabilities().find_setting("110")->value, "321");
}

}  // namespace
}  // namespace kerf::session
