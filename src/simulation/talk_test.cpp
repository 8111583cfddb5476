#include "simulation/talk.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "simulation/talk_conversation.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;

Talk talk_of(std::string_view text) {
  auto talk = parse_talk(text, "grbl");
  EXPECT_TRUE(talk.has_value()) << explain(talk.error().fault) << " in line " << talk.error().line;
  return talk.value_or(Talk{});
}

template <typename Action>
const Action& action_of(const Talk& talk, std::size_t step) {
  return std::get<Action>(talk.steps.at(step).action);
}

TEST(LinePattern, StarStandsForAnyText) {
  EXPECT_TRUE(LinePattern("ok").matches("ok"));
  EXPECT_FALSE(LinePattern("ok").matches("ok "));
  EXPECT_TRUE(LinePattern("<Hold:0|*|FS:0,0*").matches("<Hold:0|MPos:1,2,3|FS:0,0>"));
  EXPECT_FALSE(LinePattern("<Hold:0|*|FS:0,0*").matches("<Hold:0|MPos:1,2,3|FS:10,0>"));
  EXPECT_TRUE(LinePattern("*").matches(""));
  EXPECT_TRUE(LinePattern("a*b*c").matches("abbbc"));
  EXPECT_FALSE(LinePattern("a*b*c").matches("abbb"));
  EXPECT_TRUE(LinePattern("*ok").matches("ok ok ok"));
}

TEST(Talk, MarksBecomeSteps) {
  const Talk talk = talk_of(
      "# the rule\n"
      "% setting $22=1\n"
      "% setting $24=100\n"
      "\n"
      "-> G21  \n"
      "->\n"
      "-> ?\n"
      "-> \\x18\\x85\n"
      "-> say \\n?\n"
      "=> G21\\r\\n\n"
      "<- ok\n"
      "<~ [MSG:*\n"
      "<! *\n"
      "@ +200ms\n"
      "@ until <Idle*\n"
      "@ limit X on\n"
      "@ door close\n");
  EXPECT_EQ(talk.settings, (std::vector<std::string>{"$22=1", "$24=100"}));
  EXPECT_EQ(action_of<SendBytes>(talk, 0).bytes, "G21\n");
  EXPECT_EQ(action_of<SendBytes>(talk, 1).bytes, "\n");
  EXPECT_EQ(action_of<SendBytes>(talk, 2).bytes, "?");
  EXPECT_EQ(action_of<SendBytes>(talk, 3).bytes, "\x18\x85");
  EXPECT_EQ(action_of<SendBytes>(talk, 4).bytes, "say \\n?\n");
  EXPECT_EQ(action_of<SendBytes>(talk, 5).bytes, "G21\r\n");
  EXPECT_EQ(action_of<ExpectLine>(talk, 6).pattern.text(), "ok");
  EXPECT_EQ(action_of<AllowLines>(talk, 7).pattern.text(), "[MSG:*");
  EXPECT_EQ(action_of<ForbidLines>(talk, 8).pattern.text(), "*");
  EXPECT_EQ(action_of<LetTimePass>(talk, 9).time, Duration(200ms));
  EXPECT_EQ(action_of<WaitUntil>(talk, 10).pattern.text(), "<Idle*");
  EXPECT_TRUE(std::get<firmware::LimitHeld>(action_of<MoveSwitch>(talk, 11).event).active);
  EXPECT_EQ(std::get<firmware::InputChanged>(action_of<MoveSwitch>(talk, 12).event).input, firmware::Input::Door);
  EXPECT_EQ(talk.steps[0].line, 5U);
  EXPECT_TRUE(talk.moves_switches());
}

TEST(Talk, FolderSpeaksUnlessAHeaderSaysWho) {
  EXPECT_EQ(talk_of("-> $I\n").personality->key(), "grbl");
  EXPECT_EQ(talk_of("% personality grblhal-expr\n-> $I\n").personality->key(), "grblhal-expr");
  EXPECT_EQ(parse_talk("-> $I\n", "misc").error().fault, TalkFault::UnknownPersonality);
}

TEST(Talk, FaultsNameTheirLine) {
  const auto fault_in_second_line = [](std::string_view line) {
    const auto talk = parse_talk("# rule\n" + std::string(line) + "\n", "grbl");
    EXPECT_FALSE(talk) << line;
    EXPECT_EQ(talk.error().line, 2U);
    return talk.error().fault;
  };
  EXPECT_EQ(fault_in_second_line("G21"), TalkFault::UnknownMark);
  EXPECT_EQ(fault_in_second_line("->G21"), TalkFault::UnknownMark);
  EXPECT_EQ(fault_in_second_line("% colour red"), TalkFault::UnknownHeader);
  EXPECT_EQ(fault_in_second_line("% personality marlin"), TalkFault::UnknownPersonality);
  EXPECT_EQ(fault_in_second_line("=> \\q"), TalkFault::BadEscape);
  EXPECT_EQ(fault_in_second_line("@ +1m"), TalkFault::BadTime);
  EXPECT_EQ(fault_in_second_line("@ limit Q on"), TalkFault::BadSwitch);
  EXPECT_EQ(parse_talk("-> G21\n% power-up\n", "grbl").error().fault, TalkFault::HeaderAfterStep);
}

