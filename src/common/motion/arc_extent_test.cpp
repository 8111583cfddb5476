#include "common/motion/arc_extent.hpp"

#include <gtest/gtest.h>

namespace kerf::motion {
namespace {

Arc quarter(bool clockwise) {
  return {.start_mm = {10, 0, 0}, .target_mm = {0, 10, 3}, .center_offset_mm = {-10, 0}, .clockwise = clockwise};
}

float farthest(const std::vector<AxisValues>& points, std::size_t axis, float sign) {
  float most = -1000;
  for (const AxisValues& point : points) most = std::max(most, sign * point[axis]);
  return most;
}

TEST(ArcExtent, AQuarterGoesNowhereBeyondItsEnds) {
  const auto extremes = extremes_of(quarter(false));
  for (const AxisValues& point : extremes) {
    EXPECT_NEAR(point[0], 10, 1e-4);
    EXPECT_NEAR(point[1], 0, 1e-4);
  }
}

TEST(ArcExtent, TheOtherWayRoundGoesAcross) {
  const auto extremes = extremes_of(quarter(true));
  EXPECT_NEAR(farthest(extremes, 0, -1), 10, 1e-4);
  EXPECT_NEAR(farthest(extremes, 1, -1), 10, 1e-4);
  EXPECT_NEAR(farthest(extremes, 0, 1), 10, 1e-4);
}

TEST(ArcExtent, AFullCircleReachesAllSides) {
  const Arc circle{.start_mm = {10, 0, 0}, .target_mm = {10, 0, 0}, .center_offset_mm = {-10, 0}};
  const auto extremes = extremes_of(circle);
  for (const std::size_t axis : {0U, 1U}) {
    EXPECT_NEAR(farthest(extremes, axis, 1), 10, 1e-4);
    EXPECT_NEAR(farthest(extremes, axis, -1), 10, 1e-4);
  }
}

}  // namespace
}  // namespace kerf::motion
