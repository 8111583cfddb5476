#include "sender/session/job_recorder.hpp"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/session/conversation.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using job::NoteKind;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Conversation connected(ReplyTable replies = grbl_replies()) {
  Conversation talk{std::move(replies)};
  talk.connect();
  talk.lines_sent.clear();
  return talk;
}

template <typename What>
std::vector<What> all_of(const std::vector<job::JournalRecord>& records) {
  std::vector<What> found;
  for (const auto& record : records) {
    if (const auto* what = std::get_if<What>(&record.what)) found.push_back(*what);
  }
  return found;
}

std::vector<NoteKind> kinds_of(const std::vector<job::JournalRecord>& records) {
  std::vector<NoteKind> kinds;
  for (const auto& note : all_of<job::JobNoted>(records)) kinds.push_back(note.kind);
  return kinds;
}

TEST(JobRecorder, TellsAJobFromItsBeginningToItsEnd) {
  auto talk = connected();
  EXPECT_THAT(talk.journal, IsEmpty());
  talk.run("G21\n; nothing\nG0X1\nG0X2\n");
  talk.pass(2s);
  ASSERT_GE(talk.journal.size(), 3U);
  const auto& begun = std::get<job::JobBegun>(talk.journal.front().what);
  EXPECT_EQ(begun.program, "part.nc");
  EXPECT_EQ(begun.lines, 4U);
  EXPECT_EQ(begun.size_bytes, 24U);
  EXPECT_THAT(begun.hash, SizeIs(32));
  EXPECT_EQ(begun.machine.firmware, vocabulary::Firmware::Grbl);
  EXPECT_EQ(begun.machine.version, "1.1h");
  EXPECT_EQ(begun.machine.user_text, "mill");
  EXPECT_EQ(begun.machine.planner_blocks, 15);
  EXPECT_EQ(begun.machine.settings.size(), 3U);
  EXPECT_TRUE(begun.machine.modes_are_current);
  EXPECT_TRUE(begun.machine.offsets_are_current);
  EXPECT_THAT(begun.machine.offsets_mm.at("G54"), ElementsAre(1, 2, 3));
  EXPECT_EQ(begun.machine.modes.distance, "G90");
  EXPECT_TRUE(begun.machine.machine_position_mm);
  const auto& closed = std::get<job::JobClosed>(talk.journal.back().what);
  EXPECT_EQ(closed.state.phase, job::JobPhase::Finished);
  const auto last = all_of<job::JobAdvanced>(talk.journal).back();
  EXPECT_EQ(last.line_acknowledged, 4U);
  EXPECT_EQ(last.line_sent, 4U);
  EXPECT_EQ(last.phase, job::JobPhase::Finished);
  EXPECT_TRUE(std::ranges::all_of(talk.journal, [](const auto& record) { return record.job == 1; }));
}

TEST(JobRecorder, NumbersJobs) {
  auto talk = connected();
  talk.run("G0X1\n");
  talk.pass(2s);
  talk.run("G0X2\n");
  talk.pass(2s);
  EXPECT_EQ(talk.journal.back().job, 2U);
  EXPECT_THAT(all_of<job::JobBegun>(talk.journal), SizeIs(2));
}

// protocol: what stands before the first line is what a resumed job begins with.
TEST(JobRecorder, BeginsWhenModesAndOffsetsAreKnown) {
  auto talk = connected();
  talk.submit(SendLine{"G10L20P1X0"});
  talk.replies.lines["$#"] = "[G54:7.000,2.000,3.000]\r\n[G92:0.000,0.000,0.000]\r\n[TLO:0.000]\r\nok\r\n";
  talk.run("G0X1\n");
  EXPECT_THAT(talk.lines_sent, ElementsAre("G10L20P1X0", "$G", "$#", "G0X1", "G4P0"));
  const auto begun = all_of<job::JobBegun>(talk.journal);
  ASSERT_THAT(begun, SizeIs(1));
  EXPECT_THAT(begun[0].machine.offsets_mm.at("G54"), ElementsAre(7, 2, 3));
  EXPECT_TRUE(begun[0].machine.offsets_are_current);
  EXPECT_TRUE(begun[0].machine.modes_are_current);
}

