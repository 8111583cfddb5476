#include "common/gcode/numbers.hpp"

#include <limits>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

/// Value and number of characters taken.
std::optional<std::pair<float, int>> read(Firmware firmware, const std::string& text) {
  std::uint8_t at = 0;
  float value = 0.0F;
  if (!read_float(rules_for(firmware), text.c_str(), at, value)) return std::nullopt;
  return std::pair{value, int{at}};
}

TEST(ReadFloat, TakesSignDigitsAndOnePoint) {
  for (const Firmware firmware : {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal}) {
    EXPECT_EQ(read(firmware, "12.5X"), (std::pair{12.5F, 4}));
    EXPECT_EQ(read(firmware, "-.5"), (std::pair{-0.5F, 3}));
    EXPECT_EQ(read(firmware, "+3."), (std::pair{3.0F, 3}));
    EXPECT_EQ(read(firmware, "1.2.3"), (std::pair{1.2F, 3}));
    EXPECT_EQ(read(firmware, "1E3"), (std::pair{1.0F, 1}));
    EXPECT_FALSE(read(firmware, "--1"));
    EXPECT_FALSE(read(firmware, "."));
    EXPECT_FALSE(read(firmware, ""));
  }
}

TEST(ReadFloat, OnlyTheFirstDigitsCount) {
  // Grbl counts leading zeros among its eight digits, grblHAL counts nine significant ones.
  EXPECT_EQ(read(Firmware::Grbl, "0000000012")->first, 0.0F);
  EXPECT_EQ(read(Firmware::GrblHal, "0000000012")->first, 12.0F);
  EXPECT_EQ(read(Firmware::Grbl, "123456789")->first, 123456784.0F);
  EXPECT_EQ(read(Firmware::GrblHal, "0.000000001")->first, 1e-9F);
  EXPECT_EQ(read(Firmware::Grbl, "0.000000001")->first, 0.0F);
}

TEST(ReadFloat, StepsOfScalingShowInTheLastBit) {
  // 3.337 in three float steps is not the nearest float; with double literals it is.
  const float nearest = 3.337F;
  EXPECT_EQ(read(Firmware::Rabbit, "3.337")->first, nearest);
  float by_steps = 3337.0F;
  by_steps *= 0.01F;
  by_steps *= 0.1F;
  EXPECT_EQ(read(Firmware::Grbl, "3.337")->first, by_steps);
}

TEST(ReadWhole, RefusesWhatIsNotAWholeNumber) {
  const auto read_o = [](const char* text) {
    std::uint8_t at = 0;
    std::uint32_t value = 0;
    return std::pair{read_whole(text, at, value), value};
  };
  using vocabulary::ErrorCode;
  EXPECT_EQ(read_o("100"), (std::pair{ErrorCode::Ok, 100U}));
  EXPECT_EQ(read_o("+7."), (std::pair{ErrorCode::Ok, 7U}));
  EXPECT_EQ(read_o("-1").first, ErrorCode::NegativeValue);
  EXPECT_EQ(read_o("1.5").first, ErrorCode::CommandValueNotInteger);
  EXPECT_EQ(read_o("X").first, ErrorCode::BadNumberFormat);
}

TEST(Conversions, OverflowAsRecorded) {
  EXPECT_EQ(to_uint8(257.0), 1);
  EXPECT_EQ(to_uint8(-1.0), 255);
  EXPECT_EQ(to_int32(1e10), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(to_uint16(1e10), 0);
  EXPECT_EQ(to_uint32(-1.0), 4294967295U);
  EXPECT_EQ(to_uint64(-1.0), 18446744073709551615ULL);
  EXPECT_EQ(to_uint64(1e30), 0U);
}

TEST(IsWhole, TakesAThousandth) {
  EXPECT_TRUE(is_whole(2.0005F));
  EXPECT_FALSE(is_whole(2.01F));
  EXPECT_FALSE(is_whole(std::numeric_limits<float>::quiet_NaN()));
}

}  // namespace
}  // namespace kerf::gcode
