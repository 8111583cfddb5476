#include "sender/job/job.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using vocabulary::MachineState;

class JobTest : public testing::Test {
 protected:
  Job make(JobTerms terms = {}) {
    return Job{now_, **Program::load("part.nc", "G1X1\nG1X2\nG1X3\n"), std::move(terms)};
  }
  machine::Snapshot in(MachineState state, std::optional<int> substate = std::nullopt) {
    machine::Snapshot snapshot;
    snapshot.state = state;
    snapshot.substate = substate;
    return snapshot;
  }
  void answer(Job& job, std::uint32_t line, int code = 0) {
    job.on_answer(now_, {.file_line = line,
                         .file_offset_after = std::uint64_t{line} * 5,
                         .text = "G1",
                         .error_code = code,
                         .meaning = "No."});
  }

  Instant now_{};
};

TEST_F(JobTest, FinishesWithTheSyncAnsweredAndIdleSeen) {
  auto job = make();
  answer(job, 1);
  answer(job, 2);
  answer(job, 3);
  job.on_lines_answered(now_);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::SendSync));
  job.on_snapshot(now_, in(MachineState::Idle));
  EXPECT_EQ(job.state().phase, JobPhase::Running);
  job.on_sync_answered(now_);
  job.on_snapshot(now_ + 1s, in(MachineState::Idle));
  EXPECT_EQ(job.state().phase, JobPhase::Finished);
  EXPECT_EQ(job.state().progress.percent, 100);
  EXPECT_EQ(job.state().progress.lines_acknowledged, 3U);
}

TEST_F(JobTest, ResumesOnlyAtRest) {
  auto job = make();
  job.hold(now_);
  EXPECT_EQ(job.state().phase, JobPhase::Holding);
  job.on_snapshot(now_, in(MachineState::Hold, 1));
  EXPECT_FALSE(job.can_resume());
  job.on_snapshot(now_ + 100ms, in(MachineState::Hold, 0));
  EXPECT_EQ(job.state().phase, JobPhase::Held);
  ASSERT_TRUE(job.can_resume());
  job.resume(now_ + 5s);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::FeedHold, JobOrder::CycleStart));
  EXPECT_EQ(job.state().phase, JobPhase::Running);
  // A report from before the cycle start does not hold the job again.
  job.on_snapshot(now_ + 5s + 10ms, in(MachineState::Hold, 0));
  EXPECT_EQ(job.state().phase, JobPhase::Running);
}

TEST_F(JobTest, RepeatsAHoldThatGotLost) {
  auto job = make();
  job.hold(now_);
  job.on_snapshot(now_ + 500ms, in(MachineState::Run));
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::FeedHold));
  job.on_snapshot(now_ + 1100ms, in(MachineState::Run));
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::FeedHold));
}

TEST_F(JobTest, OpenDoorCannotBeResumedAClosedOneCan) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Door, 2));
  EXPECT_EQ(job.state().phase, JobPhase::Holding);
  job.on_snapshot(now_, in(MachineState::Door, 1));
  EXPECT_EQ(job.state().hold_cause, HoldCause::Door);
  EXPECT_FALSE(job.can_resume());
  job.on_snapshot(now_, in(MachineState::Door, 0));
  EXPECT_TRUE(job.can_resume());
}

TEST_F(JobTest, StopsByHoldStandstillReset) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Run));
  job.stop(now_);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::StopFeeding, JobOrder::FeedHold));
  job.on_snapshot(now_ + 50ms, in(MachineState::Hold, 1));
  EXPECT_THAT(job.take_orders(), IsEmpty());
  job.on_snapshot(now_ + 200ms, in(MachineState::Hold, 0));
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::SoftReset));
  job.on_welcome(now_ + 300ms);
  EXPECT_EQ(job.state().phase, JobPhase::Stopped);
  EXPECT_FALSE(job.state().position_suspect);
}

TEST_F(JobTest, AStopThatNobodyAnswersResetsAfterAWhile) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Run));
  job.stop(now_);
  Instant now = now_;
  int resets = 0;
  for (int wake = 0; wake < 20 && job.next_deadline() != kNever; ++wake) {
    now = job.next_deadline();
    job.advance_to(now);
    for (const auto order : job.take_orders()) resets += order == JobOrder::SoftReset;
  }
  EXPECT_EQ(resets, 1);
  EXPECT_EQ(job.state().phase, JobPhase::Stopped);
  EXPECT_TRUE(job.state().position_suspect);
}

