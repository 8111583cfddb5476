// Connecting to a machine that rests: fresh, silent, locked, in check mode, with something left in its buffer.

#include "starts.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using machine::HandshakeStage;
using session::ResetPolicy;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class Starts : public testing::TestWithParam<Firmware> {
 protected:
  [[nodiscard]] static WorldOptions options() { return quick_serial(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Firmwares, Starts, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(Starts, AFreshBootIsAStraightPathAndEveryStepIsLogged) {
  auto fresh = options();
  fresh.opening_resets = true;
  World world{fresh};
  ASSERT_TRUE(connect(world));
  EXPECT_THAT(path(world), ElementsAre(HandshakeStage::Listening, HandshakeStage::Asking, HandshakeStage::Clearing,
                                       HandshakeStage::Questioning, HandshakeStage::Ready));
  Instant last{};
  for (const auto& moved : told<session::HandshakeMoved>(world)) {
    EXPECT_GE(moved.change.at, last);
    last = moved.change.at;
  }
  EXPECT_EQ(resets_sent(world), 0U);
  EXPECT_THAT(outcome(world), HasSubstr("it is idle."));
}

TEST_P(Starts, ASilentControllerIsAskedAndAnnouncedResetsAreTheOnlyOnes) {
  for (const bool network : {false, true}) {
    auto silent = network ? quick_network(GetParam()) : options();
    silent.head_start = 1min;
    World world{silent};
    ASSERT_TRUE(connect(world));
    EXPECT_EQ(resets_sent(world), told<session::ControllerReset>(world).size());
    EXPECT_EQ(world.session().capabilities().family, GetParam());
  }
}

TEST_P(Starts, NothingIsResetWhenThePolicyForbidsIt) {
  auto polite = options();
  polite.head_start = 1min;
  polite.session.reset_policy = ResetPolicy::Never;
  World world{polite};
  ASSERT_TRUE(connect(world));
  EXPECT_EQ(resets_sent(world), 0U);
  EXPECT_TRUE(world.session().capabilities().complete);
}

TEST_P(Starts, ALateWelcomeBeginsAgain) {
  for (const auto late : {300ms, 700ms, 1500ms, 2400ms, 4000ms, 30000ms}) {
    SCOPED_TRACE(late.count());
    World world{options()};
    ASSERT_TRUE(world.order("power off"));
    world.open();
    world.run_for(late);
    ASSERT_TRUE(world.order("power on"));
    ASSERT_TRUE(world.run_until(is_ready, 60s));
    EXPECT_EQ(resets_sent(world), 0U);
  }
}

TEST_P(Starts, ARestartAtAnyMomentOfTheHandshakeBeginsAgain) {
  for (int step = 0; step < 30; ++step) {
    SCOPED_TRACE(step);
    auto fresh = options();
    fresh.opening_resets = true;
    World world{fresh};
    world.open();
    world.run_for(50ms * step);
    ASSERT_TRUE(world.order("reboot"));
    ASSERT_TRUE(world.run_until(is_ready, 60s));
    world.run_for(5s);
    EXPECT_TRUE(is_ready(world));
    EXPECT_TRUE(world.session().capabilities().complete);
  }
}

TEST_P(Starts, AHalfLineIsNeverExecuted) {
  for (const char* half : {"G21G91G0X50", "G91 G0 X50 (half a comment", "$J=G91X50F3000", "g0x5"}) {
    for (const auto policy : {ResetPolicy::WhenAtRest, ResetPolicy::Never}) {
      SCOPED_TRACE(half);
      auto left = options();
      left.session.reset_policy = policy;
      World world{left};
      before_kerf(world, half);
      ASSERT_TRUE(connect(world));
      world.run_for(10s);
      EXPECT_EQ(world.controller().motor_steps(), vocabulary::AxisSteps{});
    }
  }
}

TEST_P(Starts, LineEndsThatWereLeftBehindConfuseNothing) {
  for (const char* left : {"\n", "\r", "\r\n", "\n\n\n\r", "G4P0\r\n\n", "G1X"}) {
    SCOPED_TRACE(left);
    World world{options()};
    world.open();
    world.run_for(490ms);
    world.inject_to_controller(left);
    ASSERT_TRUE(world.run_until(is_ready, 60s));
    EXPECT_EQ(world.session().capabilities().family, GetParam());
    EXPECT_TRUE(world.session().capabilities().complete);
    EXPECT_THAT(world.session().capabilities().settings, Not(IsEmpty()));
  }
}

TEST_P(Starts, AnUnusualReportMaskIsUnderstood) {
  const std::vector<const char*> masks = GetParam() == Firmware::GrblHal
                                             ? std::vector{"0", "1", "2", "3", "511", "2047", "4095", "16383"}
                                             : std::vector{"0", "1", "2", "3"};
  for (const char* mask : masks) {
    for (const bool resets : {false, true}) {
      SCOPED_TRACE(mask);
      auto masked = options();
      masked.stored.settings["10"] = mask;
      masked.opening_resets = resets;
      World world{masked};
      ASSERT_TRUE(connect(world));
      EXPECT_EQ(world.session().capabilities().family, GetParam());
      EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
      // A move shows that states with a number behind the colon are no surprise either.
      world.submit(session::SendLine{"G91G1X10F1000"});
      world.run_for(300ms);
      EXPECT_EQ(world.session().snapshot().state, MachineState::Run);
    }
  }
}

TEST_P(Starts, ALockedMachineIsIdentifiedAndSaysSo) {
  for (const auto policy : {ResetPolicy::WhenAtRest, ResetPolicy::Never}) {
    auto locked = options();
    locked.stored.settings["22"] = GetParam() == Firmware::GrblHal ? "5" : "1";
    locked.session.reset_policy = policy;
    World world{locked};
    world.run_for(5s);
    ASSERT_TRUE(connect(world));
    EXPECT_EQ(world.session().snapshot().state, MachineState::Alarm);
    EXPECT_THAT(outcome(world), HasSubstr("alarm"));
    EXPECT_EQ(resets_sent(world), 0U);
    EXPECT_TRUE(world.session().capabilities().complete);
  }
}

TEST_P(Starts, HalfAHomingCommandInAlarmHomesNothing) {
  for (const auto policy : {ResetPolicy::WhenAtRest, ResetPolicy::Never}) {
    auto locked = options();
    locked.stored.settings["22"] = GetParam() == Firmware::GrblHal ? "5" : "1";
    locked.session.reset_policy = policy;
    World world{locked};
    world.run_for(2s);
    before_kerf(world, "$H");
    world.open();
    world.run_for(20s);
    EXPECT_EQ(world.controller().motor_steps(), vocabulary::AxisSteps{});
  }
}

TEST_P(Starts, AMachineInAHardLimitAlarmIsResetOnlyWithAWord) {
  for (const auto policy : {ResetPolicy::WhenAtRest, ResetPolicy::Never}) {
    auto guarded = options();
    guarded.stored.settings["21"] = "1";
    guarded.session.reset_policy = policy;
    World world{guarded};
    world.run_for(1s);
    before_kerf(world, "G91G1X50F1000\n");
    ASSERT_TRUE(world.order("limit X on"));
    world.run_for(2s);
    ASSERT_TRUE(world.order("limit X off"));
    ASSERT_EQ(world.controller().state(), MachineState::Alarm);
    world.open();
    world.run_for(30s);
    EXPECT_EQ(resets_sent(world), told<session::ControllerReset>(world).size());
    EXPECT_TRUE(policy != ResetPolicy::Never || resets_sent(world) == 0);
    EXPECT_THAT(outcome(world), HasSubstr(has_failed(world) ? "hard-limit alarm" : "alarm"));
    // The operator may always do it.
    world.submit(session::SoftReset{});
    ASSERT_TRUE(world.run_until(is_ready, 30s));
    EXPECT_EQ(world.session().snapshot().state, MachineState::Alarm);
  }
}

TEST_P(Starts, CheckModeLeftOnIsKeptAndSaid) {
  World world{options()};
  world.run_for(1s);
  before_kerf(world, "$C\n");
  ASSERT_EQ(world.controller().state(), MachineState::Check);
  ASSERT_TRUE(connect(world));
  EXPECT_EQ(world.controller().state(), MachineState::Check);
  EXPECT_EQ(resets_sent(world), 0U);
  EXPECT_THAT(outcome(world), HasSubstr("check mode is on"));
}

TEST_P(Starts, ADwellOfAnEarlierSenderIsNoRest) {
  World world{options()};
  world.run_for(1s);
  // Idle is what a machine in a dwell reports (protocol.md 3.2); what comes behind it must not surprise anybody.
  before_kerf(world, "G4P3\nG91G1X20F2000\n", 500ms);
  world.open();
  world.run_for(30s);
  EXPECT_TRUE(is_ready(world));
}

}  // namespace
}  // namespace kerf::scenarios
