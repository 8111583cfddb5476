#include "common/gcode/line_reader.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

/// The lines that a text becomes; "!" stands for an overlong one.
std::vector<std::string> read_all(Firmware firmware, std::string_view text) {
  LineReader reader(rules_for(firmware).line);
  std::vector<std::string> lines;
  for (const char byte : text)
    if (const auto line = reader.push(byte)) lines.push_back(line->overlong ? "!" : std::string(line->text));
  return lines;
}

using Lines = std::vector<std::string>;

TEST(LineReader, GrblStripsWhileItReads) {
  EXPECT_EQ(read_all(Firmware::Grbl, "g1 x1\t(feed) f100 ; end\n"), Lines{"G1X1F100"});
  EXPECT_EQ(read_all(Firmware::Grbl, "/G0X1\n"), Lines{"G0X1"});
  EXPECT_EQ(read_all(Firmware::Grbl, "(;)G0X1\n"), Lines{"G0X1"});
  EXPECT_EQ(read_all(Firmware::Grbl, ")\n"), Lines{")"});
  EXPECT_EQ(read_all(Firmware::Grbl, "%\n"), Lines{"%"});
}

TEST(LineReader, RabbitKeepsTheLineAsItIs) {
  EXPECT_EQ(read_all(Firmware::Rabbit, " g1 x1 (feed)\n"), Lines{" g1 x1 (feed)"});
  EXPECT_EQ(read_all(Firmware::Rabbit, "G0X12\b\b3\n"), Lines{"G0X3"});
}

TEST(LineReader, GrblHalDropsLeadingBlanksAndControls) {
  EXPECT_EQ(read_all(Firmware::GrblHal, "  g1\t x1 ; c\n"), Lines{"g1 x1 ; c"});
  EXPECT_EQ(read_all(Firmware::GrblHal,
                     "G0X12\b\x7f"
                     "3\n"),
            Lines{"G0X3"});
}

TEST(LineReader, EveryEndIsAnsweredOnGrbl) {
  EXPECT_EQ(read_all(Firmware::Grbl, "G0\r\n\n\r"), (Lines{"G0", "", "", ""}));
}

TEST(LineReader, RabbitSwallowsTheLineFeedOfCarriageReturnLineFeed) {
  EXPECT_EQ(read_all(Firmware::Rabbit, "G0\r\nG1\n\r\n\n"), (Lines{"G0", "G1", "", ""}));
}

TEST(LineReader, GrblHalSwallowsEitherSecondHalf) {
  EXPECT_EQ(read_all(Firmware::GrblHal, "G0\r\nG1\n\r\n\n"), (Lines{"G0", "G1", "", ""}));
  EXPECT_EQ(read_all(Firmware::GrblHal, "\n\n"), (Lines{"", ""}));
}

TEST(LineReader, GrblHalAnswersTheSecondHalfAfterAFailedBlock) {
  LineReader reader(rules_for(Firmware::GrblHal).line);
  EXPECT_FALSE(reader.push('X'));
  EXPECT_TRUE(reader.push('\r'));
  reader.block_failed();
  EXPECT_TRUE(reader.push('\n'));
}

TEST(LineReader, LongestLines) {
  const std::string digits(400, '1');
  EXPECT_EQ(read_all(Firmware::Grbl, digits.substr(0, 79) + "\n"), Lines{digits.substr(0, 79)});
  EXPECT_EQ(read_all(Firmware::Grbl, digits.substr(0, 80) + "\nG0\n"), (Lines{"!", "G0"}));
  EXPECT_EQ(read_all(Firmware::Grbl, std::string(200, ' ') + "G0(" + digits + ")\n"), Lines{"G0"});

  EXPECT_EQ(read_all(Firmware::Rabbit, digits.substr(0, 254) + "\n"), Lines{digits.substr(0, 254)});
  // The byte that does not fit is gone, the rest is a line of its own.
  EXPECT_EQ(read_all(Firmware::Rabbit, digits.substr(0, 255) + "\nG0\n"), (Lines{"!", "G0"}));
  EXPECT_EQ(read_all(Firmware::Rabbit, digits.substr(0, 256) + "G0\n"), (Lines{"!", "G0"}));

  EXPECT_EQ(read_all(Firmware::GrblHal, digits.substr(0, 256) + "\n"), Lines{digits.substr(0, 256)});
  EXPECT_EQ(read_all(Firmware::GrblHal, digits.substr(0, 257) + "\nG0\n"), (Lines{"!", "G0"}));
}

TEST(LineReader, GrblHalKeepsRealtimeCharactersInDollarLinesAndComments) {
  LineReader reader(rules_for(Firmware::GrblHal).line);
  const auto keeps_after = [&reader](std::string_view text) {
    reader.clear();
    for (const char byte : text) reader.push(byte);
    return reader.keeps_realtime_characters();
  };
  EXPECT_TRUE(keeps_after("$I="));
  EXPECT_TRUE(keeps_after("G0 (a"));
  EXPECT_FALSE(keeps_after("G0 (a)"));
  EXPECT_FALSE(keeps_after("G0 ;("));
  EXPECT_FALSE(keeps_after("G0 (\b"));
  EXPECT_FALSE(keeps_after("G0$"));
}

TEST(LineReader, ClearForgetsTheHalfLine) {
  LineReader reader(rules_for(Firmware::Grbl).line);
  reader.push('G');
  EXPECT_TRUE(reader.is_mid_line());
  reader.clear();
  EXPECT_FALSE(reader.is_mid_line());
  EXPECT_EQ(reader.push('\n')->text, "");
}

RC_GTEST_PROP(LineReaderProperty, AWholeLineIsAsItsBytes, ()) {
  const auto letter = rc::gen::element('G', 'X', '1', '.', '-', 'x', ' ', '(', ')', ';', '/', '%', '\r', '\b', '$');
  const auto piece =
      rc::gen::pair(rc::gen::container<std::string>(letter), rc::gen::element<std::string>("G1X2", "", "G"));
  const auto pieces = *rc::gen::container<std::vector<std::pair<std::string, std::string>>>(piece);
  for (const Firmware firmware : {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal}) {
    LineReader by_bytes(rules_for(firmware).line);
    LineReader by_lines(rules_for(firmware).line);
    for (const auto& [bytes, line] : pieces) {
      for (const char byte : bytes) {
        static_cast<void>(by_bytes.push(byte));
        static_cast<void>(by_lines.push(byte));
      }
      for (const char byte : line) static_cast<void>(by_bytes.push(byte));
      const auto one = by_bytes.push('\n');
      const auto other = by_lines.push_line(line);
      RC_ASSERT(one.has_value() == other.has_value());
      if (one) RC_ASSERT(one->text == other->text && one->overlong == other->overlong);
      RC_ASSERT(by_bytes.is_mid_line() == by_lines.is_mid_line());
    }
  }
}

RC_GTEST_PROP(LineReaderProperty, NeverGivesMoreThanItsRules, (const std::string& bytes)) {
  for (const Firmware firmware : {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal}) {
    const LineRules rules = rules_for(firmware).line;
    LineReader reader(rules);
    for (const char byte : bytes)
      if (const auto line = reader.push(byte)) RC_ASSERT(line->text.size() <= rules.length_max);
  }
}

}  // namespace
}  // namespace kerf::gcode