TEST_F(JobTest, AbortInMotionLeavesThePositionSuspect) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Run));
  job.abort(now_);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::StopFeeding, JobOrder::SoftReset));
  job.on_alarm(now_, 3, "");
  job.on_welcome(now_);
  EXPECT_EQ(job.state().phase, JobPhase::Stopped);
  EXPECT_TRUE(job.state().position_suspect);
}

TEST_F(JobTest, ARefusedLineHoldsAndAsks) {
  auto job = make();
  answer(job, 1, 20);
  EXPECT_EQ(job.state().phase, JobPhase::Holding);
  EXPECT_EQ(job.state().hold_cause, HoldCause::Refusal);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::HoldFeeding, JobOrder::FeedHold));
  answer(job, 2);
  job.on_lines_answered(now_);
  EXPECT_THAT(job.take_orders(), IsEmpty()) << "nothing goes on by itself";
  job.on_snapshot(now_, in(MachineState::Hold, 0));
  EXPECT_EQ(job.state().phase, JobPhase::Held);
  EXPECT_EQ(job.state().hold_cause, HoldCause::Refusal);
  job.resume(now_ + 1s);
  job.on_lines_answered(now_ + 1s);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::CycleStart, JobOrder::FeedAgain));
  EXPECT_EQ(job.goes_on_at(), 3U) << "line 2 was taken";
  EXPECT_EQ(job.state().aftermath.lines_executed_after_refusal, 1U);
  EXPECT_EQ(job.state().lines_refused, 1U);
}

TEST_F(JobTest, WhatALatchRefusedIsSentAgain) {
  auto job = make({.has_error_latch = true});
  answer(job, 1, 20);
  EXPECT_TRUE(
      job.on_answer(now_, {.file_line = 2, .file_offset_after = 10, .text = "G1X2", .error_code = 20, .meaning = ""}));
  EXPECT_EQ(job.state().aftermath.lines_not_executed, 2U);
  job.on_snapshot(now_, in(MachineState::Hold, 0));
  job.resume(now_ + 1s);
  static_cast<void>(job.take_orders());
  job.on_lines_answered(now_ + 1s);
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::ClearLatch, JobOrder::FeedAgain));
  EXPECT_EQ(job.goes_on_at(), 2U);
  EXPECT_EQ(job.state().aftermath.lines_not_executed, 1U);
  EXPECT_EQ(job.state().lines_refused, 1U);
}

TEST_F(JobTest, ADoorDoesNotAnswerTheQuestion) {
  auto job = make();
  answer(job, 1, 20);
  job.on_snapshot(now_, in(MachineState::Door, 0));
  job.resume(now_ + 1s);
  static_cast<void>(job.take_orders());
  job.on_snapshot(now_ + 2s, in(MachineState::Run));
  EXPECT_THAT(job.take_orders(), ElementsAre(JobOrder::FeedHold));
  EXPECT_EQ(job.state().hold_cause, HoldCause::Refusal);
}

TEST_F(JobTest, OnlyTheOperatorAnswersTheQuestionOfAStall) {
  for (const bool is_safe : {false, true}) {
    auto job = make();
    job.hold_for(now_, {.cause = StallCause::LostAnswer, .goes_on_at = is_safe ? std::optional{3U} : std::nullopt});
    static_cast<void>(job.take_orders());
    // A state that was changed on its way, and a door that is opened and closed.
    job.on_snapshot(now_ + 1s, in(MachineState::Unknown));
    job.on_snapshot(now_ + 2s, in(MachineState::Door, 1));
    job.on_stall(std::nullopt);
    job.on_snapshot(now_ + 3s, in(MachineState::Run));
    job.on_snapshot(now_ + 4s, in(MachineState::Idle));
    EXPECT_THAT(job.take_orders(), IsEmpty());
    EXPECT_EQ(job.state().phase, JobPhase::Held);
    EXPECT_EQ(job.state().hold_cause, HoldCause::Stall);
    job.resume(now_ + 5s);
    EXPECT_EQ(job.take_orders().empty(), !is_safe);
    EXPECT_EQ(job.goes_on_at(), is_safe ? 3U : 0U);
  }
}

TEST_F(JobTest, AStopForARefusedLineEndsAsRefused) {
  for (const auto policy : {ErrorPolicy::Stop, ErrorPolicy::HoldAndAsk}) {
    auto job = make({.on_error = policy});
    answer(job, 1, 20);
    job.on_snapshot(now_, in(MachineState::Hold, 0));
    job.stop(now_ + 1s);
    job.on_lines_lost(2, 2);
    job.on_welcome(now_ + 2s);
    EXPECT_EQ(job.state().phase, JobPhase::Refused);
    EXPECT_EQ(job.state().aftermath.lines_not_executed, 3U);
    EXPECT_FALSE(job.state().position_suspect);
  }
}

