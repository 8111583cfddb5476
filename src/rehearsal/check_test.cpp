#include "rehearsal/check.hpp"

#include <gmock/gmock.h>

#include "rehearsal/sent_lines.hpp"

namespace kerf::rehearsal {
namespace {

using simulation::CaseMachine;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::SizeIs;
using vocabulary::Firmware;

CaseMachine machine_of(Firmware firmware) {
  CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"22", "1"},     {"30", "24000"}, {"110", "6000"}, {"111", "6000"},
                             {"112", "3000"}, {"130", "400"},  {"131", "300"},  {"132", "80"}};
  return machine;
}

std::shared_ptr<const job::Program> program_of(std::string text) {
  return *job::Program::load("part.nc", std::move(text));
}

CheckResult check(Firmware firmware, std::string text, const CheckPlace& place = {}) {
  const auto program = program_of(std::move(text));
  return check_program(*program, check_machine_of(machine_of(firmware), place));
}

class Checks : public testing::TestWithParam<Firmware> {};

TEST_P(Checks, GroupWhatIsAlike) {
  std::string text = "G21 G90\nM3 S10000\nG0 Z5\nG0 X0 Y0\nG1 Z-1 F300\n";
  for (int line = 0; line < 1000; ++line) text += "G1 X" + std::to_string(line % 50) + " F99999\n";
  const CheckResult result = check(GetParam(), text);
  ASSERT_THAT(result.groups, SizeIs(1));
  const FindingGroup& group = result.groups.front();
  EXPECT_EQ(group.kind, FindingKind::FeedTooHigh);
  EXPECT_EQ(group.count, 1000U - 1U) << "the first of these lines goes nowhere";
  EXPECT_EQ(group.last_line, 1005U);
  EXPECT_THAT(group.first, SizeIs(Findings::kKept));
  EXPECT_EQ(group.first.front().line, 7U);
  EXPECT_EQ(result.warnings, 999U);
  EXPECT_EQ(result.errors, 0U);
}

TEST_P(Checks, TheWorstComesFirst) {
  const CheckResult result = check(GetParam(), "G21 G90\nM0\nG0 Z5\nM3 S90000\nG1 X1\nG1 X1 F100\n");
  ASSERT_THAT(result.groups, SizeIs(3));
  EXPECT_EQ(result.groups[0].kind, FindingKind::FeedMissing);
  EXPECT_EQ(result.groups[0].code, "error:22");
  EXPECT_EQ(result.groups[1].kind, FindingKind::SpeedOutOfRange);
  EXPECT_EQ(result.groups[2].kind, FindingKind::Stop);
  EXPECT_EQ(result.worst(), Severity::Error);
}

TEST_P(Checks, ReadInPiecesIsTheSame) {
  const auto program = program_of("G21 G90\nM3 S100\nG0 Z5\nG1 X500 F100\nG0 Z-5\nM30\nG99.9\n");
  const CheckMachine machine = check_machine_of(machine_of(GetParam()));
  Checker pieces(*program, machine);
  while (pieces.read_on(1)) EXPECT_LE(pieces.share_read(), 1.0);
  EXPECT_EQ(pieces.finish().groups, check_program(*program, machine).groups);
}

TEST_P(Checks, ExtentsAreThoseOfTheWork) {
  const CheckResult result = check(GetParam(), "G21 G90\nG0 Z5\nG0 X15 Y-5\nG91\nX5\nG90\nG2 X0 I-10 F100\n",
                                   {.zero_mm = {{-100, -100, -50}}, .position_mm = {}});
  ASSERT_THAT(result.extents, SizeIs(3));
  EXPECT_EQ(result.extents[0], (AxisExtent{.axis = "X", .min_mm = 0, .max_mm = 20}));
  EXPECT_EQ(result.extents[1], (AxisExtent{.axis = "Y", .min_mm = -15, .max_mm = -5}));
  EXPECT_EQ(result.extents[2], (AxisExtent{.axis = "Z", .min_mm = 5, .max_mm = 5}));
}

TEST(SentLines, WaitsForToolsAndEnds) {
  const auto program = program_of("%\nT1\nM6\n(a comment)\nG0 X1\nM30\n%\nX5\n");
  for (const Firmware firmware : {Firmware::Grbl, Firmware::GrblHal}) {
    SentLines lines(*program, vocabulary::dialect_of(firmware));
    std::vector<std::uint32_t> sent;
    std::vector<std::uint32_t> changes;
    while (const auto line = lines.next()) {
      if (!line->wire.empty() && line->wire != "%") sent.push_back(line->number);
      if (line->tool_change) changes.push_back(line->number);
    }
    EXPECT_THAT(changes, ElementsAre(3U));
    EXPECT_EQ(lines.end_line(), 6U);
    // Grbl has no M6: it is the operator's.
    const bool sends_change = firmware == Firmware::GrblHal;
    EXPECT_THAT(sent, sends_change ? ElementsAreArray({2U, 3U, 5U, 6U}) : ElementsAreArray({2U, 5U, 6U}));
  }
}

TEST(FindingRows, AreWhole) {
  for (const FindingRow& row : all_finding_rows()) {
    EXPECT_FALSE(row.title.empty());
    EXPECT_FALSE(row.title.ends_with('.')) << row.title;
    EXPECT_TRUE(row.reason.ends_with('.')) << row.title;
    EXPECT_TRUE(row.kind == FindingKind::Refused || row.next.ends_with('.')) << row.title;
    EXPECT_EQ(&row_of(row.kind), &row);
  }
  EXPECT_EQ(all_finding_rows().size(), boost::mp11::mp_size<boost::describe::describe_enumerators<FindingKind>>::value);
}

INSTANTIATE_TEST_SUITE_P(Firmwares, Checks, testing::Values(Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal),
                         [](const auto& value) {
                           return std::string{boost::describe::enum_to_string(value.param, "?")};
                         });

}  // namespace
}  // namespace kerf::rehearsal
