#include "sender/session/session.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// Connected, and from now on no line is answered unless the test says so.
Conversation silent_after_connect(ReplyTable replies, SessionOptions options = {}) {
  Conversation talk{std::move(replies), options};
  talk.connect();
  talk.replies.answers_lines = false;
  talk.lines_sent.clear();
  talk.events.clear();
  return talk;
}

TEST(Session, RunsASmallJobToItsEnd) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.lines_sent.clear();
  talk.run("(part)\n%\nG21 G90\nG1 X10 F600\n\nM30\n%\n");
  talk.pass(2s);
  // Then Kerf asks which modes the job has left behind.
  EXPECT_THAT(talk.lines_sent, ElementsAre("G21G90", "G1X10F600", "M30", "G4P0", "$G"));
  ASSERT_TRUE(talk.session.job());
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Finished);
  EXPECT_EQ(talk.session.job()->progress.percent, 100);
  EXPECT_THAT(talk.told<JobEnded>(), SizeIs(1));
}

TEST(Session, ClearsTheLatchBeforeAJobOnGrblHalOnly) {
  Conversation talk{grblhal_replies()};
  talk.connect();
  talk.lines_sent.clear();
  talk.run("G0X1\n");
  talk.pass(2s);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "G0X1", "G4P0"));
}

TEST(Session, IsNotFinishedBeforeIdleIsSeen) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.replies.status = "<Run|MPos:0.000,0.000,0.000|FS:500,0>\r\n";
  talk.run("G0X1\n");
  talk.pass(10s);
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Running);
  talk.replies.status = grbl_replies().status;
  talk.pass(1s);
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Finished);
}

TEST(Session, CapsTheWindowOnASerialLine) {
  auto talk = silent_after_connect(grblhal_replies(), {.link = {.baud = 115200}});
  EXPECT_EQ(talk.session.window_bytes(), 288U);
  std::string text;
  for (int line = 0; line < 100; ++line) text += "G1X10.000Y10.000\n";
  talk.run(text);
  EXPECT_LE(talk.session.bytes_in_flight(), 288U);
  EXPECT_GT(talk.session.bytes_in_flight(), 260U);
}

TEST(Session, RefusesALineLongerThanTheControllerTakes) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.run("G0X1\nG1" + std::string(90, '0') + "\n");
  ASSERT_THAT(talk.told<CommandRefused>(), SizeIs(1));
  EXPECT_EQ(talk.told<CommandRefused>()[0].reason, Refused::LineTooLong);
  EXPECT_THAT(talk.told<CommandRefused>()[0].sentence, HasSubstr("line 2"));
  EXPECT_FALSE(talk.session.job());
}

TEST(Session, ARefusedLineHoldsTheJobAndIsNamed) {
  auto talk = silent_after_connect(grblhal_replies());
  talk.run("G0X1\nG99X1\nG0X2\nG0X3\n");
  talk.hear("ok\r\nok\r\nerror:20\r\nerror:20\r\nerror:20\r\n");
  const auto& job = *talk.session.job();
  EXPECT_EQ(job.phase, JobPhase::Holding);
  EXPECT_EQ(job.hold_cause, job::HoldCause::Refusal);
  ASSERT_TRUE(job.refusal);
  EXPECT_EQ(job.refusal->file_line, 2U);
  EXPECT_EQ(job.refusal->text, "G99X1");
  EXPECT_EQ(job.refusal->code, 20);
  EXPECT_THAT(job.refusal->meaning, HasSubstr("Unsupported"));
  EXPECT_EQ(job.aftermath.lines_not_executed, 3U);
  const auto refused = talk.told<LineRefused>();
  ASSERT_THAT(refused, SizeIs(3));
  EXPECT_FALSE(refused[0].latched_repeat);
  EXPECT_TRUE(refused[1].latched_repeat);
  EXPECT_TRUE(refused[2].latched_repeat);
}

TEST(Session, AWelcomeInTheMiddleInterruptsAndNothingIsSentAgain) {
  auto talk = silent_after_connect(grbl_replies());
  talk.run("G0X1\nG0X2\nG0X3\n");
  talk.lines_sent.clear();
  talk.hear("ok\r\n\r\nGrbl 1.1h ['$' for help]\r\n");
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Interrupted);
  ASSERT_THAT(talk.told<LinesLost>(), SizeIs(1));
  EXPECT_EQ(talk.told<LinesLost>()[0].lines.front().file_line, 2U);
  talk.replies.answers_lines = true;
  talk.pass(30s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
  EXPECT_THAT(talk.lines_sent, ElementsAre("", "$I", "$G", "$#", "$$", "$N"));
}

TEST(Session, LosingTheLinkInterrupts) {
  auto talk = silent_after_connect(grbl_replies());
  talk.run("G0X1\nG0X2\n");
  talk.session.on_closed(talk.now, LinkLoss::Unplugged);
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Interrupted);
  EXPECT_EQ(talk.session.job()->aftermath.first_line_not_executed, 1U);
  EXPECT_EQ(talk.session.bytes_in_flight(), 0U);
}