TEST_F(JobTest, ContinueGoesOnWithoutTheLineAndSaysSo) {
  auto job = make({.on_error = ErrorPolicy::Continue});
  answer(job, 1);
  answer(job, 2, 20);
  answer(job, 3);
  EXPECT_THAT(job.take_orders(), IsEmpty());
  job.on_lines_answered(now_);
  job.on_sync_answered(now_);
  job.on_snapshot(now_, in(MachineState::Idle));
  EXPECT_EQ(job.state().phase, JobPhase::Finished);
  EXPECT_EQ(job.state().lines_refused, 1U);
  EXPECT_EQ(job.state().reason, "The machine stands still; 1 refused line was left out, the last is line 2.");
}

TEST_F(JobTest, AHoldOfTheProgramsOwnIsNamed) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Hold, 0), "M0");
  EXPECT_EQ(job.state().hold_cause, HoldCause::ProgramPause);
  auto single = make();
  auto snapshot = in(MachineState::Hold, 0);
  snapshot.inputs.emplace().single_block = true;
  single.on_snapshot(now_, snapshot, "G1X1");
  EXPECT_EQ(single.state().hold_cause, HoldCause::SingleBlock);
  auto asked = make();
  asked.hold(now_);
  asked.on_snapshot(now_, in(MachineState::Hold, 0), "M0");
  EXPECT_EQ(asked.state().hold_cause, HoldCause::FeedHold);
}

TEST_F(JobTest, AlarmWaitsForTheAnswersThatStillCome) {
  auto job = make();
  job.on_alarm(now_, 5, "Probe found nothing");
  EXPECT_EQ(job.state().phase, JobPhase::Draining);
  answer(job, 1);
  answer(job, 2, 9);
  job.on_lines_answered(now_);
  EXPECT_EQ(job.state().phase, JobPhase::Alarmed);
  EXPECT_FALSE(job.state().refusal);
  EXPECT_EQ(job.state().alarm_code, 5);
}

TEST_F(JobTest, AnAlarmSeenInAReportOnlyEndsTheJobToo) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Alarm, 1));
  job.advance_to(job.next_deadline());
  EXPECT_EQ(job.state().phase, JobPhase::Alarmed);
  EXPECT_TRUE(job.state().position_suspect);
}

TEST_F(JobTest, AnythingFromOutsideInterrupts) {
  auto restarted = make();
  restarted.on_welcome(now_);
  EXPECT_EQ(restarted.state().phase, JobPhase::Interrupted);
  auto unplugged = make();
  unplugged.on_link_closed(now_);
  EXPECT_EQ(unplugged.state().phase, JobPhase::Interrupted);
  auto pendant = make();
  auto snapshot = in(MachineState::Run);
  snapshot.pendant_in_control = true;
  pendant.on_snapshot(now_, snapshot);
  EXPECT_EQ(pendant.state().phase, JobPhase::Interrupted);
  auto asleep = make();
  asleep.on_snapshot(now_, in(MachineState::Sleep));
  EXPECT_EQ(asleep.state().phase, JobPhase::Interrupted);
}

TEST_F(JobTest, ResetInMotionFromOutsideIsAnInterruption) {
  auto job = make();
  job.on_snapshot(now_, in(MachineState::Run));
  job.on_alarm(now_, 3, "");
  job.on_lines_lost(2, 2);
  job.on_lines_answered(now_);
  EXPECT_EQ(job.state().phase, JobPhase::Draining);
  job.on_welcome(now_ + 500ms);
  EXPECT_EQ(job.state().phase, JobPhase::Interrupted);
  EXPECT_TRUE(job.state().position_suspect);
  EXPECT_EQ(job.state().aftermath.first_line_not_executed, 2U);
}

TEST_F(JobTest, NothingLeavesAFinalPhase) {
  auto job = make();
  job.on_welcome(now_);
  static_cast<void>(job.take_orders());
  const auto state = job.state();
  job.on_snapshot(now_ + 1s, in(MachineState::Idle));
  job.on_alarm(now_ + 1s, 1, "");
  job.hold(now_ + 1s);
  job.resume(now_ + 1s);
  job.stop(now_ + 1s);
  job.abort(now_ + 1s);
  answer(job, 1, 20);
  EXPECT_EQ(job.state(), state);
  EXPECT_THAT(job.take_orders(), IsEmpty());
}

