#include "sender/job/resume_plan.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/job/resume_test_job.hpp"

namespace kerf::job {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using vocabulary::Firmware;

constexpr std::string_view kPart =
    "G21 G90 G54\n"        // 1
    "M3 S12000\n"          // 2
    "G4 P2\n"              // 3
    "M8\n"                 // 4
    "G0 Z5\n"              // 5
    "G0 X10 Y10\n"         // 6
    "G1 Z-2 F200\n"        // 7
    "G1 X60 F800\n"        // 8
    "Y60\n"                // 9
    "G2 X70 Y70 I10 J0\n"  // 10
    "X80 Y80 I10 J0\n"     // 11
    "G91\n"                // 12
    "G1 X5\n"              // 13
    "X5\n"                 // 14
    "G90 G0 Z5\n"          // 15
    "M30\n";               // 16

constexpr std::array kFirmwares{Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

std::shared_ptr<const Program> program(std::string_view text) {
  return *Program::load("part.nc", std::string{text});
}

ResumePlan plan(std::string_view text, const ResumeFacts& facts, const ResumeChoice& choice = {}) {
  const auto file = program(text);
  auto result = plan_resume(*file, facts, choice);
  EXPECT_TRUE(result) << (result ? "" : result.error().sentence);
  return result ? *result : ResumePlan{};
}

ResumeRefusal refusal(std::string_view text, const ResumeFacts& facts, const ResumeChoice& choice = {}) {
  const auto file = program(text);
  auto result = plan_resume(*file, facts, choice);
  EXPECT_FALSE(result);
  return result ? ResumeRefusal{} : result.error();
}

TEST(ResumePlan, ComesUpSwitchesOnGoesAcrossAndComesDownFed) {
  for (const Firmware firmware : kFirmwares) {
    const auto made = plan(kPart, testing::facts(firmware, 9));
    EXPECT_EQ(made.from_line, 9U);
    EXPECT_THAT(made.preamble(), ElementsAre("G21G90G94G17", "G53G0Z-1", "M5", "M3S12000", "M8", "G4P4",
                                             "G53G0X-140Y-140", "G54", "G53G0Z-54", "G53G1Z-62F200", "F800", "G1"));
    EXPECT_EQ(made.highest_cut_mm, -55.0);
    EXPECT_THAT(made.path.front().position_mm, ElementsAre(-1, -1, -1));
  }
}

TEST(ResumePlan, AnArcThatContinuesGetsItsWord) {
  const auto made = plan(kPart, testing::facts(Firmware::Grbl, 11));
  ASSERT_TRUE(made.rewritten);
  EXPECT_EQ(made.rewritten->line, 11U);
  EXPECT_EQ(made.rewritten->text, "G2X80Y80I10J0");
  const auto resumed = resumed_program(*program(kPart), made);
  EXPECT_EQ(resumed.program->line(12)->text, "G2X80Y80I10J0");
  EXPECT_EQ(resumed.program->line(13)->text, "G91");
  EXPECT_EQ(resumed.origin.preamble_lines, 11U);
  EXPECT_EQ(resumed.origin.first_line, 11U);
}

TEST(ResumePlan, IncrementalModeComesBackAfterAnAbsoluteWay) {
  const auto made = plan(kPart, testing::facts(Firmware::GrblHal, 14));
  EXPECT_THAT(made.preamble().back(), HasSubstr("G91"));
  EXPECT_NEAR(made.resume_position_mm[0], -115, 0.001);
}

TEST(ResumePlan, BeforeTheFirstCutItBeginsAnew) {
  const auto made = plan(kPart, testing::facts(Firmware::Grbl, 7));
  EXPECT_TRUE(made.is_from_the_beginning);
  EXPECT_EQ(made.from_line, 1U);
  EXPECT_THAT(made.steps, IsEmpty());
}

TEST(ResumePlan, ANewBeginningGetsBackWhatTheFirstLinesRelyOn) {
  // A cable was pulled, so the controller still has the zero, the modes and the spindle of the program's middle.
  constexpr std::string_view kTape = "%\nG54\nM3S1000\nG0Z5\nG0X10Y10\nG1Z-1F200\nX20\nM30\n%\n";
  for (const Firmware firmware : kFirmwares) {
    auto facts = testing::facts(firmware, 5);
    facts.present.offsets_mm["G92"] = {5, 0, 0};
    facts.present.modes.distance = "G91";
    facts.present.modes.spindle = "M3";
    facts.present.modes.spindle_rpm = 1000;
    facts.present.machine_position_mm = std::vector<double>{-150, -140, -30};
    const auto made = plan(kTape, facts, {.offsets = OffsetsChoice::AsThen});
    EXPECT_TRUE(made.is_from_the_beginning);
    // Behind the lines of the plan a second % would be the end.
    EXPECT_EQ(made.from_line, 2U);
    const auto lines = made.preamble();
    EXPECT_THAT(lines, ::testing::Contains("G92.1"));
    EXPECT_THAT(lines, ::testing::Contains("M5S0"));
    EXPECT_THAT(lines, ::testing::Contains("G53G0X-1Y-1"));
    EXPECT_THAT(lines.front(), HasSubstr("G90"));
    EXPECT_EQ(resumed_program(*program(kTape), made).program->line(static_cast<std::uint32_t>(lines.size()) + 1)->text,
              "G54");
  }
}

TEST(ResumePlan, AFullCircleBeginsInItsEndToTheLastBit) {
  // Of coordinates such as these the last bit differs with the way they are written.
  for (int tenth = 0; tenth < 40; ++tenth) {
    const std::string x = std::to_string(23 + tenth) + ".757";
    const std::string text =
        "G21G90\nM3S1000\nG0Z5\nX" + x + "Y17.508\nG1Z-0.5F200\nG2X" + x + "Y17.508I-7.460J0F1300\nG0Z5\nM30\n";
    for (const Firmware firmware : kFirmwares) {
      // The plan is checked as the controller reads it, arc for arc.
      const auto made = plan(text, testing::facts(firmware, 6));
      EXPECT_EQ(made.from_line, 6U) << x;
    }
  }
}

TEST(ResumePlan, AFullCircleBehindAShiftThatIsNotExactIsBegunBeforeIt) {
  const std::string_view text =
      "G21G90\nM3S1000\nG0Z5\nX23.757Y17.508\nG92X3.3Y7.7Z1.1\nX3.3Y7.7\nG1Z-2F200\nG2X3.3Y7.7I-7."
      "46J0F1300\nG0Z5\nM30\n";
  for (const Firmware firmware : kFirmwares) {
    const auto made = plan(text, testing::facts(firmware, 8));
    EXPECT_GE(made.from_line, 1U);
    EXPECT_LE(made.from_line, 8U);
  }
}

TEST(ResumePlan, ABeamStaysOffOnTheWay) {
  const auto made =
      plan("G21G90\nM4S500\nG0X10Y10\nG1X50F1000\nY50\nX10\nY10\nM5\n", testing::facts(Firmware::Grbl, 6, "1"));
  const auto lines = made.preamble();
  const auto beam = std::ranges::find(lines, "M4S500");
  ASSERT_NE(beam, lines.end());
  EXPECT_EQ(std::ranges::find(lines, "M5") - lines.begin(), 1);
  EXPECT_TRUE(std::none_of(beam, lines.end(), [](const std::string& line) { return line.starts_with("G53"); }));
}

TEST(ResumePlan, ACannedCycleIsBegunAgainWithItsWords) {
  const std::string_view drilling = "G21G90\nM3S1000\nG0X0Y0Z10\nG98G81X0Y0Z-5R2F100\nX10\nX20\nX30\nG80\nG0Z10\nM30\n";
  const auto made = plan(drilling, testing::facts(Firmware::GrblHal, 6));
  ASSERT_TRUE(made.rewritten);
  EXPECT_EQ(made.rewritten->text, "G81R2Z-5X20");
}

TEST(ResumePlan, AProbedStateIsRefusedUntilItIsAbsoluteAgain) {
  const std::string_view probing =
      "G21G90\nM3S1000\nG0X0Y0Z10\nG1X10F500\nG38.2Z-20F50\nG91\nG1X5F100\nG90\nG0X0Y0Z10\nG1X20\nX30\nM30\n";
  const auto refused = refusal(probing, testing::facts(Firmware::Grbl, 8));
  EXPECT_EQ(refused.problem, ResumeProblem::StateUnknown);
  EXPECT_EQ(refused.line, 5U);
  EXPECT_THAT(refused.next, HasSubstr("line 10"));
  EXPECT_EQ(plan(probing, testing::facts(Firmware::Grbl, 11)).from_line, 11U);
}

TEST(ResumePlan, OffsetsThatChangedAreRefusedTakenOrPutBack) {
  auto facts = testing::facts(Firmware::Grbl, 9);
  facts.present.offsets_mm["G54"] = {-200, -150, -58.5};
  EXPECT_EQ(refusal(kPart, facts).problem, ResumeProblem::OffsetsDiffer);
  EXPECT_NEAR(plan(kPart, facts, {.offsets = OffsetsChoice::Present}).resume_position_mm[2], -60.5, 0.001);
  EXPECT_THAT(plan(kPart, facts, {.offsets = OffsetsChoice::AsThen}).preamble(),
              ::testing::Contains("G10L2P1X-200Y-150Z-60"));
}

TEST(ResumePlan, WhatAResetWipedComesBack) {
  const std::string_view shifted = "G21G90G43.1Z3\nG0X0Y0\nG92X5\nM3S1000\nG0Z5\nG1X10F500\nX20\nX30\nM30\n";
  for (const Firmware firmware : kFirmwares) {
    const auto lines = plan(shifted, testing::facts(firmware, 8)).preamble();
    EXPECT_THAT(lines, ::testing::Contains(HasSubstr("G43.1Z3")));
    EXPECT_THAT(lines, ::testing::Contains(HasSubstr("G92X")));
  }
}

TEST(ResumePlan, AMachineThatDoesNotAnswerIsRefused) {
  auto facts = testing::facts(Firmware::Rabbit, 9);
  EXPECT_EQ(plan(kPart, facts).from_line, 9U);
  facts.silent_for_s = 34.2;
  const auto refused = refusal(kPart, facts);
  EXPECT_EQ(refused.problem, ResumeProblem::MachineNotReady);
  EXPECT_THAT(refused.sentence, HasSubstr("not answered for 34 s"));
}

TEST(ResumePlan, APositionThatNobodyKnowsIsRefused) {
  auto facts = testing::facts(Firmware::Grbl, 9);
  facts.present.homing.all.reset();
  EXPECT_EQ(refusal(kPart, facts).problem, ResumeProblem::PositionUnknown);
  facts.capabilities.settings[0].value = "0";
  facts.position_doubt = "the power failed";
  EXPECT_EQ(refusal(kPart, facts).problem, ResumeProblem::PositionUnknown);
  facts.position_doubt.clear();
  const auto made = plan(kPart, facts);
  EXPECT_TRUE(made.steps.front().asks);
  // Not homed: only as high as it has been.
  EXPECT_EQ(made.safe_height_mm, 0.0);
}

TEST(ResumePlan, AHeightInTheWorkIsRefused) {
  EXPECT_EQ(refusal(kPart, testing::facts(Firmware::Grbl, 9), {.safe_height_mm = -60}).problem,
            ResumeProblem::NoSafeHeight);
}

TEST(ResumePlan, MacrosAndExpressionsAreRefused) {
  EXPECT_EQ(refusal("G21G90\nG1X1F100\n#1=5\nG1X2\nX3\n", testing::facts(Firmware::GrblHal, 5)).problem,
            ResumeProblem::StateUnknown);
}

TEST(ResumePlan, ATravelThatIsLeftIsRefused) {
  EXPECT_EQ(refusal("G21G90\nM3S1\nG1X1F100\nX2\nX3\nX900\n", testing::facts(Firmware::Grbl, 4)).problem,
            ResumeProblem::OutsideTravel);
}

}  // namespace
}  // namespace kerf::job