RC_GTEST_PROP(TalkProperty, AnyTextIsATalkOrHasAFaultWithItsLine, (const std::string& text)) {
  const auto talk = parse_talk(text, "grbl");
  if (!talk) RC_ASSERT(talk.error().line >= 1U);
}

/// A conversation with answers that the test invents.
class Conversation {
 public:
  explicit Conversation(std::string_view text) : talk_(talk_of(text)), conversation_(talk_, now_) {
    hear("\r\nGrbl 1.1h ['$' for help]\r\n");
    pass(700ms);
  }

  void hear(std::string_view bytes) { conversation_.on_bytes(now_, bytes); }
  void pass(Duration time) {
    now_ += time;
    conversation_.advance_to(now_);
  }
  std::string said() {
    std::string bytes = conversation_.take_outbox().bytes;
    conversation_.advance_to(now_);
    return bytes;
  }
  TalkConversation& operator*() { return conversation_; }
  TalkConversation* operator->() { return &conversation_; }

 private:
  Talk talk_;
  Instant now_{};
  TalkConversation conversation_;
};

TEST(TalkConversation, PassesWhenEveryLineComes) {
  Conversation talk("-> G21\n<- ok\n-> ?\n<- <Idle*\n");
  EXPECT_EQ(talk.said(), "G21\n");
  talk.hear("o");
  talk.hear("k\r\n");
  EXPECT_EQ(talk.said(), "?");
  talk.hear("<Idle|MPos:0,0,0>\r\n");
  EXPECT_FALSE(talk->is_finished());
  talk.pass(300ms);
  EXPECT_TRUE(talk->is_finished());
  EXPECT_FALSE(talk->failure());
}

TEST(TalkConversation, FailsOnAnotherLineAndNamesTheStep) {
  Conversation talk("-> G99\n<- ok\n");
  EXPECT_EQ(talk.said(), "G99\n");
  talk.hear("error:20\r\n");
  ASSERT_TRUE(talk->failure());
  EXPECT_EQ(talk->failure()->line, 2U);
  EXPECT_EQ(talk->failure()->what, "'error:20' came");
}

TEST(TalkConversation, FailsWhenNothingComesOrSomethingIsLeftOver) {
  Conversation silent("-> G21\n<- ok\n");
  EXPECT_EQ(silent.said(), "G21\n");
  silent.pass(59s);
  EXPECT_FALSE(silent->is_finished());
  silent.pass(1s);
  ASSERT_TRUE(silent->failure());
  EXPECT_EQ(silent->failure()->what, "nothing came");

  Conversation talkative("-> G21\n<- ok\n");
  EXPECT_EQ(talkative.said(), "G21\n");
  talkative.hear("ok\nok\n");
  talkative.pass(300ms);
  ASSERT_TRUE(talkative->failure());
  EXPECT_EQ(talkative->failure()->what, "'ok' was left over");
}

TEST(TalkConversation, AllowedLinesAreSkippedUntilTheNextSend) {
  Conversation talk("-> M30\n<~ [MSG:*\n<- ok\n-> G21\n<- ok\n");
  EXPECT_EQ(talk.said(), "M30\n");
  talk.hear("[MSG:Pgm End]\nok\n");
  EXPECT_EQ(talk.said(), "G21\n");
  talk.hear("[MSG:Pgm End]\n");
  EXPECT_TRUE(talk->failure());
}

TEST(TalkConversation, UntilAsksEvery250MsAndLeavesOtherLines) {
  Conversation talk("-> G1X1F100\n@ until <Idle*\n<- ok\n");
  EXPECT_EQ(talk.said(), "G1X1F100\n");
  EXPECT_EQ(talk.said(), "?");
  talk.hear("<Run|MPos:0,0,0>\nok\n");
  EXPECT_EQ(talk.said(), "");
  talk.pass(249ms);
  EXPECT_EQ(talk.said(), "");
  talk.pass(1ms);
  EXPECT_EQ(talk.said(), "?");
  talk.hear("<Idle|MPos:1,0,0>\n");
  talk.pass(300ms);
  EXPECT_TRUE(talk->is_finished());
  EXPECT_FALSE(talk->failure());
}

TEST(TalkConversation, SettingsAreSentAndResetBeforeTheTalk) {
  Conversation talk("% setting $22=1\n-> $I\n<- ok\n");
  EXPECT_EQ(talk.said(), "$22=1\n");
  talk.hear("ok\n");
  EXPECT_EQ(talk.said(), "\x18");
  talk.hear("Grbl 1.1h ['$' for help]\n[MSG:'$H'|'$X' to unlock]\n");
  talk.pass(700ms);
  EXPECT_EQ(talk.said(), "$I\n");
}

TEST(TalkConversation, ARunningControllerIsResetFirst) {
  const Talk talk = talk_of("-> $I\n<- ok\n");
  Instant now{};
  TalkConversation conversation(talk, now);
  now += 1s;
  conversation.advance_to(now);
  EXPECT_EQ(conversation.take_outbox().bytes, "\x18");

  const Talk power_up = talk_of("% power-up\n<- Grbl*\n");
  TalkConversation late(power_up, Instant{});
  late.advance_to(Instant{} + 1s);
  EXPECT_TRUE(late.came_too_late());
}

}  // namespace
}  // namespace kerf::simulation
