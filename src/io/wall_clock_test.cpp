#include "io/wall_clock.hpp"

#include <gtest/gtest.h>

namespace kerf::io {
namespace {

TEST(WallClock, IsReadAsItIsWritten) {
  const std::string text = "2026-11-22T13:05:01.250Z";
  const auto moment = parse_wall_clock(text);
  ASSERT_TRUE(moment);
  EXPECT_EQ(to_string(*moment), text);
  EXPECT_EQ(to_string(*parse_wall_clock("2024-02-29T00:00:00")), "2024-02-29T00:00:00.000Z");
  const auto now = wall_clock_now();
  EXPECT_EQ(parse_wall_clock(to_string(now)), now);
}

TEST(WallClock, WhatIsNoMomentIsNone) {
  for (const char* text : {"", "13:05", "2026-13-01T00:00:00", "2026-02-30T00:00:00", "2026-01-01T24:00:00Z",
                           "2026-01-01T00:00:00x", "2026/01/01T00:00:00"}) {
    EXPECT_FALSE(parse_wall_clock(text)) << text;
  }
}

}  // namespace
}  // namespace kerf::io
