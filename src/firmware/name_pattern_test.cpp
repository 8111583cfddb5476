#include "firmware/name_pattern.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

TEST(NamePattern, APartOfANameIsEnough) {
  EXPECT_TRUE(matches_pattern("mAx", "X/MaxRate"));
  EXPECT_TRUE(matches_pattern("b", "x/backlash"));
  EXPECT_FALSE(matches_pattern("maxx", "x/maxrate"));
}

TEST(NamePattern, AnchorsTieItDown) {
  EXPECT_TRUE(matches_pattern("^x/", "x/maxrate"));
  EXPECT_FALSE(matches_pattern("^max", "x/maxrate"));
  EXPECT_TRUE(matches_pattern("rate$", "x/maxrate"));
  EXPECT_FALSE(matches_pattern("max$", "x/maxrate"));
}

TEST(NamePattern, AStarIsAnyText) {
  EXPECT_TRUE(matches_pattern("x*rate", "x/maxrate"));
  EXPECT_TRUE(matches_pattern("*", ""));
  EXPECT_FALSE(matches_pattern("^s*e$", "x/maxrate"));
}

}  // namespace
}  // namespace kerf::firmware
