#include "rehearsal/straight_run.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::rehearsal {
namespace {

using Place = StraightRun::Place;

double distance_to(const Place& from, const Place& to, const Place& point) {
  double way = 0;
  double length = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way += (to[axis] - from[axis]) * (point[axis] - from[axis]);
    length += (to[axis] - from[axis]) * (to[axis] - from[axis]);
  }
  const double share = length > 0 ? std::clamp(way / length, 0.0, 1.0) : 0.0;
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += std::pow(point[axis] - std::lerp(from[axis], to[axis], share), 2);
  }
  return std::sqrt(square);
}

TEST(StraightRun, TakesALongLineAndRefusesTheCorner) {
  StraightRun run(0.01);
  run.begin({0, 0, 0});
  for (int x = 1; x <= 1000; ++x) EXPECT_TRUE(run.take({static_cast<double>(x), (x % 2) * 0.004, 0}));
  EXPECT_FALSE(run.take({1000, 5, 0}));
  EXPECT_FALSE(run.take({900, 0, 0})) << "what was farthest must be reached";
}

RC_GTEST_PROP(StraightRun, EveryPointIsWithinTheTolerance, ()) {
  const double tolerance = *rc::gen::inRange(1, 100) / 100.0;
  StraightRun run(tolerance);
  std::vector<Place> taken{{0, 0, 0}};
  run.begin(taken.front());
  const auto wobble = [] { return *rc::gen::inRange(-100, 100) / 400.0; };
  Place at{};
  for (int step = 0; step < 60; ++step) {
    at = {at[0] + *rc::gen::inRange(-20, 100) / 100.0, at[1] + wobble(), at[2] + wobble()};
    if (!run.take(at)) continue;
    taken.push_back(at);
    for (const Place& point : taken) {
      RC_ASSERT(distance_to(taken.front(), taken.back(), point) <= tolerance * (1 + 1e-9) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace kerf::rehearsal
