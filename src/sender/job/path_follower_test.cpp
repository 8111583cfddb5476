#include "sender/job/path_follower.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/gcode/rules.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A Grbl with 250 steps/mm and 3 m/min, asked ten times a second.
class Follower : public testing::Test {
 protected:
  Follower() {
    PathRules rules{.motion = motion::rules_of(vocabulary::Firmware::Grbl), .planner_blocks = 15};
    rules.settings.axes = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rules.settings.steps_per_mm.at(axis) = 250;
      rules.settings.max_rate_mm_per_min.at(axis) = 3000;
    }
    forecast_.begin(gcode::Interpreter{gcode::rules_for(vocabulary::Firmware::Grbl)}, {}, rules);
    follower_.begin(now_, {}, rules, {.tolerance_mm = tolerance_mm(rules, false), .least_rpm = 0, .most_rpm = 1000});
  }
  void send(std::initializer_list<std::string_view> lines) {
    for (const std::string_view line : lines) forecast_.on_sent(++line_, line);
  }
  std::optional<PathDeparture> report(float x, float y, float z = 0, Duration after = 100ms) {
    now_ += after;
    report_.arrived = now_;
    report_.asked = now_ - 10ms;
    report_.machine_mm = {x, y, z};
    report_.axes = 3;
    report_.runs = true;
    return follower_.on_report(forecast_, report_);
  }
  [[nodiscard]] ExecutingLines executing() const { return follower_.executing(forecast_); }

  Instant now_{};
  PathForecast forecast_;
  PathFollower follower_;
  PathReport report_;
  std::uint32_t line_ = 0;
};

TEST_F(Follower, FindsTheLinesThatAreExecuting) {
  send({"G1X10F1200", "G4P0.1", "Y10", "X0", "Y0"});
  EXPECT_FALSE(report(0, 0));
  EXPECT_EQ(executing(), (ExecutingLines{.from = 1, .to = 1, .known_by = ExecutingKnownBy::Position}));
  EXPECT_FALSE(report(2, 0));
  EXPECT_FALSE(report(10, 0, 0, 400ms));
  EXPECT_EQ(executing().from, 1U);
  EXPECT_EQ(executing().to, 3U);
  EXPECT_FALSE(report(10, 1));
  EXPECT_FALSE(report(10, 1));
  EXPECT_EQ(executing(), (ExecutingLines{.from = 3, .to = 3, .known_by = ExecutingKnownBy::Position}));
}

TEST_F(Follower, NamesTheLineThatTheMachineLeft) {
  send({"G1X10F1200", "Y10"});
  EXPECT_FALSE(report(5, 0, 0, 300ms));
  EXPECT_FALSE(report(10, 0, 0, 300ms));
  const auto departure = report(10.2F, 0);
  ASSERT_TRUE(departure);
  EXPECT_NEAR(departure->distance_mm, 0.2, 0.001);
  EXPECT_THAT(describe(*departure), HasSubstr("0.200 mm off the path at line "));
  EXPECT_THAT(describe(*departure), HasSubstr("X10.200 Y0.000 Z0.000"));
}

TEST_F(Follower, DoesNotTakeALaterPlaceForThePresentOne) {
  // There and back: the third row covers the first.
  send({"G1X10F600", "Y1", "X0", "Y0", "X10"});
  EXPECT_FALSE(report(5, 0, 0, 300ms));
  EXPECT_FALSE(report(5, 1)) << "nobody gets there in a tenth of a second: the next report decides";
  const auto departure = report(4.9F, 1);
  ASSERT_TRUE(departure);
  EXPECT_EQ(departure->kind, DepartureKind::Time);
}

TEST_F(Follower, LearnsThatASimulatorsClockIsFaster) {
  send({"G1X10F600", "Y90", "X0", "Y0", "X90"});
  EXPECT_FALSE(report(5, 0, 0, 300ms));
  EXPECT_FALSE(report(10, 40));
  EXPECT_FALSE(report(5, 90));
  EXPECT_FALSE(report(50, 0));
}

TEST_F(Follower, LearnsItFromTheVeryFirstReports) {
  send({"G1X100F1200", "Y100", "X0"});
  EXPECT_FALSE(report(100, 40, 0, 30ms));
  EXPECT_FALSE(report(90, 100, 0, 30ms));
}

