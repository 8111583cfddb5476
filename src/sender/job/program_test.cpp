#include "sender/job/program.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/vocabulary/dialect.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::job {
namespace {

std::shared_ptr<const Program> load(std::string text) {
  auto program = Program::load("part.nc", std::move(text));
  EXPECT_TRUE(program);
  return program ? *program : nullptr;
}

ProgramFault fault_of(std::string text) {
  const auto program = Program::load("part.nc", std::move(text));
  EXPECT_FALSE(program);
  return program ? ProgramFault{} : program.error();
}

std::string wire(std::string_view line, WireForm form) {
  std::string out;
  append_wire_form(out, line, form);
  return out;
}

TEST(Program, CountsLinesWithAnyLineEnd) {
  const auto program = load("G0X1\nG0X2\r\nG0X3\rG0X4");
  EXPECT_EQ(program->line_count(), 4U);
  EXPECT_EQ(program->line(1)->text, "G0X1");
  EXPECT_EQ(program->line(2)->text, "G0X2");
  EXPECT_EQ(program->line(3)->text, "G0X3");
  EXPECT_EQ(program->line(4)->text, "G0X4");
  EXPECT_FALSE(program->line(5));
  EXPECT_FALSE(program->line(0));
}

TEST(Program, FindsLinesThroughTheSparseIndex) {
  std::string text;
  for (int number = 1; number <= 2000; ++number) text += "G1X" + std::to_string(number) + "\n";
  const auto program = load(text);
  EXPECT_EQ(program->line_count(), 2000U);
  for (const std::uint32_t number : {1U, 255U, 256U, 257U, 512U, 513U, 1999U, 2000U}) {
    EXPECT_EQ(program->line(number)->text, "G1X" + std::to_string(number));
  }
}

TEST(Program, TheIndexOfALongFileStaysSmall) {
  std::string text;
  constexpr std::uint32_t kLines = Program::kMostIndexEntries * Program::kFirstIndexStep * 2 + 100;
  for (std::uint32_t number = 1; number <= kLines; ++number) text += number % 2 == 0 ? "X2\n" : "Y\n";
  const auto program = load(text);
  EXPECT_EQ(program->line_count(), kLines);
  for (const std::uint32_t number : {1U, 256U, kLines / 2, kLines / 2 + 1, kLines - 1, kLines}) {
    EXPECT_EQ(program->line(number)->text, number % 2 == 0 ? "X2" : "Y");
    EXPECT_EQ(program->line(number)->offset_bytes, (number - 1) / 2 * 5 + (number % 2 == 0 ? 2 : 0));
  }
}

RC_GTEST_PROP(Program, IsTheSameHoweverItIsRead, (std::size_t piece)) {
  const auto letters =
      rc::gen::container<std::string>(rc::gen::element('G', 'X', '1', ' ', '\r', '\n', '(', ')', ';', '%'));
  const std::string text = "G0\n" + *letters;
  ProgramReader reader("part.nc", nullptr, text);
  while (reader.read_on(piece % 7 + 1)) {
  }
  const auto in_pieces = reader.finish();
  const auto whole = Program::load("part.nc", text);
  RC_ASSERT(in_pieces.has_value());
  RC_ASSERT((*in_pieces)->line_count() == (*whole)->line_count());
  for (const bool with_messages : {true, false}) {
    RC_ASSERT((*in_pieces)->longest_line(with_messages).length == (*whole)->longest_line(with_messages).length);
    RC_ASSERT((*in_pieces)->longest_line(with_messages).number == (*whole)->longest_line(with_messages).number);
  }
}

TEST(Program, RefusesWhatIsNoProgram) {
  EXPECT_EQ(fault_of("").error, ProgramError::Empty);
  EXPECT_EQ(fault_of("(only a comment)\n\n%\n").error, ProgramError::Empty);
  EXPECT_EQ(fault_of(std::string{"G0X1\0G0", 7}).error, ProgramError::Binary);
  EXPECT_EQ(fault_of("G0X1\nG0\x01\n"), (ProgramFault{.error = ProgramError::Binary, .line = 2, .excerpt = "G0\\x01"}));
  EXPECT_EQ(fault_of("G0X1\nG0X2!\n").error, ProgramError::RealtimeByte);
  EXPECT_EQ(fault_of("G0X1\nG0X2\xC3\xA9\n").line, 2U);
}

TEST(Program, TakesUtf8AndLatin1InCommentsOnly) {
  EXPECT_TRUE(Program::load("a", "G0X1 (Fr\xC3\xA4ser 6 mm? really!)\n"));
  EXPECT_TRUE(Program::load("a", "; caf\xE9\nG0X1\n"));
  EXPECT_TRUE(Program::load("a", "\xEF\xBB\xBFG0X1\n\x1A"));
}

TEST(Program, NamesItsLongestLine) {
  const auto program = load("G0X1\nG0 X2 Y3 (a rather long comment that nobody needs)\n(MSG,load the drill)\n");
  EXPECT_EQ(program->longest_line(false).length, 6U);
  EXPECT_EQ(program->longest_line(false).number, 2U);
  EXPECT_EQ(program->longest_line(true).number, 3U);
}

TEST(Program, SaysWhatIsWrongInOneSentence) {
  EXPECT_EQ(describe({.error = ProgramError::Binary, .line = 3, .excerpt = ""}, "logo.png"),
            "logo.png, line 3 is not text but binary; choose a file with G-code as the CAM program writes it.");
}

TEST(WireForm, LeavesOutWhatNoParserNeeds) {
  const auto grbl = wire_form_of(vocabulary::dialect_of(vocabulary::Firmware::Grbl));
  const auto hal = wire_form_of(vocabulary::dialect_of(vocabulary::Firmware::GrblHal));
  EXPECT_EQ(wire(" G1 X10 (roughing) F600 ; go", grbl), "G1X10F600");
  EXPECT_EQ(wire("%", grbl), "");
  EXPECT_EQ(wire("%", hal), "%");
  EXPECT_EQ(wire("(MSG, change the tool!)", grbl), "");
  EXPECT_EQ(wire("(MSG, change the tool!)", hal), "(MSG, change the tool)");
  EXPECT_EQ(wire("(Fr\xC3\xA4ser)", hal), "");
  EXPECT_EQ(wire("$I=my machine", hal), "$I=my machine");
  EXPECT_EQ(wire("G1X1(never closed", hal), "G1X1");
  EXPECT_EQ(wire("G0\tX1", grbl), "G0X1");
}

// Whatever stands in a comment, no byte reaches the wire that a controller would obey at once.
RC_GTEST_PROP(WireForm, NeverSendsARealtimeByte, (const std::string& text)) {
  for (const bool messages : {false, true}) {
    const std::string out = wire(text, {.keeps_messages = messages, .keeps_marks = false, .keeps_percent = true});
    for (const char letter : out) {
      RC_ASSERT(letter >= ' ' && letter < '~');
      RC_ASSERT(letter != '?' && letter != '!');
    }
  }
}

// Walking by offset and asking by number agree.
RC_GTEST_PROP(Program, IndexAndWalkAgree, ()) {
  const auto lengths = *rc::gen::container<std::vector<int>>(700, rc::gen::inRange(0, 4));
  std::string text = "G0\n";
  for (const int length : lengths)
    text += std::string(static_cast<std::size_t>(length), 'X') + (length == 1 ? "\r\n" : "\n");
  const auto program = *Program::load("a", text);
  auto walked = program->line_at(0, 1);
  for (; walked; walked = program->line_at(program->offset_after(*walked), walked->number + 1)) {
    if (walked->number % 37 != 0) continue;
    RC_ASSERT(program->line(walked->number)->offset_bytes == walked->offset_bytes);
  }
}

}  // namespace
}  // namespace kerf::job
