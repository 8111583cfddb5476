#include "common/gcode/modal_words.hpp"

#include <gtest/gtest.h>

#include "common/gcode/interpreter.hpp"
#include "common/gcode/print_number.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

std::string words_after(Firmware firmware, std::initializer_list<std::string_view> lines, ModalWordsStyle style = {}) {
  Interpreter interpreter(rules_for(firmware));
  std::vector<Action> actions;
  for (const std::string_view line : lines) EXPECT_TRUE(interpreter.interpret(line, actions)) << line;
  std::string out;
  append_modal_words(interpreter.state(), interpreter.offsets(), interpreter.rules(), style, out);
  return out;
}

TEST(ModalWords, AtPowerUp) {
  EXPECT_EQ(words_after(Firmware::Grbl, {}), "G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0");
  EXPECT_EQ(words_after(Firmware::Rabbit, {}), "G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0");
  EXPECT_EQ(words_after(Firmware::GrblHal, {}), "G0 G54 G17 G21 G90 G94 G40 G49 G98 G50 M5 M9 T0 F0 S0.");
}

TEST(ModalWords, AllAtOnce) {
  EXPECT_EQ(words_after(Firmware::Grbl, {"F100G0X1M8M3S5N7T3G55G91G20G18G94"}),
            "G0 G55 G18 G20 G91 G94 M3 M8 T3 F2540 S5");
  EXPECT_EQ(words_after(Firmware::GrblHal, {"G92X1", "G51X2Z3", "G99", "G43.1Z1", "M7", "M8", "M50P0", "M53P0", "M61Q4",
                                            "G59.2", "M4S12.6"}),
            "G0 G59.2 G92 G17 G21 G90 G94 G40 G43.1 G99 G51:XZ M4 M7 M8 M50 M53 T4 F0 S13.");
}

TEST(ModalWords, RabbitNamesProbesOneLessAndCutsSpeeds) {
  EXPECT_EQ(words_after(Firmware::Rabbit, {"G38.2Z-1F10", "S9.9"}), "G38.1 G54 G17 G21 G90 G94 M5 M9 T0 F10 S9");
  EXPECT_EQ(words_after(Firmware::Grbl, {"G38.2Z-1F10"}), "G38.2 G54 G17 G21 G90 G94 M5 M9 T0 F10 S0");
}

TEST(ModalWords, FeedRoundsAsTheFirmwarePrints) {
  EXPECT_EQ(words_after(Firmware::Grbl, {"F12.5"}), "G0 G54 G17 G21 G90 G94 M5 M9 T0 F13 S0");
  EXPECT_EQ(words_after(Firmware::Rabbit, {"F12.5"}), "G0 G54 G17 G21 G90 G94 M5 M9 T0 F12 S0");
  EXPECT_EQ(words_after(Firmware::GrblHal, {"F12.9"}), "G0 G54 G17 G21 G90 G94 G40 G49 G98 G50 M5 M9 T0 F12 S0.");
  EXPECT_EQ(words_after(Firmware::Grbl, {"F254"}, {.inches = true}), "G0 G54 G17 G21 G90 G94 M5 M9 T0 F10.0 S0");
}

}  // namespace
}  // namespace kerf::gcode

namespace kerf::gcode {
namespace {

std::string printed(NumberPrinter printer, float value, int decimals) {
  std::string out;
  append_number(printer, value, decimals, out);
  return out;
}

TEST(PrintNumber, EachFirmwareInItsWay) {
  EXPECT_EQ(printed(NumberPrinter::ScaleThenCut, 12.5F, 0), "13");
  EXPECT_EQ(printed(NumberPrinter::ScaleThenCut, -0.0125F, 3), "-0.013");
  EXPECT_EQ(printed(NumberPrinter::ScaleThenCut, 0.0F, 3), "0.000");
  EXPECT_EQ(printed(NumberPrinter::ScaleThenCut, 1.0005F, 3), "1.000");
  EXPECT_EQ(printed(NumberPrinter::Printf, 12.5F, 0), "12");
  EXPECT_EQ(printed(NumberPrinter::Printf, -1.5F, 3), "-1.500");
  EXPECT_EQ(printed(NumberPrinter::RoundThenSplit, 12.5F, 0), "13.");
  EXPECT_EQ(printed(NumberPrinter::RoundThenSplit, -3.05F, 3), "-3.050");
  EXPECT_EQ(printed(NumberPrinter::RoundThenSplit, 0.9999F, 3), "1.000");
}

}  // namespace
}  // namespace kerf::gcode
