#include "io/link_keeper.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::io {
namespace {

using namespace std::chrono_literals;

TEST(LinkKeeper, WaitsLongerEachTimeUpToALimit) {
  EXPECT_EQ(wait_before(0, true), Duration{250ms});
  EXPECT_EQ(wait_before(1, true), Duration{500ms});
  EXPECT_EQ(wait_before(5, true), Duration{8s});
  EXPECT_EQ(wait_before(6, true), Duration{10s});
  EXPECT_EQ(wait_before(1'000'000, true), Duration{10s});
  EXPECT_EQ(wait_before(1'000'000, false), Duration{1s});
}

/// What is heard of a link, in letters.
class Keeping : public ::testing::Test {
 protected:
  LinkCallbacks listen() {
    return {.opened = [this] { heard_ += 'o'; },
            .received = [](std::string_view) {},
            .lost =
                [this](const TransportError&) {
                  heard_ += 'l';
                  loop_.stop();
                }};
  }

  EventLoop loop_;
  std::string heard_;
};

TEST_F(Keeping, WhatWasNeverThereIsNotWaitedFor) {
  LinkKeeper keeper(loop_, PtyAddress{"/nowhere/at-all"}, Persistence::Again, listen());
  loop_.run();
  EXPECT_EQ(heard_, "l");
  EXPECT_FALSE(keeper.is_trying());
}

}  // namespace
}  // namespace kerf::io
