// The verbs, measured at the machine itself: from every kind of motion, how far it still travels, and what state it is
// left in. v2/2a is what physics asks for; what comes on top is the firmware's segment buffer (60 ms on Grbl and
// Rabbit, 100 ms on grblHAL), the bytes ahead of the hold on the wire (25 ms) and the grain of one segment.

#include <chrono>
#include <cmath>
#include <map>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

enum class From { Rapid, Feed, Arc, Jog, Dwell };

struct FromRow {
  From from{};
  const char* name = "";
  /// Of a job, and for Jog the words.
  const char* text = "";
  /// Path speed when the verb comes, one second in.
  double speed_mm_per_s = 0;
};

constexpr double kAcceleration = 500;
constexpr FromRow kFrom[] = {
    {.from = From::Rapid, .name = "Rapid", .text = "G21G90\nG0X200\nG0X0\n", .speed_mm_per_s = 5000.0 / 60},
    {.from = From::Feed, .name = "Feed", .text = "G21G90\nG1X200F3000\nX0\n", .speed_mm_per_s = 3000.0 / 60},
    // Chords of an arc turn: the machine is a little slower than asked for, never faster.
    {.from = From::Arc, .name = "Arc", .text = "G21G90\nG2X0Y0I50J0F3000\nG1X10\n", .speed_mm_per_s = 3000.0 / 60},
    {.from = From::Jog, .name = "Jog", .text = "G21G91X150F3000", .speed_mm_per_s = 3000.0 / 60},
    {.from = From::Dwell, .name = "Dwell", .text = "G21G90\nG4P8\nG1X20F3000\n", .speed_mm_per_s = 0},
};

class Verbs : public testing::TestWithParam<std::tuple<Firmware, FromRow>> {
 protected:
  [[nodiscard]] Firmware firmware() const { return std::get<0>(GetParam()); }
  [[nodiscard]] const FromRow& row() const { return std::get<1>(GetParam()); }
  [[nodiscard]] bool jogs() const { return row().from == From::Jog; }

  /// One second into the motion.
  bool set_moving(World& world) const {
    if (!connect(world)) return false;
    world.run_for(1s);
    if (jogs()) {
      world.submit(session::Jog{row().text});
    } else {
      world.submit(session::StartJob{program(row().text)});
    }
    world.run_for(1s);
    return true;
  }

  /// Length of the path from now on until nothing has moved for half a second.
  static double travel_mm(World& world) {
    double travelled = 0;
    auto before = world.controller().position_steps();
    for (int still = 0; still < 50;) {
      world.run_for(10ms);
      const auto now = world.controller().position_steps();
      const double x = (now[0] - before[0]) / kStepsPerMm;
      const double y = (now[1] - before[1]) / kStepsPerMm;
      travelled += std::hypot(x, y);
      still = now == before ? still + 1 : 0;
      before = now;
    }
    return travelled;
  }

