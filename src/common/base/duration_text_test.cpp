#include "common/base/duration_text.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::base {
namespace {

using namespace std::chrono_literals;

TEST(DurationText, UnitsAreReadAsWritten) {
  EXPECT_EQ(parse_duration("200ms"), 200ms);
  EXPECT_EQ(parse_duration("1.5s"), 1500ms);
  EXPECT_EQ(parse_duration("0s"), 0s);
  EXPECT_EQ(parse_duration("2min"), 2min);
}

TEST(DurationText, AnythingElseIsNoDuration) {
  for (const auto* text : {"", "s", "1", "-1s", "+1s", "1 s", "1h", "1e3s", "infs", "ms"}) {
    EXPECT_EQ(parse_duration(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace kerf::base
