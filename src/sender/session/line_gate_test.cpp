#include "sender/session/line_gate.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

machine::Snapshot in_state(MachineState state) {
  machine::Snapshot snapshot;
  snapshot.state = state;
  return snapshot;
}

/// A gate behind a handshake, and a clock.
struct Gate : testing::Test {
  void report(MachineState state, bool is_at_work = false) {
    gate.on_asked(now);
    now += 10ms;
    gate.on_report(now, in_state(state), is_at_work);
  }
  Gate() { gate.open(now); }

  Instant now{};
  LineGate gate;
};

TEST_F(Gate, MotionThatNobodyOrderedClosesItUntilItEnds) {
  report(MachineState::Idle);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
  report(MachineState::Run);
  EXPECT_EQ(gate.verdict(now), GateVerdict::ForeignMotion);
  EXPECT_TRUE(gate.take_notice());
  report(MachineState::Jog);
  EXPECT_FALSE(gate.take_notice());
  report(MachineState::Idle);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
}

TEST_F(Gate, OwnMotionKeepsItOpen) {
  report(MachineState::Idle);
  gate.on_activity(now);
  // Asked for before the answer came: it says nothing about what the line does.
  gate.on_asked(now);
  now += 5ms;
  gate.on_activity(now);
  now += 5ms;
  gate.on_report(now, in_state(MachineState::Idle), false);
  report(MachineState::Run);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
  report(MachineState::Hold);
  report(MachineState::Run);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
}

TEST_F(Gate, WhatBeginsAfterOwnMotionHasEndedIsForeign) {
  gate.on_activity(now);
  report(MachineState::Run);
  report(MachineState::Idle);
  report(MachineState::Run);
  EXPECT_EQ(gate.verdict(now), GateVerdict::ForeignMotion);
}

TEST_F(Gate, ALineThatIsOwedMakesMotionOwn) {
  report(MachineState::Idle);
  report(MachineState::Run, true);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
}

TEST_F(Gate, OldKnowledgeIsNone) {
  report(MachineState::Idle);
  now += 3s;
  EXPECT_EQ(gate.verdict(now), GateVerdict::Blind);
  // A late answer is as old as its question.
  gate.on_asked(now);
  now += 2s;
  gate.on_report(now, in_state(MachineState::Idle), false);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Blind);
  report(MachineState::Idle);
  EXPECT_EQ(gate.verdict(now), GateVerdict::Open);
}

}  // namespace
}  // namespace kerf::session
