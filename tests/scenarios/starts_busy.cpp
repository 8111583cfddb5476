// Connecting to a machine that does something which Kerf did not start: it is watched, and gets no line.

#include <chrono>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/card.hpp"
#include "starts.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using session::ResetPolicy;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class BusyStarts : public testing::TestWithParam<Firmware> {
 protected:
  [[nodiscard]] static WorldOptions options() {
    auto options = quick_serial(GetParam());
    options.stored.settings["62"] = GetParam() == Firmware::GrblHal ? "1" : "";
    if (GetParam() != Firmware::GrblHal) options.stored.settings.erase("62");
    return options;
  }
  /// Watched for a minute: not a line, not a reset.
  static void expect_untouched(World& world, std::string_view words) {
    world.open();
    world.run_for(1min);
    EXPECT_TRUE(is_waiting(world));
    EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
    EXPECT_EQ(resets_sent(world), 0U);
    EXPECT_THAT(outcome(world), HasSubstr(words));
    ASSERT_THAT(told<session::ControllerBusy>(world), SizeIs(1));
  }
};
INSTANTIATE_TEST_SUITE_P(Firmwares, BusyStarts, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(BusyStarts, MotionIsWaitedForWhateverMadeIt) {
  struct Case {
    const char* lines;
    MachineState state;
  };
  for (const auto& [lines, state] :
       {Case{"G91G1X50F1000\n", MachineState::Run}, Case{"$J=G91X50F1000\n", MachineState::Jog},
        Case{"G91G2X20I10F1000\nG4P2\nG1X5F600\n", MachineState::Run}, Case{"G91G0X20\nG0X-20\n", MachineState::Run}}) {
    for (const auto policy : {ResetPolicy::WhenAtRest, ResetPolicy::Never}) {
      SCOPED_TRACE(lines);
      auto moving = options();
      moving.session.reset_policy = policy;
      World world{moving};
      world.run_for(1s);
      before_kerf(world, lines, 300ms);
      ASSERT_EQ(world.controller().state(), state);
      world.open();
      while (world.controller().is_moving()) {
        ASSERT_TRUE(world.run_until([](const auto& w) { return !w.controller().is_moving(); }, 1min));
        EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
        EXPECT_EQ(resets_sent(world), 0U);
      }
      ASSERT_TRUE(world.run_until(is_ready, 1min));
    }
  }
}

TEST_P(BusyStarts, AMachineThatHomesIsNotDisturbed) {
  auto homing = options();
  homing.stored.settings["22"] = "1";
  World world{homing};
  world.run_for(1s);
  for (const char* line : {"switch X 60", "switch Y 60", "switch Z 20"}) ASSERT_TRUE(world.order(line));
  before_kerf(world, "$X\n", 500ms);
  before_kerf(world, "$H\n", 500ms);
  ASSERT_EQ(world.controller().state(), MachineState::Home);
  world.open();
  ASSERT_TRUE(world.run_until([](const auto& w) { return w.controller().state() != MachineState::Home; }, 5min));
  EXPECT_EQ(world.controller().state(), MachineState::Idle);
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  EXPECT_EQ(resets_sent(world), 0U);
  // Grbl answered the questions only now (protocol.md 3.2), and that begins again.
  EXPECT_TRUE(world.run_until(is_ready, 1min));
}

TEST_P(BusyStarts, AStartupLineThatMovesIsWaitedFor) {
  auto moving = options();
  moving.stored.startup_lines[0] = "G91G1X30F1000";
  moving.opening_resets = true;
  World world{moving};
  ASSERT_TRUE(connect(world));
  EXPECT_NEAR(position_mm(world, 0), 30, 0.01);
}

TEST_P(BusyStarts, AHoldThatSomebodyElseStartedIsKept) {
  World world{options()};
  world.run_for(1s);
  before_kerf(world, "G91G1X50F1000\n");
  before_kerf(world, "!");
  ASSERT_EQ(world.controller().state(), MachineState::Hold);
  const auto held_at = world.controller().position_steps();
  expect_untouched(world, "feed hold (Hold:0)");
  EXPECT_EQ(world.controller().position_steps(), held_at);
  world.submit(session::SendRealtime{'~'});
  ASSERT_TRUE(world.run_until(is_ready, 1min));
  EXPECT_NEAR(position_mm(world, 0), 50, 0.01);
}

TEST_P(BusyStarts, AHeldMachineMayBeResetByTheOperator) {
  World world{options()};
  world.run_for(1s);
  before_kerf(world, "G91G1X50F1000\n");
  before_kerf(world, "!");
  expect_untouched(world, "feed hold");
  world.submit(session::SoftReset{});
  ASSERT_TRUE(world.run_until(is_ready, 1min));
  EXPECT_THAT(told<session::ControllerReset>(world), IsEmpty());
}

TEST_P(BusyStarts, AnOpenDoorIsSaid) {
  World world{options()};
  world.run_for(1s);
  before_kerf(world, "G91G1X50F1000\n");
  ASSERT_TRUE(world.order("door open"));
  world.run_for(2s);
  ASSERT_EQ(world.controller().state(), MachineState::Door);
  expect_untouched(world, "safety door is open");
  ASSERT_TRUE(world.order("door close"));
  world.run_for(1s);
  EXPECT_TRUE(is_waiting(world));
  world.submit(session::SendRealtime{'~'});
  ASSERT_TRUE(world.run_until(is_ready, 1min));
}

TEST_P(BusyStarts, ASleepingMachineIsLeftAsleep) {
  World world{options()};
  world.run_for(1s);
  before_kerf(world, "$SLP\n");
  ASSERT_EQ(world.controller().state(), MachineState::Sleep);
  expect_untouched(world, "only a reset wakes it");
  world.submit(session::SoftReset{});
  EXPECT_TRUE(world.run_until(is_ready, 1min));
}

// What only grblHAL has.

WorldOptions grblhal_world() {
  return quick_serial(Firmware::GrblHal);
}

TEST(GrblHalStarts, AnEStopIsSaidAndNothingElseIsTried) {
  World world{grblhal_world()};
  world.run_for(1s);
  ASSERT_TRUE(world.order("estop press"));
  world.run_for(1s);
  world.open();
  ASSERT_TRUE(world.run_until(is_ready, 1min));
  EXPECT_THAT(outcome(world), HasSubstr("E-stop is pressed"));
  EXPECT_EQ(resets_sent(world), 0U);
}

TEST(GrblHalStarts, AToolChangeOfSomebodyElseIsWaitedFor) {
  World world{grblhal_world()};
  world.run_for(1s);
  before_kerf(world, "M6T1\n");
  ASSERT_EQ(world.controller().state(), MachineState::Tool);
  world.open();
  world.run_for(1min);
  EXPECT_TRUE(is_waiting(world));
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  EXPECT_THAT(outcome(world), HasSubstr("tool change"));
  before_kerf(world, "\xA3", 500ms);
  before_kerf(world, "~", 500ms);
  EXPECT_TRUE(world.run_until(is_ready, 1min));
}

TEST(GrblHalStarts, APendantIsWatchedUntilItIsReleased) {
  auto options = grblhal_world();
  options.equipment.pendant = true;
  for (const bool lost : {false, true}) {
    World world{options};
    world.run_for(1s);
    ASSERT_TRUE(world.order("pendant take"));
    world.run_for(1s);
    world.open();
    world.run_for(10s);
    ASSERT_TRUE(world.order("pendant say $J=G91X50F1000\\n"));
    world.run_for(10s);
    EXPECT_FALSE(is_ready(world));
    EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
    // The report that tells of the release may get lost.
    ASSERT_TRUE(world.order(lost ? "drop from next 200" : "faults off"));
    ASSERT_TRUE(world.order("pendant return"));
    ASSERT_TRUE(world.run_until(is_ready, 1min));
  }
}

TEST(GrblHalStarts, APendantThatTakesOverInTheMiddleStopsTheQuestions) {
  auto options = grblhal_world();
  options.equipment.pendant = true;
  for (int step = 1; step < 40; ++step) {
    SCOPED_TRACE(step);
    World world{options};
    world.open();
    world.run_for(50ms * step);
    ASSERT_TRUE(world.order("pendant take"));
    ASSERT_TRUE(world.order("pendant say $J=G91X80F1000\\n"));
    world.run_for(100ms);
    const auto lines = told<session::LineSent>(world).size();
    world.run_for(30s);
    // One may have left while the report that tells of it waited behind the rows of an answer.
    EXPECT_LE(told<session::LineSent>(world).size(), lines + 1);
    ASSERT_TRUE(world.order("pendant return"));
    EXPECT_TRUE(world.run_until(is_ready, 1min));
  }
}

TEST(GrblHalStarts, AFileThatRunsFromTheCardIsWaitedFor) {
  auto card = std::make_shared<firmware::MemoryCard>();
  card->put("/part.nc", "G91\nG1X20F1000\nG4P4\nG1X20\nG4P4\nG1X-40\nM30\n");
  for (const auto start_at : {500ms, 2500ms, 7000ms}) {
    SCOPED_TRACE(start_at.count());
    auto options = grblhal_world();
    options.equipment.card = card;
    World world{options};
    world.run_for(1s);
    before_kerf(world, "$FM\n", 200ms);
    before_kerf(world, "$F=part.nc\n", start_at);
    world.open();
    ASSERT_TRUE(world.run_until(is_ready, 5min));
    EXPECT_NEAR(position_mm(world, 0), 0, 0.01);
    EXPECT_THAT(told<session::ControllerBusy>(world)[0].sentence, HasSubstr("part.nc"));
    EXPECT_EQ(resets_sent(world), 0U);
  }
}

TEST(GrblHalStarts, ReportsThatComeByThemselvesAreNoHindrance) {
  auto options = grblhal_world();
  options.stored.settings["481"] = "100";
  for (const bool resets : {false, true}) {
    options.opening_resets = resets;
    World world{options};
    ASSERT_TRUE(connect(world));
    EXPECT_GT(world.session().snapshot().auto_report_ms, 0);
    world.submit(session::StartJob{program(zigzag(3))});
    ASSERT_TRUE(world.run_until(is_over, 1min));
    EXPECT_EQ(world.session().job()->phase, job::JobPhase::Finished);
  }
}

}  // namespace
}  // namespace kerf::scenarios
