#include "common/base/ring.hpp"

#include <deque>
#include <memory>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::base {
namespace {

TEST(RingTest, RefusesWhatDoesNotFit) {
  Ring<int> ring{2};
  EXPECT_TRUE(ring.push_back(1));
  EXPECT_TRUE(ring.push_back(2));
  EXPECT_FALSE(ring.push_back(3));
  EXPECT_TRUE(ring.full());
  EXPECT_EQ(ring.front(), 1);
  EXPECT_EQ(ring.back(), 2);
}

TEST(RingTest, WithoutCapacityHoldsNothing) {
  Ring<int> ring{0};
  EXPECT_FALSE(ring.push_back(1));
  EXPECT_TRUE(ring.empty());
}

TEST(RingTest, ReleasesWhatItDrops) {
  Ring<std::shared_ptr<int>> ring{3};
  const auto watched = std::make_shared<int>(7);
  ASSERT_TRUE(ring.push_back(watched));
  ASSERT_TRUE(ring.push_back(watched));
  EXPECT_EQ(watched.use_count(), 3);
  ring.clear();
  EXPECT_EQ(watched.use_count(), 1);
}

RC_GTEST_PROP(RingProperty, BehavesAsABoundedDeque, (const std::vector<int>& choices)) {
  Ring<int> ring{5};
  std::deque<int> model;
  for (const int choice : choices) {
    if (choice % 3 == 0 && !model.empty()) {
      RC_ASSERT(ring.pop_front() == model.front());
      model.pop_front();
    } else if (choice % 7 == 0 && !model.empty()) {
      RC_ASSERT(ring.pop_back() == model.back());
      model.pop_back();
    } else {
      RC_ASSERT(ring.push_back(choice) == (model.size() < 5));
      if (model.size() < 5) model.push_back(choice);
    }
    RC_ASSERT(ring.size() == model.size());
    RC_ASSERT(ring.free() == 5 - model.size());
    for (std::size_t index = 0; index < model.size(); ++index) RC_ASSERT(ring[index] == model[index]);
  }
}

}  // namespace
}  // namespace kerf::base
