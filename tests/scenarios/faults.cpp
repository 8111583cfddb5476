// A machine whose cable, power and controller fail, and a sender that must neither lie nor cut on.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using firmware::RigRecordKind;
using job::JobPhase;
using session::SessionPhase;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class Faults : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, Faults, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

std::vector<firmware::RigRecord> logged(const simulation::World& world, RigRecordKind kind) {
  std::vector<firmware::RigRecord> records;
  std::ranges::copy_if(world.log(), std::back_inserter(records),
                       [kind](const auto& record) { return record.kind == kind; });
  return records;
}

bool account_adds_up(const simulation::World& world) {
  const auto& ledger = world.session().ledger();
  return ledger.lines_entered() == ledger.lines_settled() + ledger.lines_struck_out() + ledger.size();
}

TEST_P(Faults, ARebootInAJobIsNoticedAndNothingIsSentOn) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(30), 3s));
  ASSERT_TRUE(world.order("reboot"));
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_NE(world.session().job()->phase, JobPhase::Finished);
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  world.run_for(1min);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
  EXPECT_EQ(world.controller().motor_steps(), vocabulary::AxisSteps{});
  EXPECT_TRUE(account_adds_up(world));
}

std::string welcome_of(Firmware firmware) {
  switch (firmware) {
    case Firmware::Rabbit: return "\r\nRabbit GRBL v1.6.0 Build 20260315  \r\n";
    case Firmware::GrblHal: return "\r\nGrblHAL 1.1f ['$' or '$HELP' for help]\r\n";
    default: return "\r\nGrbl 1.1h ['$' for help]\r\n";
  }
}

TEST_P(Faults, NoLineLeavesBetweenAnAnswerAndAWelcomeThatCameTogether) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(30), 3s));
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  world.inject_to_session("ok\r\nok\r\nok\r\n" + welcome_of(GetParam()));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
}

// The answer may be the last word of a controller that somebody resets.
TEST_P(Faults, NoLineFollowsAnAnswerThatComesInAHold) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(200), 3s));
  world.submit(session::HoldJob{});
  const auto is_held = [](const auto& w) { return w.session().job()->phase == JobPhase::Held; };
  ASSERT_TRUE(world.run_until(is_held, 10s));
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  world.inject_to_session("ok\r\nok\r\nok\r\n");
  world.run_for(1s);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
  world.submit(session::ResumeJob{});
  world.run_for(10ms);
  EXPECT_GT(lines_sent(world, streaming::Purpose::JobLine), lines);
}

// They would be executed with default modes.
TEST_P(Faults, LinesOnTheirWayToAControllerThatRestartedAreDroppedByOneMoreReset) {
  auto options = quick_network(GetParam());
  options.wire.latency = 60ms;
  World world{options};
  ASSERT_TRUE(start(world, zigzag(30), 3s));
  ASSERT_FALSE(world.session().ledger().empty());
  const auto announced = told<session::ControllerReset>(world).size();
  ASSERT_TRUE(world.order("reset"));
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(told<session::ControllerReset>(world).size(), announced + 1);
  const auto ready = [](const auto& w) { return w.session().phase() == SessionPhase::Ready; };
  ASSERT_TRUE(world.run_until(ready, 20s));
  EXPECT_EQ(told<session::ControllerReset>(world).size(), announced + 1);
  EXPECT_TRUE(account_adds_up(world));
}

TEST_P(Faults, ACutLinkInterruptsWhereTheScriptSays) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.play("when line 20 link cut\nafter 2s link restore\n"));
  world.submit(session::StartJob{program(zigzag(30))});
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
  EXPECT_EQ(world.session().phase(), SessionPhase::Closed);
  world.run_for(3s);
  ASSERT_THAT(logged(world, RigRecordKind::Script), SizeIs(2));
  world.open();
  ASSERT_TRUE(world.run_until(is_ready, 5min));
  EXPECT_TRUE(account_adds_up(world));
}

TEST_P(Faults, ADoorThatOpensInTheMiddleOfAJobOnlyPausesIt) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.play("when line 20 door open\nafter 3s door close\n"));
  world.submit(session::StartJob{program(zigzag(10))});
  ASSERT_TRUE(world.run_until([](const auto& w) { return w.controller().state() == MachineState::Door; }, 1min));
  world.run_for(10s);
  EXPECT_EQ(world.controller().state(), MachineState::Door);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 5min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished);
  EXPECT_NEAR(position_mm(world, 1), 10, 0.001);
}

TEST_P(Faults, LatencyOnlyCostsTime) {
  World world{quick_network(GetParam())};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.order("delay both 120ms"));
  world.submit(session::StartJob{program(zigzag(6))});
  ASSERT_TRUE(world.run_until(is_over, 10min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished);
  EXPECT_NEAR(position_mm(world, 1), 6, 0.001);
}

TEST_P(Faults, AStallOnlyCostsTime) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  ASSERT_TRUE(world.order("stall 1500ms"));
  ASSERT_TRUE(world.run_until(is_over, 10min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished);
  EXPECT_NEAR(position_mm(world, 1), 10, 0.001);
}

// Whatever the wire does: the account adds up, the job never claims to be complete with lines unanswered, and the same
// seed gives the same bytes and the same log.
std::string run_on_a_bad_wire(Firmware firmware, unsigned seed) {
  World world{seed % 2 == 0 ? quick_serial(firmware) : quick_network(firmware)};
  EXPECT_TRUE(connect(world));
  for (const std::string& line : {"seed " + std::to_string(seed), std::string("corrupt both rate 0.002"),
                                  std::string("drop both rate 0.001"), std::string("duplicate both rate 0.001")}) {
    EXPECT_TRUE(world.order(line));
  }
  world.submit(session::StartJob{program(zigzag(12))});
  for (int second = 0; second < 40; ++second) {
    world.run_for(1s);
    EXPECT_TRUE(account_adds_up(world));
  }
  if (world.session().job() && world.session().job()->phase == JobPhase::Finished) {
    EXPECT_EQ(world.session().ledger().size(), 0U);
  }
  std::string log;
  for (const auto& record : world.log()) log += std::to_string(base::to_seconds(record.at)) + " " + record.what + "\n";
  return world.transcript_text() + log;
}

TEST_P(Faults, ABadWireIsSurvivedAndRepeatable) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const std::string told = run_on_a_bad_wire(GetParam(), seed);
    EXPECT_EQ(run_on_a_bad_wire(GetParam(), seed), told);
    EXPECT_NE(told.find(" on the way "), std::string::npos);
  }
}

}  // namespace
}  // namespace kerf::scenarios
