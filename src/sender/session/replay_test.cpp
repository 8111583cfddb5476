#include "sender/session/replay.hpp"

#include <chrono>

#include <gtest/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;

/// The log of a connection in which a job ran and a password was set.
std::string recorded() {
  auto replies = grblhal_replies();
  replies.lines["$$"] = "$13=0\r\n$75=hunter2\r\n$110=500.000\r\nok\r\n";
  replies.lines["$75"] = "$75=hunter3\r\nok\r\n";
  Conversation talk(replies);
  talk.open(replies.welcome);
  talk.pass(10s);
  talk.submit(SendLine{"$75=hunter3"});
  talk.submit(SendLine{"$75"});
  talk.pass(1s);
  talk.run("G21\n$75=hunter2\nG1 X1 F100\n");
  talk.pass(5s);
  return talk.wire_log();
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Replay, RepeatsAConnectionWithoutItsPasswords) {
  const std::string log = recorded();
  EXPECT_EQ(log.find("hunter"), std::string::npos) << log;
  EXPECT_NE(log.find("$75=******1"), std::string::npos);
  EXPECT_NE(log.find("$75=******2"), std::string::npos);
  EXPECT_FALSE(replay_text(log));
}

TEST(Replay, PasswordsAreInNoEvent) {
  auto replies = grblhal_replies();
  replies.lines["$75=hunter3"] = "error:7\r\n";
  replies.lines["$75"] = "$75=hunter3\r\nok\r\n";
  Conversation talk(replies);
  talk.connect();
  for (const char* line : {"$75=hunter3", "$75"}) talk.submit(SendLine{line});
  talk.run("$75=hunter3\n");
  talk.pass(5s);
  talk.submit(StopJob{});
  talk.pass(20s);
  ASSERT_FALSE(talk.told<LineRefused>().empty());
  for (const auto& refused : talk.told<LineRefused>()) EXPECT_EQ(refused.refusal.text, "$75=*******");
  ASSERT_FALSE(talk.told<JobEnded>().empty());
  EXPECT_EQ(talk.told<JobEnded>().back().job.refusal->text, "$75=*******");
  for (const auto& sent : talk.told<LineSent>()) EXPECT_EQ(sent.text.find("hunter"), std::string::npos);
  int values = 0;
  for (const auto& received : talk.told<LineReceived>()) {
    EXPECT_EQ(received.raw.find("hunter"), std::string::npos);
    EXPECT_EQ(received.answers.value_or(streaming::OwedLine{}).text.find("hunter"), std::string::npos);
    const auto* value = std::get_if<protocol::SettingValue>(&received.message);
    if (value == nullptr || value->id != "75") continue;
    EXPECT_EQ(value->value, "*******");
    ++values;
  }
  EXPECT_EQ(values, 1);
}

TEST(Replay, SaysWhereItLeavesTheLog) {
  const std::string log = recorded();
  const auto other = replay_text(replaced(log, "\"lines\":\"$G\\n\"", "\"lines\":\"$H\\n\""));
  ASSERT_TRUE(other);
  EXPECT_EQ(other->end, ReplayEnd::Different);
  EXPECT_EQ(other->logged.lines, "$H\n");
  EXPECT_EQ(other->replayed.lines, "$G\n");
  EXPECT_NE(sentence_of(*other).find("the log has '$H\\n', and this Kerf sends '$G\\n'."), std::string::npos)
      << sentence_of(*other);
}

TEST(Replay, ABitOfTheMachinesThatIsMissingShows) {
  const auto stop = replay_text(replaced(recorded(), "[G54:1.000", "[G54:1.001"));
  EXPECT_FALSE(stop) << "Kerf does not decide by an offset: " << sentence_of(*stop);
  const auto refused = replay_text(replaced(recorded(), "ENUMS,", "XNUMS,"));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->end, ReplayEnd::Different);
}

TEST(Replay, BytesThatTheLogLacksAreADifference) {
  std::string log = recorded();
  const auto from = log.rfind("{\"at\"", log.find("\"realtime\":\"?\""));
  log.erase(from, log.find('\n', from) + 1 - from);
  const auto stop = replay_text(log);
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->logged, BytesSent{});
  EXPECT_EQ(stop->replayed.realtime.back(), '?');
}

TEST(Replay, ATornLogIsRepeatedAsFarAsItGoes) {
  const std::string log = recorded();
  for (std::size_t end = log.size() / 2; end < log.size() / 2 + 500; ++end) {
    const auto whole = log.substr(0, log.rfind('\n', end) + 1);
    EXPECT_FALSE(replay_text(whole));
  }
}

TEST(Replay, NeedsTheBeginning) {
  const std::string log = recorded();
  EXPECT_EQ(replay_text(log.substr(log.find('\n') + 1))->end, ReplayEnd::NoHeader);
  EXPECT_EQ(replay_text(replaced(log, "\"part\":1", "\"part\":2"))->end, ReplayEnd::MiddlePart);
  EXPECT_EQ(replay_text(replaced(log, "\"version\":1", "\"version\":9"))->end, ReplayEnd::OtherVersion);
}

TEST(Replay, NeedsTheProgram) {
  const std::string log = recorded();
  const auto from = log.find("\"text\":\"G21");
  const auto missing = replay_text(std::string(log).replace(from, log.find('}', from) - from, "\"text\":\"\""));
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->end, ReplayEnd::ProgramMissing);
  EXPECT_EQ(missing->program, "part.nc");
}

}  // namespace
}  // namespace kerf::session