TEST(Session, StopHoldsThenResetsAndIgnoresLateAnswers) {
  auto talk = silent_after_connect(grbl_replies());
  talk.run("G0X1\nG0X2\n");
  talk.replies.status = "<Hold:1|MPos:0.000,0.000,0.000|FS:100,0>\r\n";
  talk.replies.welcome.clear();
  talk.submit(StopJob{});
  EXPECT_EQ(talk.count_sent('!'), 1U);
  talk.pass(400ms);
  EXPECT_EQ(talk.count_sent('\x18'), 0U);
  talk.replies.status = "<Hold:0|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  talk.pass(300ms);
  EXPECT_EQ(talk.count_sent('\x18'), 1U);
  talk.replies.answers_lines = true;
  talk.replies.status = grbl_replies().status;
  talk.hear("ok\r\n\r\nGrbl 1.1h ['$' for help]\r\n");
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Stopped);
  EXPECT_FALSE(talk.session.job()->position_suspect);
  talk.pass(2s);
  EXPECT_EQ(talk.session.phase(), SessionPhase::Ready);
}

TEST(Session, RealtimeBytesDoNotWaitForLines) {
  auto talk = silent_after_connect(grbl_replies());
  talk.run("G0X1\n");
  talk.session.submit(talk.now, HoldJob{});
  const auto out = talk.session.take_outbox();
  EXPECT_EQ(out.realtime, "!");
  EXPECT_EQ(out.lines, "");
}

TEST(Session, CriticalAlarmVoidsTheLedger) {
  auto talk = silent_after_connect(grbl_replies());
  talk.run("G0X1\nG0X2\n");
  talk.hear("ALARM:1\r\n");
  EXPECT_EQ(talk.session.bytes_in_flight(), 0U);
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Alarmed);
  EXPECT_TRUE(talk.session.job()->position_suspect);
  talk.submit(SendLine{"$X"});
  ASSERT_THAT(talk.told<CommandRefused>(), SizeIs(1));
  EXPECT_EQ(talk.told<CommandRefused>()[0].reason, Refused::MachineInAlarm);
}

TEST(Session, CommandsThatCannotBeObeyedSayWhy) {
  Conversation talk{grbl_replies()};
  talk.submit(HoldJob{});
  talk.open();
  talk.submit(SendLine{"G0X1"});
  talk.connect();
  talk.submit(ResumeJob{});
  talk.submit(StopJob{});
  talk.submit(SendLine{"$I=what?"});
  talk.submit(SendLine{"$rst"});
  talk.submit(SendRealtime{0xA2});
  std::vector<Refused> reasons;
  for (const auto& refused : talk.told<CommandRefused>()) reasons.push_back(refused.reason);
  EXPECT_THAT(reasons, ElementsAre(Refused::NotConnected, Refused::NotIdentified, Refused::NotAtRest, Refused::NoJob,
                                   Refused::RealtimeInLine, Refused::NeverSent, Refused::NeverSent));
}

TEST(Session, JogCancelOnGrblHalForgetsUnreadLines) {
  auto talk = silent_after_connect(grblhal_replies());
  talk.submit(Jog{"G91G21X10F1000"});
  EXPECT_GT(talk.session.bytes_in_flight(), 0U);
  talk.submit(CancelJog{});
  EXPECT_EQ(talk.session.bytes_in_flight(), 0U);
  auto grbl = silent_after_connect(grbl_replies());
  grbl.submit(Jog{"G91G21X10F1000"});
  grbl.submit(CancelJog{});
  EXPECT_GT(grbl.session.bytes_in_flight(), 0U);
}

TEST(Session, SilenceIsToldOnceAndItsEndToo) {
  Conversation talk{grbl_replies()};
  talk.connect();
  talk.replies.answers_status = false;
  talk.pass(30s);
  EXPECT_THAT(talk.told<LinkSilent>(), SizeIs(1));
  talk.replies.answers_status = true;
  talk.pass(2s);
  EXPECT_THAT(talk.told<LinkAnswering>(), SizeIs(1));
}

TEST(Session, PollsAtAMeasuredPace) {
  Conversation serial{grbl_replies(), {.link = {.baud = 115200}}};
  serial.connect();
  serial.pass(10s);
  EXPECT_NEAR(static_cast<double>(serial.count_sent('?')), 50, 2);
  Conversation network{grbl_replies(), {.link = {.baud = std::nullopt, .network = true}}};
  network.connect();
  network.pass(10s);
  EXPECT_NEAR(static_cast<double>(network.count_sent('?')), 100, 2);
}

TEST(Session, DoesNotAskWhileReportsComeByThemselves) {
  Conversation talk{grblhal_replies()};
  talk.connect();
  for (int report = 0; report < 100; ++report) {
    talk.hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|AR:100>\r\n");
    talk.pass(100ms);
  }
  EXPECT_LE(talk.count_sent('?'), 1U);
}

