#include "sender/job/stall_diagnosis.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using vocabulary::MachineState;

/// Idle, everything read, one answer missing for ten seconds.
StallFacts missing() {
  return {.state = MachineState::Idle,
          .planner_free = 15,
          .planner_blocks = 15,
          .rx_free = 128,
          .rx_bytes = 128,
          .owed_lines = 1,
          .first_owed_line = 7,
          .last_owed_line = 7,
          .unanswered_s = 10};
}

TEST(StallDiagnosis, EveryCauseHasItsNameItsEvidenceAndAWayOn) {
  struct Row {
    StallCause cause;
    StallFacts facts;
  };
  std::vector<Row> rows;
  const auto add = [&](StallCause cause, auto change) {
    StallFacts facts = missing();
    change(facts);
    rows.push_back({.cause = cause, .facts = facts});
  };
  add(StallCause::PlannerFull, [](auto& f) { f.state = MachineState::Run, f.planner_free = 0; });
  add(StallCause::Dwell, [](auto& f) { f.dwell_s = 60; });
  add(StallCause::Dwell, [](auto& f) { f.dwell_s = -1; });
  add(StallCause::NotReading, [](auto& f) { f.rx_free = 90; });
  add(StallCause::NotReading, [](auto& f) { f.proof = StallProof::NoAnswer; });
  add(StallCause::Hold, [](auto& f) { f.state = MachineState::Hold; });
  add(StallCause::SingleBlock, [](auto& f) { f.state = MachineState::Hold, f.single_block = true; });
  add(StallCause::Door, [](auto& f) { f.state = MachineState::Door; });
  add(StallCause::ToolChange, [](auto& f) { f.state = MachineState::Tool; });
  add(StallCause::WaitingForOperator, [](auto& f) { f.state = MachineState::Hold, f.waits_for_operator = true; });
  add(StallCause::LostAnswer, [](auto& f) { f.proof = StallProof::LinesRead, f.executed_lines = 1; });
  add(StallCause::LostLine,
      [](auto& f) { f.proof = StallProof::LinesRead, f.executed_lines = 0, f.first_not_executed = 7; });
  add(StallCause::LostLineEnd, [](auto& f) { f.proof = StallProof::LineEndMissing; });
  add(StallCause::DeadLink, [](auto& f) { f.link_is_dead = true; });
  add(StallCause::Unexplained, [](auto& f) { f.proof = StallProof::LinesRead; });
  for (const Row& row : rows) {
    const auto stall = diagnose(row.facts);
    ASSERT_TRUE(stall) << static_cast<int>(row.cause);
    EXPECT_EQ(stall->cause, row.cause) << stall->headline;
    EXPECT_THAT(stall->headline, Not(IsEmpty()));
    EXPECT_THAT(stall->evidence, Not(IsEmpty()));
    EXPECT_THAT(stall->steps, Not(IsEmpty()));
  }
}

TEST(StallDiagnosis, GoesOnOnlyWhereThatIsProven) {
  StallFacts facts = missing();
  facts.proof = StallProof::LinesRead;
  EXPECT_FALSE(diagnose(facts)->goes_on_at);
  facts.executed_lines = 1;
  EXPECT_EQ(diagnose(facts)->goes_on_at, 8U);
  facts.executed_lines = 0;
  facts.first_not_executed = 7;
  EXPECT_EQ(diagnose(facts)->goes_on_at, 7U);
  facts.proof = StallProof::LineEndMissing;
  EXPECT_FALSE(diagnose(facts)->goes_on_at);
}

TEST(StallDiagnosis, NothingIsWrongWhileAnswersAreYoung) {
  StallFacts facts = missing();
  facts.unanswered_s = 1;
  EXPECT_FALSE(diagnose(facts));
  facts.unanswered_s = 100;
  facts.owed_lines = 0;
  EXPECT_FALSE(diagnose(facts));
}

TEST(StallWatch, AsksOnceAndOnlyAControllerThatHasReadEverything) {
  StallWatch watch;
  watch.on_progress(Instant{});
  Instant now{};
  StallFacts busy = missing();
  busy.rx_free = 10;
  for (int report = 0; report < 100; ++report) static_cast<void>(watch.on_report(now += 100ms, busy));
  EXPECT_FALSE(watch.take_question());
  StallFacts facts = missing();
  int asked = 0;
  for (int report = 0; report < 100; ++report) {
    static_cast<void>(watch.on_report(now += 100ms, facts));
    asked += watch.take_question() ? 1 : 0;
  }
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(watch.proof(), StallProof::NoAnswer);
  watch.on_progress(now);
  EXPECT_EQ(watch.proof(), StallProof::NotAsked);
}

TEST(StallWatch, AHoldIsNoSilence) {
  StallWatch watch;
  watch.on_progress(Instant{});
  StallFacts facts = missing();
  facts.state = MachineState::Hold;
  Instant now{};
  for (int report = 0; report < 100; ++report) static_cast<void>(watch.on_report(now += 100ms, facts));
  facts.state = MachineState::Idle;
  for (int report = 0; report < 15; ++report) static_cast<void>(watch.on_report(now += 100ms, facts));
  EXPECT_FALSE(watch.take_question());
}

}  // namespace
}  // namespace kerf::job
