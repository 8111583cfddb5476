// The picture of the machine stays true: reports, modes and offsets, the pendant, both alphabets, explanations.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr char kFullStatus = '\x87';
constexpr char kParserReport = '\x83';
constexpr char kMpgToggle = '\x8b';
constexpr char kAutoReportToggle = '\x8c';

Conversation connected(ReplyTable replies, SessionOptions options = {}) {
  Conversation talk{std::move(replies), options};
  talk.connect();
  talk.lines_sent.clear();
  talk.events.clear();
  return talk;
}

TEST(LiveState, AsksFasterInMotion) {
  auto talk = connected(grbl_replies(), {.link = {.baud = 115200}});
  talk.replies.status = "<Run|MPos:0.000,0.000,0.000|FS:500,0>\r\n";
  talk.pass(1s);
  talk.sent.clear();
  talk.pass(10s);
  EXPECT_NEAR(static_cast<double>(talk.count_sent('?')), 100, 2);
  auto usb = connected(grbl_replies());
  usb.replies.status = "<Jog|MPos:0.000,0.000,0.000|FS:500,0>\r\n";
  usb.pass(1s);
  usb.sent.clear();
  usb.pass(10s);
  EXPECT_NEAR(static_cast<double>(usb.count_sent('?')), 200, 4);
}

TEST(LiveState, ModesAreAskedAgainAfterALineAndAPause) {
  auto talk = connected(grbl_replies());
  talk.submit(SendLine{"G91"});
  talk.submit(SendLine{"G55"});
  EXPECT_TRUE(talk.session.snapshot().parser_state_is_old);
  talk.replies.lines["$G"] = "[GC:G0 G55 G17 G21 G91 G94 M5 M9 T0 F0 S0]\r\nok\r\n";
  talk.pass(2s);
  EXPECT_THAT(talk.lines_sent, ElementsAre("G91", "G55", "$G"));
  EXPECT_FALSE(talk.session.snapshot().parser_state_is_old);
  EXPECT_EQ(talk.session.snapshot().modes.distance, "G91");
  EXPECT_EQ(talk.session.snapshot().work_coordinate_system, "G55");
}

TEST(LiveState, OffsetsAreAskedAgainWhenALineMayHaveChangedThem) {
  auto talk = connected(grblhal_replies());
  talk.submit(SendLine{"G10L20P1X0"});
  talk.pass(2s);
  // grblHAL tells its modes for a byte, so only the offsets cost a line.
  EXPECT_THAT(talk.lines_sent, ElementsAre("G10L20P1X0", "$#"));
  EXPECT_GE(talk.count_sent(kParserReport), 1U);
}

TEST(LiveState, NothingIsAskedInMotionOrDuringAJob) {
  auto talk = connected(grbl_replies());
  talk.replies.status = "<Run|MPos:0.000,0.000,0.000|FS:500,0>\r\n";
  talk.submit(SendLine{"G1X10F100"});
  talk.pass(20s);
  EXPECT_THAT(talk.lines_sent, ElementsAre("G1X10F100"));
  talk.replies.status = grbl_replies().status;
  talk.pass(1s);
  EXPECT_THAT(talk.lines_sent, ElementsAre("G1X10F100", "$G"));
}

TEST(LiveState, AControllerThatDoesNotTellIsNotAskedForEver) {
  auto talk = connected(grbl_replies());
  talk.replies.lines["$G"] = "ok\r\n";
  talk.submit(SendLine{"G91"});
  talk.pass(60s);
  EXPECT_EQ(talk.lines_sent.size(), 4U);
}

TEST(LiveState, RowsOfKerfsOwnQuestionsAreMarked) {
  auto talk = connected(grbl_replies());
  talk.submit(SendLine{"$G"});
  talk.submit(SendLine{"G91"});
  talk.pass(2s);
  std::vector<bool> marks;
  for (const auto& line : talk.told<LineReceived>()) {
    if (std::holds_alternative<protocol::ParserState>(line.message)) marks.push_back(line.for_kerf);
  }
  EXPECT_THAT(marks, ElementsAre(false, true));
}

TEST(LiveState, ASilenceIsMeasuredAndEndsWithAFullReport) {
  auto talk = connected(grblhal_replies());
  talk.replies.answers_status = false;
  talk.pass(2300ms);
  const auto health = talk.session.link_health(talk.now);
  ASSERT_TRUE(health.silent_for_s);
  EXPECT_NEAR(*health.silent_for_s, 2.2, 0.2);
  EXPECT_THAT(talk.told<LinkSilent>(), SizeIs(1));
  talk.submit(SendLine{"G0X1"});
  talk.run("G0X1\n");
  std::vector<Refused> reasons;
  for (const auto& refused : talk.told<CommandRefused>()) reasons.push_back(refused.reason);
  EXPECT_THAT(reasons, ElementsAre(Refused::NotAnswering, Refused::NotAnswering));
  EXPECT_THAT(talk.lines_sent, IsEmpty());
  talk.submit(HoldJob{});
  EXPECT_EQ(talk.sent.back(), '!');
  talk.sent.clear();
  talk.replies.answers_status = true;
  talk.pass(2s);
  EXPECT_EQ(talk.count_sent(kFullStatus), 1U);
  EXPECT_FALSE(talk.session.link_health(talk.now).silent_for_s);
}