TEST(JobRecorder, AJobThatWaitsForItsBeginningIsGivenUp) {
  auto talk = connected();
  talk.submit(SendLine{"G10L20P1X0"});
  talk.replies.answers_lines = false;
  talk.run("G0X1\n");
  EXPECT_FALSE(talk.session.job());
  talk.submit(SendLine{"G0X5"});
  EXPECT_THAT(talk.told<CommandRefused>(), SizeIs(1));
  talk.pass(6s);
  EXPECT_THAT(talk.told<CommandRefused>(), SizeIs(2));
  EXPECT_THAT(talk.journal, IsEmpty());
}

TEST(JobRecorder, AdvancesAreFortyMillisecondsApart) {
  auto talk = connected();
  talk.replies.status = "<Run|MPos:0.000,0.000,0.000|FS:500,0>\r\n";
  talk.replies.answers_lines = false;
  std::string text;
  for (int line = 0; line < 500; ++line) text += "G1X" + std::to_string(line) + "F100\n";
  talk.run(text);
  const Instant begin = talk.now;
  for (int line = 0; line < 400; ++line) {
    talk.hear("ok\r\n");
    talk.pass(5ms);
  }
  const auto took = talk.now - begin;
  const auto advances = all_of<job::JobAdvanced>(talk.journal);
  EXPECT_LE(static_cast<double>(advances.size()), base::to_seconds(took) / 0.040 + 2);
  EXPECT_GE(static_cast<double>(advances.size()), base::to_seconds(took) / 0.050);
  Instant before{};
  for (const auto& record : talk.journal) {
    if (!std::holds_alternative<job::JobAdvanced>(record.what)) continue;
    EXPECT_GE(record.at - before, 40ms);
    before = record.at;
  }
  talk.pass(45ms);
  EXPECT_EQ(all_of<job::JobAdvanced>(talk.journal).back().line_acknowledged, 400U);
  EXPECT_GT(all_of<job::JobAdvanced>(talk.journal).back().line_sent, 400U);
}

TEST(JobRecorder, AMachineThatStandsStillIsWrittenDownOnce) {
  auto talk = connected();
  talk.replies.answers_lines = false;
  talk.replies.status = "<Hold:0|MPos:0.000,0.000,0.000|FS:0,0>\r\n";
  talk.run("G0X1\nG0X2\n");
  talk.submit(HoldJob{});
  talk.pass(1s);
  const std::size_t records = talk.journal.size();
  talk.pass(60s);
  EXPECT_EQ(talk.journal.size(), records);
  EXPECT_THAT(kinds_of(talk.journal), ElementsAre(NoteKind::Commanded, NoteKind::Held));
}

TEST(JobRecorder, NotesWhatHappened) {
  auto talk = connected();
  talk.replies.answers_lines = false;
  talk.run("G0X1\nG0X2\nG0X3\n");
  talk.hear("[MSG:turn the part]\r\nok\r\nerror:20\r\n");
  talk.session.on_closed(talk.now, LinkLoss::Unplugged);
  talk.hear("");
  EXPECT_THAT(kinds_of(talk.journal),
              ElementsAre(NoteKind::Message, NoteKind::LineRefused, NoteKind::LinkLost, NoteKind::LinesLost));
  const auto notes = all_of<job::JobNoted>(talk.journal);
  EXPECT_EQ(notes[0].text, "turn the part");
  EXPECT_EQ(notes[1].line, 2U);
  EXPECT_THAT(notes[1].text, HasSubstr("error:20 to 'G0X2'"));
  EXPECT_EQ(notes[3].line, 3U);
  EXPECT_EQ(std::get<job::JobClosed>(talk.journal.back().what).state.phase, job::JobPhase::Interrupted);
}

TEST(JobRecorder, PasswordsAreInNoRecord) {
  auto replies = grblhal_replies();
  replies.lines["$$"] = "$0=10\r\n$75=verysecret\r\n$110=500.000\r\nok\r\n";
  auto talk = connected(std::move(replies));
  talk.run("G0X1\n");
  const auto begun = all_of<job::JobBegun>(talk.journal).at(0);
  for (const auto& setting : begun.machine.settings) EXPECT_NE(setting.value, "verysecret");
}

}  // namespace
}  // namespace kerf::session