TEST(Session, APendantInTheMiddleInterruptsAndSilencesKerf) {
  auto talk = silent_after_connect(grblhal_replies());
  talk.run("G0X1\nG0X2\n");
  talk.hear("<Run|MPos:0.000,0.000,0.000|FS:0,0|MPG:1>\r\n");
  EXPECT_EQ(talk.session.job()->phase, JobPhase::Interrupted);
  talk.sent.clear();
  talk.pass(10s);
  // It only looks now and then.
  EXPECT_LE(talk.sent.size(), 5U);
  EXPECT_EQ(talk.count_sent('?'), talk.sent.size());
}

// However the bytes of the controller are cut, the same bytes go out.
RC_GTEST_PROP(Session, ChunkingNeverChangesWhatIsSent, ()) {
  const std::string heard =
      "\r\nGrblHAL 1.1f ['$' or '$HELP' for "
      "help]\r\n<Idle|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0|FW:grblHAL>\r\nok\r\n"
      "[VER:1.1f.20260817:]\r\n[OPT:VNML+,100,1024,3,0]\r\n[NEWOPT:ENUMS]\r\n[FIRMWARE:grblHAL]\r\nok\r\n"
      "[GC:G0 G54]\r\nok\r\nok\r\n$13=0\r\nok\r\nok\r\nok\r\nerror:3\r\nok\r\nok\r\nok\r\nok\r\nok\r\n";
  const auto sent_with = [&heard](const std::vector<std::size_t>& cuts) {
    Session session;
    session.on_open(Instant{});
    std::string sent;
    const auto take = [&] {
      auto out = session.take_outbox();
      sent += out.realtime + out.lines;
    };
    std::size_t at = 0;
    for (const std::size_t cut : cuts) {
      const std::size_t length = std::min(cut, heard.size() - at);
      session.on_bytes(Instant{}, std::string_view{heard}.substr(at, length));
      take();
      at += length;
    }
    session.on_bytes(Instant{}, std::string_view{heard}.substr(at));
    take();
    session.advance_to(Instant{200ms});
    take();
    session.on_bytes(Instant{200ms}, heard.substr(heard.find('<')));
    take();
    session.submit(Instant{300ms}, StartJob{*job::Program::load("a", "G0X1\nG0X2\n")});
    take();
    return sent;
  };
  const auto cuts = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 40));
  RC_ASSERT(sent_with(cuts) == sent_with({}));
}

// Whatever a controller says: no throw, no line to a machine that has not been asked, and an account that adds up.
RC_GTEST_PROP(Session, SurvivesAnythingThatIsSaid, ()) {
  const std::vector<std::string> words{"ok",
                                       "error:20",
                                       "error:9",
                                       "ALARM:1",
                                       "ALARM:5",
                                       "Grbl 1.1h ['$' for help]",
                                       "GrblHAL 1.1f ['$' or '$HELP' for help]",
                                       "<Idle|MPos:0.000,0.000,0.000|FS:0,0>",
                                       "<Run|MPos:1.000,0.000,0.000|FS:0,0>",
                                       "<Hold:0|MPos:1.000,0.000,0.000|FS:0,0>",
                                       "<Alarm|MPos:1.000,0.000,0.000|FS:0,0>",
                                       "<Idle|MPG:1>",
                                       "<Idle|MPG:0|FW:grblHAL>",
                                       "[VER:1.1h.20190830:]",
                                       "[OPT:V,15,128]",
                                       "[NEWOPT:ENUMS]",
                                       "nonsense",
                                       "<<<>|"};
  Session session;
  Instant now{};
  session.on_open(now);
  const auto program = *job::Program::load("a", "G0X1\nG1X2F100\nG0X3\nM30\n");
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 40));
  for (const int step : steps) {
    const auto at = static_cast<std::size_t>(step);
    if (at < words.size())
      session.on_bytes(now, words[at] + "\r\n");
    else if (step == 20)
      session.submit(now, StartJob{program});
    else if (step == 21)
      session.submit(now, StopJob{});
    else if (step == 22)
      session.submit(now, HoldJob{});
    else if (step == 23)
      session.submit(now, ResumeJob{});
    else if (step == 24)
      session.submit(now, SoftReset{});
    else if (step == 25)
      session.submit(now, AbortJob{});
    else if (step == 26)
      session.submit(now, CancelJog{});
    else if (step == 27)
      session.submit(now, SendLine{"$G"});
    else {
      now += 137ms;
      session.advance_to(now);
      RC_ASSERT(session.next_deadline() > now);
    }
    const auto& ledger = session.ledger();
    RC_ASSERT(ledger.lines_entered() == ledger.lines_settled() + ledger.lines_struck_out() + ledger.size());
    RC_ASSERT(ledger.bytes_in_flight() <= session.window_bytes() || ledger.size() == 1U);
  }
}

}  // namespace
}  // namespace kerf::session