TEST(ProgressMeter, EstimatesFromThePaceWithoutTheHolds) {
  ProgressMeter meter;
  meter.start(Instant{}, 100, 1000);
  EXPECT_FALSE(meter.at(Instant{10s}).remaining_s);
  meter.acknowledge(25, 250);
  meter.set_held(Instant{10s}, true);
  meter.set_held(Instant{20s}, false);
  const auto progress = meter.at(Instant{20s});
  EXPECT_DOUBLE_EQ(progress.percent, 25);
  EXPECT_DOUBLE_EQ(progress.elapsed_s, 20);
  EXPECT_DOUBLE_EQ(progress.held_s, 10);
  EXPECT_DOUBLE_EQ(*progress.remaining_s, 30);
}

TEST(ProgressMeter, FollowsTheRehearsalWhenThePlannerHasSwallowedTheProgram) {
  ProgressMeter meter;
  meter.start(Instant{}, 4, 40, std::make_shared<Timeline>(Timeline{{10, 20, 30, 40}, 100}));
  meter.acknowledge(4, 40);
  EXPECT_DOUBLE_EQ(meter.at(Instant{10s}).percent, 25);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{10s}).remaining_s, 30);
  EXPECT_EQ(meter.at(Instant{9s}).cutting_line, 1U);
  EXPECT_EQ(meter.at(Instant{10s}).cutting_line, 2U);
  meter.set_held(Instant{10s}, true);
  meter.set_held(Instant{20s}, false);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{20s}).remaining_s, 30) << "a hold is not machining";
  meter.set_overrides(Instant{20s}, 50, 100);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{20s}).remaining_s, 60);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{40s}).remaining_s, 40);
  meter.complete();
  EXPECT_DOUBLE_EQ(meter.at(Instant{90s}).percent, 100);
}

TEST(ProgressMeter, ScalesCuttingByTheFeedOverrideAndRapidsByTheirOwn) {
  ProgressMeter meter;
  meter.start(Instant{}, 2, 20, std::make_shared<Timeline>(Timeline{{20, 40}, 100, 1.0, 0.25}));
  meter.acknowledge(2, 20);
  meter.set_overrides(Instant{}, 50, 100);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{}).remaining_s, 70) << "30 s of cutting take 60 s, 10 s of rapids stay";
  meter.set_overrides(Instant{}, 100, 25);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{}).remaining_s, 70) << "10 s of rapids take 40 s, 30 s of cutting stay";
  meter.set_overrides(Instant{}, 0, 0);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{}).remaining_s, 70) << "no machine goes at nothing";
  meter.set_overrides(Instant{}, 100, 100);
  EXPECT_DOUBLE_EQ(*meter.at(Instant{}).remaining_s, 40);
}

TEST(ProgressMeter, TheRestFollowsThePaceThatTheJobHasKept) {
  ProgressMeter slow;
  slow.start(Instant{}, 4, 40, std::make_shared<Timeline>(Timeline{{100, 200, 300, 400}, 1}));
  slow.acknowledge(1, 10);
  EXPECT_DOUBLE_EQ(slow.at(Instant{100s}).remaining_s.value(), 300) << "as rehearsed";
  EXPECT_DOUBLE_EQ(slow.at(Instant{230s}).remaining_s.value(), 600) << "100 s took 230 s: half as fast, nearly";
  slow.set_held(Instant{230s}, true);
  EXPECT_DOUBLE_EQ(slow.at(Instant{900s}).remaining_s.value(), 600) << "a hold says nothing about the pace";
  slow.set_held(Instant{900s}, false);
  EXPECT_DOUBLE_EQ(slow.at(Instant{900s}).remaining_s.value(), 600);

  ProgressMeter fast;
  fast.start(Instant{}, 4, 40, std::make_shared<Timeline>(Timeline{{100, 200, 300, 400}, 1}));
  fast.acknowledge(3, 30);
  EXPECT_DOUBLE_EQ(fast.at(Instant{85s}).remaining_s.value(), 100) << "200 s took 85 s: twice as fast";
}

TEST(ProgressMeter, IsNeverAheadOfTheAcknowledgedLinesNorMoreThanAPlannerBehind) {
  ProgressMeter meter;
  meter.start(Instant{}, 4, 40, std::make_shared<Timeline>(Timeline{{10, 20, 30, 40}, 1}));
  meter.acknowledge(1, 10);
  EXPECT_DOUBLE_EQ(meter.at(Instant{35s}).percent, 25);
  meter.acknowledge(4, 40);
  EXPECT_DOUBLE_EQ(meter.at(Instant{1s}).percent, 75);
}

}  // namespace
}  // namespace kerf::job
