#include "common/protocol/encode.hpp"

#include <gtest/gtest.h>

#include "common/protocol/decode.hpp"

namespace kerf::protocol {
namespace {

using vocabulary::dialect_of;

TEST(Encode, StylesFollowTheDialect) {
  const PrintStyle grbl = style_of(dialect_of(Firmware::Grbl));
  const PrintStyle grblhal = style_of(dialect_of(Firmware::GrblHal));
  EXPECT_EQ(speed_word(1000, grbl), "S1000");
  EXPECT_EQ(speed_word(1000, grblhal), "S1000.");
  EXPECT_EQ(style_of(dialect_of(Firmware::Grbl), true).position_decimals, 4);
  EXPECT_EQ(style_of(dialect_of(Firmware::Grbl), true).feed_decimals, 1);
  EXPECT_EQ(style_of(dialect_of(Firmware::GrblHal), true).feed_decimals, 0);
}

TEST(Encode, Positions) {
  const std::vector<double> values{0, -1.5, 25.4};
  EXPECT_EQ(print_positions(values, {}), "0.000,-1.500,25.400");
  EXPECT_EQ(print_positions(values, {.position_decimals = 4}), "0.0000,-1.5000,25.4000");
  EXPECT_EQ(print_positions({}, {}), "");
}

TEST(Encode, LinesThatDecodeAcceptsInTwoFormsArePrintedInTheFirmwaresOwn) {
  EXPECT_EQ(encode(decode("[ALARM:1|title|text]")), "[ALARMCODE:1|title|text]");
  EXPECT_EQ(encode(decode("[ERROR:1|title|text]")), "[ERRORCODE:1|title|text]");
  EXPECT_EQ(encode(decode("ok ")), "ok");
}

TEST(Encode, FieldsThatAFirmwareLacksArePrintedBehindItsOwn) {
  StatusReport report{.state = MachineState::Idle, .machine_position = std::vector<double>{1}};
  report.tool = 3;
  report.accessories = "S";
  report.unknown.push_back({"SD", "3"});
  EXPECT_EQ(encode(report, style_of(dialect_of(Firmware::Grbl))), "<Idle|MPos:1.000|A:S|T:3|SD:3>");
}

TEST(Encode, ErrorsWithAndWithoutNumber) {
  EXPECT_EQ(encode(ErrorAnswer{20, {}}), "error:20");
  EXPECT_EQ(encode(ErrorAnswer{ErrorAnswer::kUnnumbered, "Bad number format"}), "error: Bad number format");
  EXPECT_EQ(encode(FileError{20, 7}), "error:20 in SD file at line 7");
}

TEST(Encode, AGapInTheOptionsEndsThem) {
  EXPECT_EQ(encode(BuildOptions{"V", 15, std::nullopt, 3, 0}), "[OPT:V,15]");
}

}  // namespace
}  // namespace kerf::protocol