  [[nodiscard]] double braking_mm() const { return row().speed_mm_per_s * row().speed_mm_per_s / (2 * kAcceleration); }
  [[nodiscard]] double most_after_a_hold_mm() const {
    const double buffered_s = firmware() == Firmware::GrblHal ? 0.100 : 0.060;
    constexpr double kWireAndGrain = 0.025 + 0.012;
    return braking_mm() + row().speed_mm_per_s * (buffered_s + kWireAndGrain);
  }
  void expect_braked(double travelled) const {
    EXPECT_LE(travelled, most_after_a_hold_mm() + 0.01);
    // The chords of the arc are entered a little slower.
    EXPECT_GE(travelled, braking_mm() * 0.95);
  }
  static void expect_position_kept(const World& world) {
    ASSERT_TRUE(world.session().snapshot().machine_position_mm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR((*world.session().snapshot().machine_position_mm)[axis], position_mm(world, axis), 0.0015);
      EXPECT_EQ(world.controller().position_steps()[axis], world.controller().motor_steps()[axis]);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Firmwares, Verbs, testing::Combine(testing::ValuesIn(kFirmwares), testing::ValuesIn(kFrom)),
                         [](const auto& param) {
                           return word_for(std::get<0>(param.param)) + std::get<1>(param.param).name;
                         });

TEST_P(Verbs, HoldBrakesAndKeepsEverything) {
  World world{quick_serial(firmware())};
  ASSERT_TRUE(set_moving(world));
  world.submit(session::HoldJob{});
  expect_braked(travel_mm(world));
  expect_position_kept(world);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
  // A jog has nothing to go on with.
  EXPECT_EQ(world.session().snapshot().state, jogs() ? MachineState::Idle : MachineState::Hold);
  if (jogs()) return;
  EXPECT_EQ(world.session().job()->phase, JobPhase::Held);
  EXPECT_TRUE(world.session().snapshot().substate == vocabulary::kHoldComplete);
}

TEST_P(Verbs, ResumeGoesOnAndDoesTheRest) {
  if (jogs()) GTEST_SKIP() << "a jog that was held is over";
  World world{quick_serial(firmware())};
  ASSERT_TRUE(set_moving(world));
  world.submit(session::HoldJob{});
  (void)travel_mm(world);
  world.run_for(20s);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(world.run_until(is_over, 5min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  constexpr std::array<double, 5> kEnds{0, 0, 10, 0, 20};
  EXPECT_NEAR(position_mm(world, 0), kEnds.at(static_cast<std::size_t>(row().from)), 0.005);
  EXPECT_NEAR(position_mm(world, 1), 0, 0.005);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
}

TEST_P(Verbs, StopBrakesResetsAndKeepsThePosition) {
  World world{quick_serial(firmware())};
  ASSERT_TRUE(set_moving(world));
  world.submit(session::StopJob{});
  expect_braked(travel_mm(world));
  ASSERT_TRUE(world.run_until(is_ready, 20s));
  world.run_for(5s);
  expect_position_kept(world);
  EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
  EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
  EXPECT_THAT(told<session::CommandRefused>(world), IsEmpty());
  EXPECT_TRUE(world.session().ledger().empty());
  if (jogs()) return;
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped) << world.session().job()->reason;
  EXPECT_FALSE(world.session().job()->position_suspect);
}

TEST_P(Verbs, AbortStandsAtOnceAndSaysThatThePositionIsSuspect) {
  World world{quick_serial(firmware())};
  ASSERT_TRUE(set_moving(world));
  world.submit(session::AbortJob{});
  const double travelled = travel_mm(world);
  // What lies ahead on the wire, and nothing else: the axes stop dead.
  EXPECT_LE(travelled, row().speed_mm_per_s * (0.025 + 0.012));
  ASSERT_TRUE(world.run_until(is_ready, 20s));
  world.run_for(2s);
  const bool moved = row().speed_mm_per_s > 0;
  EXPECT_THAT(told<session::AlarmRaised>(world), SizeIs(moved ? 1 : 0));
  EXPECT_EQ(world.session().snapshot().state, moved ? MachineState::Alarm : MachineState::Idle);
  EXPECT_TRUE(world.session().ledger().empty());
  if (jogs()) return;
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped) << world.session().job()->reason;
  EXPECT_EQ(world.session().job()->position_suspect, moved);
}

class VerbsByHand : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, VerbsByHand, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

// Also those that no report has shown yet, those in the planner and those that wait for room in it.
TEST_P(VerbsByHand, NoJogOutlivesAHoldAStopOrACancel) {
  for (const session::Command& verb : {session::Command{session::HoldJob{}}, session::Command{session::StopJob{}},
                                       session::Command{session::CancelJog{}}}) {
    for (const Duration after : {Duration{5ms}, Duration{40ms}, Duration{150ms}, Duration{900ms}, Duration{2s}}) {
      SCOPED_TRACE(base::to_seconds(after));
      World world{quick_serial(GetParam())};
      ASSERT_TRUE(connect(world));
      world.run_for(1s);
      for (int jog = 0; jog < 120; ++jog) world.submit(session::Jog{"G21G91X3F4000"});
      world.run_for(after);
      const auto asked_at = world.controller().position_steps();
      world.submit(verb);
      world.run_for(10s);
      EXPECT_LT((world.controller().position_steps()[0] - asked_at[0]) / kStepsPerMm, 20);
      EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
      EXPECT_TRUE(world.session().ledger().empty());
      EXPECT_THAT(told<session::CommandRefused>(world), IsEmpty());
      const auto lines = lines_sent(world, streaming::Purpose::Operator);
      world.submit(session::SendLine{"G21G91G0X1"});
      world.run_for(2s);
      EXPECT_EQ(lines_sent(world, streaming::Purpose::Operator), lines + 1);
      EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
    }
  }
}

TEST_P(VerbsByHand, AStopEndsMotionThatIsNoJob) {
  for (const Duration after : {Duration{60ms}, Duration{1s}}) {
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(connect(world));
    world.run_for(1s);
    world.submit(session::SendLine{"G21G91G1X100F3000"});
    world.run_for(after);
    world.submit(session::StopJob{});
    world.run_for(1s);
    ASSERT_TRUE(world.run_until(is_ready, 20s));
    world.run_for(5s);
    EXPECT_LT(position_mm(world, 0), 60);
    EXPECT_EQ(world.session().snapshot().state, MachineState::Idle);
    EXPECT_THAT(told<session::AlarmRaised>(world), IsEmpty());
    EXPECT_THAT(told<session::CommandRefused>(world), IsEmpty());
  }
}

class Jogs : public testing::TestWithParam<Firmware> {};

INSTANTIATE_TEST_SUITE_P(Firmwares, Jogs, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(Jogs, BehindACancelledOneTheNextOneMoves) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.submit(session::Jog{"G21G91X50F3000"});
  world.run_for(500ms);
  world.submit(session::CancelJog{});
  world.run_for(2s);
  const double stopped_at = position_mm(world, 0);
  EXPECT_LT(stopped_at, 49);
  world.submit(session::Jog{"G21G91X5F3000"});
  world.run_for(2s);
  EXPECT_NEAR(position_mm(world, 0), stopped_at + 5, 0.005);
}

}  // namespace
}  // namespace kerf::scenarios
