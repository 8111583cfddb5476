// The handshake as a whole: a session and a reply table.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using machine::FactSource;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

TEST(HandshakeSession, FreshGrblWithABannerIsNotReset) {
  Conversation talk{grbl_replies()};
  talk.open("\r\nGrbl 1.1h ['$' for help]\r\n");
  talk.pass(3s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "$I", "$G", "$#", "$$", "$N"));
  const auto& known = talk.session.capabilities();
  EXPECT_EQ(known.firmware, "Grbl");
  EXPECT_EQ(known.version, "1.1h");
  EXPECT_EQ(known.build, "20190830");
  EXPECT_EQ(known.options, "V");
  EXPECT_EQ(known.user_text, "mill");
  EXPECT_EQ(known.buffers.rx_bytes, 128);
  EXPECT_EQ(known.buffers.planner_blocks, 15);
  EXPECT_EQ(known.axes.letters, "XYZ");
  EXPECT_TRUE(known.complete);
  ASSERT_THAT(known.settings, SizeIs(3));
  EXPECT_EQ(known.settings[2].value, "500.000");
  EXPECT_FALSE(known.settings[2].name.empty());
  ASSERT_THAT(talk.told<ControllerFound>(), SizeIs(1));
  EXPECT_THAT(talk.told<ControllerFound>()[0].sentence, HasSubstr("Grbl 1.1h"));
}

TEST(HandshakeSession, IdleMachineIsResetOnceAndTold) {
  Conversation talk{grbl_replies()};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 1U);
  EXPECT_THAT(talk.told<ControllerReset>(), SizeIs(1));
}

TEST(HandshakeSession, IdleMachineIsNotResetWhenThePolicySaysSo) {
  Conversation talk{grbl_replies(), {.reset_policy = ResetPolicy::Never}};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
}

TEST(HandshakeSession, GrblHalIsEnumeratedAndNeverReset) {
  Conversation talk{grblhal_replies()};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
  EXPECT_EQ(talk.count_sent('\x85'), 1U);
  EXPECT_THAT(talk.lines_sent,
              ElementsAre("", "$I+", "$G", "$#", "$EA", "$EE", "$EG", "$ES", "$ESH", "$SPINDLESH", "$$", "$N"));
  const auto& known = talk.session.capabilities();
  EXPECT_EQ(known.family, Firmware::GrblHal);
  EXPECT_TRUE(known.has("ENUMS"));
  EXPECT_THAT(known.alarms, SizeIs(1));
  EXPECT_EQ(known.alarms[0].source, FactSource::Told);
  EXPECT_EQ(known.buffers.rx_usable, 1023);
  const auto& rate = *std::ranges::find(known.settings, "110", &machine::SettingFact::id);
  EXPECT_EQ(rate.group, "X-axis");
  EXPECT_EQ(rate.source, FactSource::Told);
}

TEST(HandshakeSession, GrblHalThatGreetsAsGrblIsStillFoundOut) {
  auto replies = grblhal_replies();
  replies.full_status.clear();
  replies.lines["$I"] = replies.lines["$I+"];
  replies.welcome = "\r\nGrbl 1.1f ['$' for help]\r\n";
  Conversation talk{replies};
  talk.open(replies.welcome);
  talk.pass(5s);
  EXPECT_EQ(talk.session.capabilities().family, Firmware::GrblHal);
  EXPECT_THAT(talk.lines_sent, Contains("$ES"));
}

TEST(HandshakeSession, SilentRabbitOverTcpIsAskedFirst) {
  Conversation talk{rabbit_replies(), {.link = {.baud = std::nullopt, .network = true}}};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  const auto& known = talk.session.capabilities();
  EXPECT_EQ(known.firmware, "Rabbit GRBL");
  EXPECT_EQ(known.version, "1.6.0");
  EXPECT_EQ(known.buffers.rx_usable, 255);
  EXPECT_EQ(known.buffers.rx_source, FactSource::Inferred);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "$I", "$G", "$#", "$EA", "$EE", "$$", "$N", "$+"));
}

TEST(HandshakeSession, RabbitIsKnownByTheShapeOfItsAnswers) {
  Conversation talk{rabbit_replies(), {.reset_policy = ResetPolicy::Never}};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.capabilities().family, Firmware::Rabbit);
  EXPECT_EQ(talk.session.capabilities().firmware_source, FactSource::Inferred);
}