TEST(LiveState, AutomaticReportsAreSwitchedOnWhereTheyAreSetUp) {
  ReplyTable replies = grblhal_replies();
  replies.full_status = "<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000|AR|MPG:0|FW:grblHAL>\r\n";
  auto talk = connected(replies);
  talk.pass(5s);
  EXPECT_EQ(talk.count_sent(kAutoReportToggle), 0U) << "it was sent before, while connecting";
  Conversation fresh{replies};
  fresh.open();
  fresh.pass(10s);
  EXPECT_EQ(fresh.count_sent(kAutoReportToggle), 1U);
  Conversation unwanted{replies, {.automatic_reports = false}};
  unwanted.open();
  unwanted.pass(10s);
  EXPECT_EQ(unwanted.count_sent(kAutoReportToggle), 0U);
}

TEST(LiveState, ReportsThatComeUnaskedAreAutomaticAlsoWhereNobodySaysSo) {
  auto talk = connected(grbl_replies());
  for (int report = 0; report < 100; ++report) {
    talk.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n");
    talk.pass(200ms);
  }
  EXPECT_LE(talk.count_sent('?'), 20U) << "instead of 200";
  EXPECT_TRUE(talk.session.link_health(talk.now).automatic);
}

class UnderAPendant : public testing::Test {
 protected:
  UnderAPendant() : talk_{connected(grblhal_replies())} {
    talk_.replies.answers_status = false;
    talk_.replies.answers_lines = false;
    talk_.submit(SendLine{"G0X1"});
    talk_.submit(SendLine{"$H"});
    talk_.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:1|FW:grblHAL>\r\n");
    talk_.sent.clear();
    talk_.lines_sent.clear();
  }
  std::vector<Refused> refusals() {
    std::vector<Refused> reasons;
    for (const auto& refused : talk_.told<CommandRefused>()) reasons.push_back(refused.reason);
    return reasons;
  }
  Conversation talk_;
};

TEST_F(UnderAPendant, EveryCommandIsRefusedButHoldAndStop) {
  EXPECT_THAT(talk_.told<PendantTookOver>(), SizeIs(1));
  EXPECT_EQ(talk_.session.bytes_in_flight(), 0U) << "their answers go to the pendant";
  talk_.submit(SendLine{"G0X1"});
  talk_.submit(Home{});
  talk_.submit(Unlock{});
  talk_.submit(Jog{"G91X1F100"});
  talk_.submit(ResumeJob{});
  talk_.submit(SendRealtime{0x91});
  talk_.submit(SendRealtime{'~'});
  talk_.run("G0X1\n");
  EXPECT_THAT(refusals(), testing::AllOf(SizeIs(8), testing::Each(Refused::PendantInControl)));
  talk_.submit(HoldJob{});
  talk_.submit(SendRealtime{0x84});
  talk_.submit(CancelJog{});
  EXPECT_EQ(talk_.sent, "!\x84\x85");
  EXPECT_THAT(talk_.lines_sent, IsEmpty());
}

TEST_F(UnderAPendant, NothingThatWaitedIsSentAfterwards) {
  talk_.pass(10s);
  talk_.replies = grblhal_replies();
  talk_.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:0>\r\n");
  talk_.pass(5s);
  EXPECT_THAT(talk_.told<PendantReleased>(), SizeIs(1));
  // What the pendant may have changed is asked for.
  EXPECT_THAT(talk_.lines_sent, ElementsAre("$#"));
  EXPECT_EQ(talk_.count_sent(kFullStatus), 1U);
  EXPECT_EQ(talk_.count_sent(kParserReport), 1U);
}

TEST_F(UnderAPendant, ADeafLinkIsNotCalledSilentNorAskedForEver) {
  talk_.pass(60s);
  EXPECT_THAT(talk_.told<LinkSilent>(), IsEmpty());
  EXPECT_LE(talk_.count_sent('?'), 3U);
  EXPECT_FALSE(talk_.session.link_health(talk_.now).silent_for_s);
  EXPECT_GT(talk_.session.link_health(talk_.now).report_age_s.value_or(0), 50);
}

TEST_F(UnderAPendant, ControlIsTakenBackWhereTheControllerListens) {
  talk_.submit(TakeControl{});
  EXPECT_EQ(talk_.sent, std::string(1, kMpgToggle));
  talk_.replies = grblhal_replies();
  talk_.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:0>\r\n");
  talk_.pass(5s);
  EXPECT_THAT(refusals(), IsEmpty());
  EXPECT_THAT(talk_.told<PendantReleased>(), SizeIs(1));
}

