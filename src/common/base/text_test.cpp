#include "common/base/text.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::base {
namespace {

using testing::ElementsAre;

TEST(TextTest, TrimsBlanksAtBothEndsOnly) {
  EXPECT_EQ(trim(" \tG1 X1\r\n"), "G1 X1");
  EXPECT_EQ(trim("  "), "");
  EXPECT_EQ(trim(""), "");
}

TEST(TextTest, SplitsIntoAtMostSoManyParts) {
  EXPECT_THAT(split_at_most("9|title|text|with|bars", '|', 3), ElementsAre("9", "title", "text|with|bars"));
  EXPECT_THAT(split_at_most("one", '|', 3), ElementsAre("one"));
  EXPECT_THAT(split_at_most("a|b", '|', 1), ElementsAre("a|b"));
}

TEST(TextTest, SplitKeepsEmptyParts) {
  EXPECT_THAT(split("0.000,,1.5,", ','), ElementsAre("0.000", "", "1.5", ""));
  EXPECT_THAT(split("", ','), ElementsAre(""));
}

TEST(TextTest, ComparesIgnoringCase) {
  EXPECT_TRUE(iequals("GrblHAL", "grblhal"));
  EXPECT_FALSE(iequals("Grbl", "grblhal"));
  EXPECT_TRUE(starts_with_ignoring_case("TCP://host", "tcp:"));
  EXPECT_FALSE(starts_with_ignoring_case("tc", "tcp:"));
}

TEST(TextTest, ReadsWholeIntegersOnly) {
  EXPECT_EQ(parse_int("-12"), -12);
  EXPECT_EQ(parse_int("1F", 16), 31);
  EXPECT_EQ(parse_int<std::uint8_t>("255"), 255);
  EXPECT_EQ(parse_int<std::uint8_t>("256"), std::nullopt);
  EXPECT_EQ(parse_int<std::uint8_t>("-1"), std::nullopt);
  for (const char* text : {"", "-", "+1", " 1", "1 ", "1.0", "99999999999"}) {
    EXPECT_EQ(parse_int(text), std::nullopt) << text;
  }
}

TEST(TextTest, ReadsWholeDecimalsOnly) {
  EXPECT_EQ(parse_decimal("-12.500"), -12.5);
  EXPECT_EQ(parse_decimal(".5"), 0.5);
  EXPECT_EQ(parse_decimal("3."), 3.0);
  EXPECT_EQ(parse_decimal("7"), 7.0);
  for (const char* text : {"", "-", ".", "-.", "+1", "1e5", "inf", "-inf", "nan", " 1", "1 ", "1.2.3", "--1", "0x10"}) {
    EXPECT_EQ(parse_decimal(text), std::nullopt) << text;
  }
}

TEST(TextTest, PrintsFixedDecimals) {
  EXPECT_EQ(to_fixed(0, 3), "0.000");
  EXPECT_EQ(to_fixed(1.5, 3), "1.500");
  EXPECT_EQ(to_fixed(-0.25, 3), "-0.250");
  EXPECT_EQ(to_fixed(0.05, 1), "0.1");
  EXPECT_EQ(to_fixed(99.9996, 3), "100.000");
  EXPECT_EQ(to_fixed(12.5, 0), "13");
  EXPECT_EQ(to_fixed(0.4, 0), "0");
  EXPECT_EQ(to_fixed(-12345.6789, 4), "-12345.6789");
}

TEST(TextTest, PrintsSignsAndTiesAsGrblDoes) {
  EXPECT_EQ(to_fixed(-0.0001, 3), "-0.000");
  EXPECT_EQ(to_fixed(-0.0, 3), "0.000");
  EXPECT_EQ(to_fixed(0.0625, 3), "0.063");
  EXPECT_EQ(to_fixed(-0.0625, 3), "-0.063");
}

TEST(TextTest, PrintsWhatIsTooLargeToRound) {
  EXPECT_EQ(to_fixed(1e17, 3), "100000000000000000.000");
  EXPECT_EQ(to_fixed(-std::numeric_limits<double>::infinity(), 3), "-inf");
}

RC_GTEST_PROP(TextProperty, PrintedDecimalsReadBackWithinHalfADigit, (std::int64_t numerator)) {
  const double value = static_cast<double>(numerator % 10'000'000'000) / 1e6;
  const std::string text = to_fixed(value, 3);
  const auto back = parse_decimal(text);
  RC_ASSERT(back.has_value());
  RC_ASSERT(std::abs(*back - value) <= 0.5e-3 + 1e-9);
  RC_ASSERT(to_fixed(*back, 3) == text || *back == 0.0);
}

TEST(TextTest, ShowsBytes) {
  EXPECT_EQ(escape("G1\tX1\r\n"), "G1\\tX1\\r\\n");
  EXPECT_EQ(escape("\x18\x85?"), "\\x18\\x85?");
  EXPECT_EQ(escape("a\\b"), "a\\\\b");
}

TEST(TextTest, RefusesUnknownEscapes) {
  for (const char* text : {"\\", "\\q", "\\x", "\\x1", "\\xZZ", "\\x-1"})
    EXPECT_EQ(unescape(text), std::nullopt) << text;
}

RC_GTEST_PROP(TextProperty, ShownBytesReadBack, (const std::string& bytes)) {
  RC_ASSERT(unescape(escape(bytes)) == bytes);
}

}  // namespace
}  // namespace kerf::base