TEST_F(Follower, LearnsItFromAFeedThatIsFarBelowTheFastest) {
  send({"G1X0.1F300", "X0", "X0.1", "X0", "X200"});
  EXPECT_FALSE(report(0, 0));
  // 0.5 mm in our tenth of a second, and the machine does four times as much.
  for (int i = 1; i < 40; ++i) EXPECT_FALSE(report(2.0F * static_cast<float>(i), 0)) << i;
}

TEST_F(Follower, TakesALostLineForNoSimulator) {
  send({"G1X5F300", "G1X-5", "G1X40"});
  EXPECT_FALSE(report(4.9F, 0, 0, 1s));
  // The second line never came.
  EXPECT_FALSE(report(5.3F, 0));
  const auto departure = report(5.8F, 0);
  ASSERT_TRUE(departure);
  EXPECT_EQ(departure->kind, DepartureKind::Time);
}

TEST_F(Follower, NeverGoesBack) {
  send({"G1X10F1200"});
  EXPECT_FALSE(report(5, 0, 0, 300ms));
  EXPECT_TRUE(report(3, 0));
}

TEST_F(Follower, AsksTwiceWhatNoMachineCanDo) {
  send({"G1X100F1200"});
  EXPECT_FALSE(report(2, 0));
  EXPECT_FALSE(report(2, 80)) << "a damaged report";
  EXPECT_FALSE(report(4, 0));
  EXPECT_FALSE(report(4, 80));
  EXPECT_TRUE(report(4, 80.5F));
}

TEST_F(Follower, BelievesThatALineIsOverOnlyWhenTheNextReportFitsToo) {
  send({"G1X10F3000", "Y5", "X5"});
  EXPECT_FALSE(report(8, 0, 0, 400ms));
  EXPECT_FALSE(report(10, 4, 0, 400ms)) << "changed on its way: the machine is at X9, and it could be at Y4 by now";
  EXPECT_EQ(executing().from, 1U);
  EXPECT_TRUE(report(9.1F, 0));
  EXPECT_EQ(executing().from, 1U);
}

TEST_F(Follower, SaysNothingBehindAnOpenEnd) {
  send({"G1X10F1200", "#1=3"});
  EXPECT_FALSE(report(5, 0, 0, 300ms));
  EXPECT_FALSE(report(10, 4, 0, 1s));
  EXPECT_EQ(executing().known_by, ExecutingKnownBy::PlannerBlocks);
  EXPECT_EQ(executing().from, 1U);
  EXPECT_EQ(executing().to, 2U);
}

TEST_F(Follower, StillWatchesWhatLiesBeforeAnOpenEnd) {
  send({"G1X100F1200", "#1=3"});
  EXPECT_FALSE(report(2, 0));
  EXPECT_TRUE(report(4, 0.5F));
}

TEST_F(Follower, HoldsAgainstAFeedThatNobodyAskedFor) {
  send({"G1X100F600"});
  EXPECT_FALSE(report(0, 0, 0, 3s));
  report_.feed_mm_per_min = 900;
  EXPECT_FALSE(report(1, 0));
  EXPECT_FALSE(report(2.5F, 0));
  const auto departure = report(4, 0);
  ASSERT_TRUE(departure);
  EXPECT_EQ(departure->kind, DepartureKind::Feed);
  EXPECT_THAT(describe(*departure), HasSubstr("900 mm/min where line 1 allows 600 mm/min"));
}

TEST_F(Follower, KnowsThatSpeedsAreToldAheadOfPositions) {
  send({"G1X10F60", "G1X20F1500"});
  report_.feed_mm_per_min = 60;
  EXPECT_FALSE(report(9.89F, 0, 0, 10s));
  report_.feed_mm_per_min = 1500;
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(report(9.95F + 0.01F * static_cast<float>(i), 0, 0, 20ms));
}

TEST_F(Follower, KnowsOverrides) {
  send({"G1X100F600"});
  EXPECT_FALSE(report(0, 0, 0, 3s));
  report_.feed_mm_per_min = 900;
  report_.feed_override = 150;
  for (int i = 1; i < 40; ++i) EXPECT_FALSE(report(static_cast<float>(i) * 1.5F, 0));
}