TEST_F(UnderAPendant, ADeafLinkSaysHowControlComesBack) {
  talk_.submit(TakeControl{});
  talk_.pass(3s);
  EXPECT_THAT(refusals(), ElementsAre(Refused::ControlNotGiven));
  EXPECT_THAT(talk_.told<CommandRefused>()[0].sentence, HasSubstr("release it at the pendant"));
}

TEST(Pendant, ThereIsNothingToTakeBackWithoutOne) {
  auto talk = connected(grblhal_replies());
  talk.submit(TakeControl{});
  ASSERT_THAT(talk.told<CommandRefused>(), SizeIs(1));
  EXPECT_EQ(talk.told<CommandRefused>()[0].reason, Refused::NoPendant);
}

TEST(Alphabets, RealtimeCharactersInTextsAreRefusedWithTheReason) {
  auto talk = connected(grbl_replies());
  talk.submit(SendLine{"$I=what?"});
  ASSERT_THAT(talk.told<CommandRefused>(), SizeIs(1));
  EXPECT_EQ(talk.told<CommandRefused>()[0].reason, Refused::RealtimeInLine);
  EXPECT_THAT(talk.told<CommandRefused>()[0].sentence, HasSubstr("'?'"));
  auto hal = connected(grblhal_replies());
  hal.submit(SendLine{"$75=pa!s"});
  ASSERT_THAT(hal.told<CommandRefused>(), SizeIs(1));
  EXPECT_THAT(hal.told<CommandRefused>()[0].sentence, HasSubstr("$39=0"));
}

TEST(Alphabets, TextsThatTheControllerKeepsAreSentAndQuestionsUseTheOtherAlphabet) {
  ReplyTable replies = grblhal_replies();
  replies.lines["$I+"] =
      "[VER:1.1f.20260817:]\r\n[OPT:VNML+,100,1024,3,0]\r\n[AXS:3:XYZ]\r\n[NEWOPT:ENUMS,RT-,SED]\r\n"
      "[FIRMWARE:grblHAL]\r\nok\r\n";
  auto talk = connected(replies);
  talk.replies.answers_lines = false;
  talk.sent.clear();
  talk.submit(SendLine{"$75=a?b!c~d"});
  EXPECT_THAT(talk.told<CommandRefused>(), IsEmpty());
  EXPECT_EQ(talk.sent, "$75=a?b!c~d\n");
  talk.pass(500ms);
  talk.submit(HoldJob{});
  const std::string after = talk.sent.substr(talk.sent.find('\n'));
  EXPECT_THAT(after, Not(HasSubstr("?")));
  EXPECT_THAT(after, HasSubstr("\x80"));
  EXPECT_THAT(after, HasSubstr("\x82"));
  EXPECT_THAT(after, Not(HasSubstr("!")));
  talk.submit(SendLine{"G0X1;really?"});
  EXPECT_THAT(talk.told<CommandRefused>(), SizeIs(1)) << "behind a semicolon it is obeyed";
}

TEST(Explanations, AnAlarmNamesTheLineAndWhy) {
  ReplyTable replies = grbl_replies();
  replies.lines["$#"] =
      "[G54:0.000,0.000,0.000]\r\n[G92:0.000,0.000,0.000]\r\n[TLO:-12.100]\r\n[PRB:0.000,0.000,0.000:0]\r\nok\r\n";
  replies.lines["$$"] = "$13=0\r\n$20=1\r\n$22=1\r\n$130=200.000\r\n$131=200.000\r\n$132=60.000\r\nok\r\n";
  replies.status = "<Idle|MPos:0.000,0.000,-5.000|FS:0,0|WCO:0.000,0.000,-12.100>\r\n";
  auto talk = connected(replies);
  talk.replies.answers_lines = false;
  talk.run("G21G90\nG1Z-1F100\nG1Z-50.3\nG1Z0\n");
  talk.hear("ok\r\nok\r\nALARM:2\r\n");
  ASSERT_THAT(talk.told<AlarmRaised>(), SizeIs(1));
  const auto explanation = talk.told<AlarmRaised>()[0].explanation;
  EXPECT_EQ(explanation.headline,
            "Alarm 2 at line 3: Z-62.4 is 2.4 mm below the travel because the tool length offset is -12.1.");
  EXPECT_EQ(explanation.position, machine::PositionTrust::Kept);
  EXPECT_THAT(explanation.next_steps, Not(IsEmpty()));
  ASSERT_TRUE(talk.session.alarm_explanation());
  EXPECT_EQ(talk.session.alarm_explanation()->culprit->text, "G1Z-50.3");
}

TEST(Explanations, AnErrorNamesTheWord) {
  auto talk = connected(grbl_replies());
  talk.replies.lines["G1X1G77"] = "error:20\r\n";
  talk.submit(SendLine{"G1X1G77"});
  ASSERT_THAT(talk.told<LineRefused>(), SizeIs(1));
  EXPECT_THAT(talk.told<LineRefused>()[0].explanation.headline, HasSubstr("G77 is not known to Grbl"));
}

}  // namespace
}  // namespace kerf::session