TEST(HandshakeSession, NothingOnTheLinkFailsAfterOneReset) {
  ReplyTable dead;
  dead.answers_lines = dead.answers_status = false;
  Conversation talk{dead, {.reset_policy = ResetPolicy::WhenSilentToo}};
  talk.open();
  talk.pass(20s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Failed);
  EXPECT_EQ(talk.count_sent('\x18'), 1U);
  EXPECT_THAT(talk.lines_sent, IsEmpty());
  ASSERT_THAT(talk.told<HandshakeFailed>(), SizeIs(1));
  EXPECT_EQ(talk.told<HandshakeFailed>()[0].failure, HandshakeFailure::Silent);
  // It may speak later: a machine that homes does.
  talk.sent.clear();
  talk.pass(10s);
  EXPECT_EQ(talk.sent, "?????");
  talk.replies = grbl_replies();
  talk.pass(10s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
}

TEST(HandshakeSession, SomethingThatIsNotGrblIsNamed) {
  ReplyTable modem;
  modem.status = "AT+CGMI\r\n";
  Conversation talk{modem};
  talk.open("\xFF\xFE garbage\r\n");
  talk.pass(20s);
  ASSERT_THAT(talk.told<HandshakeFailed>(), SizeIs(1));
  EXPECT_EQ(talk.told<HandshakeFailed>()[0].failure, HandshakeFailure::NotGrbl);
  EXPECT_THAT(talk.told<HandshakeFailed>()[0].sentence, HasSubstr("garbage"));
  EXPECT_THAT(talk.lines_sent, IsEmpty());
}

TEST(HandshakeSession, NoiseBeforeTheWelcomeDoesNoHarm) {
  Conversation talk{grbl_replies()};
  talk.open("rst:0x1 (POWERON_RESET),boot:0x13\r\n\xF0\x9F\x01\r\nGrbl 1.1h ['$' for help]\r\n");
  talk.pass(3s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
}

TEST(HandshakeSession, TwoBannersAndALateOneStartOver) {
  Conversation talk{grbl_replies()};
  talk.open("Grbl 1.1h ['$' for help]\r\nGrbl 1.1h ['$' for help]\r\n");
  talk.pass(350ms);
  talk.hear("\r\nGrbl 1.1h ['$' for help]\r\n");
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.session.bytes_in_flight(), 0U);
}

TEST(HandshakeSession, AControllerThatKeepsRestartingIsGivenUp) {
  Conversation talk{grbl_replies()};
  talk.open();
  for (int times = 0; times < 10; ++times) {
    talk.hear("\r\nGrbl 1.1h ['$' for help]\r\n");
    talk.pass(50ms);
  }
  ASSERT_THAT(talk.told<HandshakeFailed>(), SizeIs(1));
  EXPECT_EQ(talk.told<HandshakeFailed>()[0].failure, HandshakeFailure::Restarting);
}

struct BusyCase {
  const char* report;
  MachineState state;
};

class BusyMachine : public testing::TestWithParam<BusyCase> {};

TEST_P(BusyMachine, IsWatchedAndGetsNoLineAndNoReset) {
  auto replies = grbl_replies();
  replies.status = GetParam().report;
  Conversation talk{replies};
  talk.open();
  talk.pass(60s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Waiting);
  EXPECT_THAT(talk.lines_sent, IsEmpty());
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
  EXPECT_EQ(talk.count_sent('\x85'), 0U);
  ASSERT_THAT(talk.told<ControllerBusy>(), SizeIs(1));
  EXPECT_EQ(talk.told<ControllerBusy>()[0].state, GetParam().state);
  // It comes to rest by itself: the handshake goes on.
  talk.replies.status = grbl_replies().status;
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
}

INSTANTIATE_TEST_SUITE_P(States, BusyMachine,
                         testing::Values(BusyCase{"<Run|MPos:0.000,0.000,0.000|FS:500,0>\r\n", MachineState::Run},
                                         BusyCase{"<Hold:0|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Hold},
                                         BusyCase{"<Door:1|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Door},
                                         BusyCase{"<Home|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Home},
                                         BusyCase{"<Jog|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Jog},
                                         BusyCase{"<Tool|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Tool},
                                         BusyCase{"<Sleep|MPos:0.000,0.000,0.000|FS:0,0>\r\n", MachineState::Sleep},
                                         BusyCase{"<Idle|MPos:0.000,0.000,0.000|FS:0,0|SD:Pending>\r\n",
                                                  MachineState::Idle}),
                         [](const auto& param) { return std::string{vocabulary::name_of(param.param.state)}; });

TEST(HandshakeSession, ABusyMachineMayBeResetByTheOperator) {
  auto replies = grbl_replies();
  replies.status = "<Hold:0|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  Conversation talk{replies};
  talk.open();
  talk.pass(3s);
  talk.replies.status = grbl_replies().status;
  talk.submit(SoftReset{});
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_THAT(talk.told<ControllerReset>(), IsEmpty());
}

TEST(HandshakeSession, APendantIsWaitedFor) {
  auto replies = grblhal_replies();
  replies.full_status = "<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:1|FW:grblHAL>\r\n";
  Conversation talk{replies};
  talk.open();
  talk.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:1>\r\n");
  talk.pass(60s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Waiting);
  // It only asks whether the pendant still has it: the report that gives it back may have got lost.
  EXPECT_EQ(talk.count_sent('\x87'), talk.sent.size());
  ASSERT_THAT(talk.told<ControllerBusy>(), SizeIs(1));
  EXPECT_TRUE(talk.told<ControllerBusy>()[0].pendant);
  talk.replies.full_status = grblhal_replies().full_status;
  talk.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:0>\r\n");
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
}

TEST(HandshakeSession, LockedMachineIsIdentifiedWithoutAReset) {
  auto replies = grbl_replies();
  replies.status = "<Alarm|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  Conversation talk{replies};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
  EXPECT_EQ(talk.session.snapshot().state, MachineState::Alarm);
}

TEST(HandshakeSession, CheckModeLeftOnIsKept) {
  auto replies = grbl_replies();
  replies.status = "<Check|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  Conversation talk{replies};
  talk.open();
  talk.pass(5s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
}

TEST(HandshakeSession, ReportsWithoutAnswersToLinesFail) {
  auto replies = grbl_replies();
  replies.answers_lines = false;
  Conversation talk{replies};
  talk.open();
  talk.pass(20s);
  ASSERT_THAT(talk.told<HandshakeFailed>(), SizeIs(1));
  EXPECT_EQ(talk.told<HandshakeFailed>()[0].failure, HandshakeFailure::LinesUnanswered);
}

TEST(HandshakeSession, AQuestionWithoutAnAnswerLeavesTheRestUsable) {
  auto replies = grblhal_replies();
  replies.lines["$EG"] = "";
  Conversation talk{replies};
  talk.open();
  talk.pass(20s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_FALSE(talk.session.capabilities().complete);
  EXPECT_THAT(talk.told<HandshakeNoted>(), SizeIs(1));
}

TEST(HandshakeSession, AnErrorToAQuestionClearsTheLatchOnGrblHal) {
  auto replies = grblhal_replies();
  replies.lines["$#"] = "error:8\r\n";
  Conversation talk{replies};
  talk.open();
  talk.pass(20s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_THAT(talk.lines_sent,
              ElementsAre("", "$I+", "$G", "$#", "", "$EA", "$EE", "$EG", "$ES", "$ESH", "$SPINDLESH", "$$", "$N"));
}

TEST(HandshakeSession, ClosingTheLinkEndsIt) {
  Conversation talk{grbl_replies()};
  talk.open();
  talk.session.on_closed(talk.now, LinkLoss::Unplugged);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Closed);
  EXPECT_EQ(talk.session.next_deadline(), kNever);
}

TEST(HandshakeSession, AnUnaskedRestartIsToldAndIdentifiedAgain) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.lines_sent.clear();
  talk.hear("\r\nGrbl 1.1h ['$' for help]\r\n");
  ASSERT_THAT(talk.told<ControllerRestarted>(), SizeIs(1));
  EXPECT_FALSE(talk.told<ControllerRestarted>()[0].asked);
  talk.pass(3s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "$I", "$G", "$#", "$$", "$N"));
}

TEST(HandshakeSession, AfterAnAskedResetOnlyWhatItChangesIsAskedAgain) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.lines_sent.clear();
  talk.submit(SoftReset{});
  talk.pass(3s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "$G", "$#"));
  EXPECT_THAT(talk.session.capabilities().settings, SizeIs(3));
}

}  // namespace
}  // namespace kerf::session