TEST_F(Follower, HoldsAgainstAnotherSpindleSpeed) {
  send({"M3S5000", "G1X100F600"});
  report_.spindle_rpm = 1000;
  EXPECT_FALSE(report(0, 0, 0, 3s)) << "as fast as it can";
  for (int i = 1; i < 5; ++i) EXPECT_FALSE(report(static_cast<float>(i), 0));
  report_.spindle_rpm = 0;
  EXPECT_FALSE(report(5, 0));
  EXPECT_FALSE(report(6, 0));
  const auto departure = report(7, 0);
  ASSERT_TRUE(departure);
  EXPECT_EQ(departure->kind, DepartureKind::Spindle);
}

TEST_F(Follower, DoesNotChooseBetweenOldAndNewWorkOffsets) {
  send({"G1Z5F1500", "G1Z-5", "G43.1Z0.6", "G49", "G1Z5"});
  report_.work_mm = AxisValues{0, 0, 5};
  EXPECT_FALSE(report(0, 0, 5, 1s));
  // Told with the old offset, counted with the new one: both lie on the way.
  for (int i = 1; i < 18; ++i) {
    const float z = 5 - 0.5F * static_cast<float>(i);
    report_.work_mm = AxisValues{0, 0, z - 0.6F};
    EXPECT_FALSE(report(0, 0, z - 0.6F)) << i;
  }
  report_.work_mm = AxisValues{0, 0, -5.6F};
  EXPECT_FALSE(report(0, 0, -5.6F, 300ms));
}

TEST_F(Follower, WaitsForTheReportOfANewWorkOffset) {
  send({"G1X10F1200", "G92X0", "G1X5"});
  EXPECT_FALSE(report(9, 0, 0, 500ms));
  // The machine is at 10, and the controller already counts from there.
  report_.work_mm = AxisValues{-1, 0, 0};
  EXPECT_FALSE(report(-1, 0));
  report_.work_mm = AxisValues{1, 0, 0};
  EXPECT_FALSE(report(11, 0));
  report_.work_mm = AxisValues{1, 0.5F, 0};
  EXPECT_TRUE(report(11, 0.5F));
}

/// grblHAL loses steps when it goes on.
TEST_F(Follower, KnowsThatStepsAreLostWhenTheMachineGoesOn) {
  PathRules rules = forecast_.rules();
  rules.motion = motion::rules_of(vocabulary::Firmware::GrblHal);
  forecast_.begin(gcode::Interpreter{gcode::rules_for(vocabulary::Firmware::GrblHal)}, {}, rules);
  follower_.begin(now_, {}, rules, {.tolerance_mm = tolerance_mm(rules, false)});
  send({"G1X900F1200"});
  for (int i = 1; i <= 30; ++i) {
    follower_.on_restart();
    const auto at = static_cast<float>(i);
    EXPECT_FALSE(report(at, at * -0.004F)) << i;
    EXPECT_FALSE(report(at + 0.5F, at * -0.004F)) << i;
  }
  EXPECT_TRUE(report(33, -0.17F)) << "not by a restart";
}

TEST_F(Follower, DoesNotKeepAPathThatCoversItselfAgainAndAgain) {
  constexpr int kRounds = 100'000;
  for (int round = 0; round < kRounds; ++round) {
    send({"G1X1F60000", "X0"});
    forecast_.on_acknowledged();
    forecast_.on_acknowledged();
    if (round % 100 == 0) {
      EXPECT_FALSE(report(0, 0, 0, 60s));
    }
  }
  EXPECT_LT(forecast_.pieces().size(), 60'000U);
}

TEST(Tolerance, IsAboutAStep) {
  PathRules rules;
  EXPECT_DOUBLE_EQ(tolerance_mm(rules, false), 0.02) << "steps unknown";
  for (std::size_t axis = 0; axis < 3; ++axis) rules.settings.steps_per_mm.at(axis) = 250;
  EXPECT_NEAR(tolerance_mm(rules, false), 0.0114, 0.001);
  EXPECT_LT(tolerance_mm(rules, true), 0.02);
}

}  // namespace
}  // namespace kerf::job
