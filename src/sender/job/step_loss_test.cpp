#include "sender/job/step_loss.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace kerf::job {
namespace {

constexpr float kStep = 0.0125F;
constexpr double kRounding = 0.0045;

PathRules rules_of(vocabulary::Firmware firmware) {
  PathRules rules{.motion = motion::rules_of(firmware)};
  rules.settings.axes = 3;
  for (std::size_t axis = 0; axis < 3; ++axis) rules.settings.steps_per_mm.at(axis) = 1 / kStep;
  return rules;
}

PathPiece along_x() {
  return {.start_mm = {0, 5, 0}, .end_mm = {100, 5, 0}};
}

PathPiece along_y() {
  return {.start_mm = {5, 0, 0}, .end_mm = {5, 100, 0}};
}

TEST(StepLoss, IsNoneWhereTheFirmwareLosesNone) {
  StepLoss loss;
  loss.round_by(kRounding);
  loss.begin(rules_of(vocabulary::Firmware::Grbl));
  loss.on_restart();
  EXPECT_EQ(loss.reach_mm(), 0);
}

TEST(StepLoss, IsLearntFromReportsBesideThePath) {
  StepLoss loss;
  loss.round_by(kRounding);
  loss.begin(rules_of(vocabulary::Firmware::GrblHal));
  // Each restart costs Y a step, and X none.
  for (int restart = 1; restart <= 20; ++restart) {
    loss.on_restart();
    const float lost = kStep * static_cast<float>(restart);
    loss.narrow(std::array{along_x()}, {50, 5 - lost, 0});
    loss.narrow(std::array{along_y()}, {5, 50, 0});
    EXPECT_NEAR(loss.middle_mm()[1], -lost, kStep);
    EXPECT_NEAR(loss.middle_mm()[0], 0, kStep);
    EXPECT_LT(loss.reach_mm(), 2 * kStep);
  }
}

TEST(StepLoss, GrowsByAStepOfEachAxisAndNoFurther) {
  StepLoss loss;
  loss.round_by(kRounding);
  loss.begin(rules_of(vocabulary::Firmware::GrblHal));
  loss.on_restart();
  // A place that no restart explains.
  loss.narrow(std::array{along_x()}, {50, 5.05F, 0});
  EXPECT_FLOAT_EQ(loss.middle_mm()[1], 0);
  EXPECT_NEAR(loss.reach_mm(), kStep * 1.732, 1e-4);
}

TEST(StepLoss, KeepsWhatEitherOfTwoPiecesAllows) {
  StepLoss loss;
  loss.round_by(kRounding);
  loss.begin(rules_of(vocabulary::Firmware::GrblHal));
  loss.on_restart();
  loss.narrow(std::array{along_x(), along_y()}, {5, 5, 0});
  EXPECT_NEAR(loss.reach_mm(), std::hypot(kStep, kStep, kStep / 2 + kRounding), 1e-4);
}

TEST(StepLoss, StaysPossibleInTheNextJob) {
  StepLoss loss;
  loss.round_by(kRounding);
  loss.begin(rules_of(vocabulary::Firmware::GrblHal));
  for (int i = 0; i < 10; ++i) {
    loss.on_restart();
    loss.narrow(std::array{along_x()}, {50, 5 - kStep * static_cast<float>(i + 1), 0});
  }
  loss.begin(rules_of(vocabulary::Firmware::GrblHal));
  EXPECT_NEAR(loss.middle_mm()[1], -5 * kStep, kStep);
  EXPECT_GT(loss.reach_mm(), 4 * kStep);
  loss.narrow(std::array{along_x()}, {50, 5, 0});
  EXPECT_NEAR(loss.middle_mm()[1], 0, kStep);
}

}  // namespace
}  // namespace kerf::job
