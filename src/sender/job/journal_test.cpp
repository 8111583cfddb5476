#include "sender/job/journal.hpp"

#include <chrono>
#include <limits>

#include <gtest/gtest.h>

#include "sender/job/journal_text.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;

JobBegun a_begun() {
  JobBegun begun{.program = "part.nc", .hash = "ab", .size_bytes = 12, .lines = 3};
  begun.origin = {.path = "/tmp/kerf-part \"1\".nc", .first_line = 7, .preamble_lines = 4, .continues = 12};
  MachineAtStart& machine = begun.machine;
  machine.firmware = vocabulary::Firmware::GrblHal;
  machine.settings = {{.id = "110", .value = "500.000"}};
  machine.state = vocabulary::MachineState::Idle;
  machine.modes = {.motion = "G1", .units = "G20", .feed_mm_per_min = 0.1 + 0.2};
  machine.offsets_mm = {{"G54", {1.0 / 3.0, -2, 3}}, {"G92", {}}};
  machine.offsets_are_current = true;
  machine.tool_length = {.offset_mm = std::vector<double>{-12.5}};
  machine.overrides = machine::OverridePercentages{.feed = 90};
  machine.homing = {.all = true, .axes = "XYZ"};
  return begun;
}

JobAdvanced an_advanced() {
  JobAdvanced advanced{.line_acknowledged = 5, .bytes_acknowledged = 99, .line_sent = 9};
  advanced.executing = {.from = 2, .to = 4, .known_by = ExecutingKnownBy::Position};
  advanced.reported_at = Instant{1234567890ns};
  advanced.state = vocabulary::MachineState::Run;
  advanced.machine_position_mm = std::vector<double>{1e-9, std::numeric_limits<double>::max(), -0.1};
  advanced.accessories = machine::Accessories{.spindle = machine::SpindleTurn::Clockwise, .flood = true};
  return advanced;
}

TEST(JournalText, ReadsBackWhatItWrites) {
  JobState state;
  state.phase = JobPhase::Refused;
  state.refusal = Refusal{.file_line = 3, .text = "G1 \xFF", .code = 20, .meaning = "no"};
  const JournalRecord::What all[] = {a_begun(), an_advanced(),
                                     JobNoted{.kind = NoteKind::LinkLost, .line = 3, .text = "gone"}, JobClosed{state}};
  for (const auto& what : all) {
    const JournalRecord record{.what = what};
    const auto read = parse_body(kind_of(record), body_of(record));
    ASSERT_TRUE(read) << body_of(record);
    EXPECT_EQ(*read, what) << body_of(record);
  }
}

TEST(JournalText, TakesWhatAnotherVersionWrote) {
  const auto read = parse_body("noted", R"({"kind":"Message","colour":[1,{"a":null}],"text":"x"})");
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<JobNoted>(*read), (JobNoted{.kind = NoteKind::Message, .text = "x"}));
}

TEST(JournalText, SaysWhyItIsNone) {
  EXPECT_EQ(parse_body("noted", R"({"kind":"Mess)").error(), JournalFault::NotJson);
  EXPECT_EQ(parse_body("noted", R"({"kind":"Nonsense"})").error(), JournalFault::NotARecord);
  EXPECT_EQ(parse_body("noted", R"([])").error(), JournalFault::NotARecord);
  EXPECT_EQ(parse_body("noticed", R"({})").error(), JournalFault::UnknownKind);
}

TEST(JobHistory, IsWhatItsRecordsTell) {
  JobHistory history;
  history.fold({.at = Instant{1s}, .job = 1, .what = a_begun()});
  history.fold({.at = Instant{2s}, .job = 1, .what = an_advanced()});
  history.fold({.at = Instant{3s}, .job = 1, .what = JobNoted{.text = "x"}});
  EXPECT_EQ(history.begun, a_begun());
  EXPECT_EQ(history.began_at, Instant{1s});
  EXPECT_EQ(history.last_at, Instant{3s});
  ASSERT_NE(history.latest(), nullptr);
  EXPECT_EQ(*history.latest(), an_advanced());
  EXPECT_EQ(history.notes.size(), 1U);
  EXPECT_EQ(history.outcome(), JobOutcome::CutOff);
  JobState state;
  state.phase = JobPhase::Stopped;
  history.fold({.at = Instant{4s}, .job = 1, .what = JobClosed{state}});
  EXPECT_EQ(history.outcome(), JobOutcome::Unfinished);
  history.closed->state.phase = JobPhase::Finished;
  EXPECT_EQ(history.outcome(), JobOutcome::Complete);
}

TEST(JobHistory, ForgetsOldAdvances) {
  JobHistory history;
  for (std::uint32_t line = 1; line <= 10 * kAdvancesKept; ++line) {
    history.fold({.what = JobAdvanced{.line_acknowledged = line}});
  }
  EXPECT_GE(history.advances.size(), kAdvancesKept);
  EXPECT_LE(history.advances.size(), 2 * kAdvancesKept);
  EXPECT_EQ(history.latest()->line_acknowledged, 10 * kAdvancesKept);
}

}  // namespace
}  // namespace kerf::job
