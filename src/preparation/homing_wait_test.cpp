#include "preparation/homing_wait.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::preparation {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;
using Verdict = HomingWait::Verdict;

constexpr Instant kStart{10s};

machine::Snapshot seen(MachineState state, std::uint64_t reports, bool homed) {
  machine::Snapshot now;
  now.state = state;
  now.reports = reports;
  now.homing.all = homed;
  return now;
}

session::Event answered() {
  return session::LineReceived{.message = protocol::Ok{},
                               .raw = "ok",
                               .answers = streaming::OwedLine{.purpose = streaming::Purpose::Operator, .text = "$H"}};
}

TEST(HomingWait, IsOverWhenAnsweredStandingAndHomed) {
  HomingWait wait;
  wait.begin(kStart, seen(MachineState::Alarm, 7, false));
  EXPECT_EQ(wait.look(kStart, seen(MachineState::Alarm, 7, false)), Verdict::Waiting);
  EXPECT_EQ(wait.look(kStart + 1s, seen(MachineState::Alarm, 8, false)), Verdict::Waiting);
  EXPECT_EQ(wait.look(kStart + 2min, seen(MachineState::Home, 9, false)), Verdict::Waiting);
  wait.on_event(answered());
  EXPECT_EQ(wait.look(kStart + 3min, seen(MachineState::Home, 9, true)), Verdict::Waiting);
  EXPECT_EQ(wait.look(kStart + 3min, seen(MachineState::Idle, 10, true)), Verdict::Homed);
}

TEST(HomingWait, AMachineThatWasHomedBeforeIsHomedAgain) {
  HomingWait wait;
  wait.begin(kStart, seen(MachineState::Idle, 7, true));
  EXPECT_EQ(wait.look(kStart + 1s, seen(MachineState::Idle, 8, true)), Verdict::Waiting);
}

TEST(HomingWait, SaysWhatFailed) {
  HomingWait wait;
  wait.begin(kStart, seen(MachineState::Idle, 7, false));
  wait.on_event(session::LineRefused{.purpose = streaming::Purpose::Operator,
                                     .refusal = {},
                                     .explanation = {.headline = "Line '$H' was refused: homing is off."}});
  EXPECT_EQ(wait.look(kStart, seen(MachineState::Idle, 7, false)), Verdict::Failed);
  EXPECT_EQ(wait.sentence(), "The controller refused to home. Line '$H' was refused: homing is off.");

  wait.begin(kStart, seen(MachineState::Idle, 7, false));
  wait.on_event(session::ControllerRestarted{});
  EXPECT_EQ(wait.look(kStart, seen(MachineState::Alarm, 8, false)), Verdict::Failed);
  EXPECT_EQ(wait.sentence(), "Homing ended in an alarm.");
}

TEST(HomingWait, NeverWaitsForEver) {
  HomingWait wait;
  wait.begin(kStart, seen(MachineState::Idle, 7, false));
  wait.on_event(answered());
  EXPECT_EQ(wait.look(kStart + 1s, seen(MachineState::Idle, 8, false)), Verdict::Waiting);
  EXPECT_EQ(wait.look(kStart + 7s, seen(MachineState::Idle, 9, false)), Verdict::Failed);
  EXPECT_NE(wait.sentence().find("does not say that it is homed"), std::string::npos);

  wait.begin(kStart, seen(MachineState::Idle, 7, false));
  EXPECT_EQ(wait.look(kStart + 14min, seen(MachineState::Home, 9, false)), Verdict::Waiting);
  EXPECT_EQ(wait.look(kStart + 16min, seen(MachineState::Home, 10, false)), Verdict::Failed);
}

}  // namespace
}  // namespace kerf::preparation
