// Transforms that make other lines: the path on the virtual controller stays within a tolerance of what it should be.

#include <functional>
#include <map>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "rehearsal/transform.hpp"
#include "rehearsal/transform_test_job.hpp"

namespace kerf::rehearsal {
namespace {

using simulation::Dice;
using testing::HasSubstr;
using testing::StartsWith;
using vocabulary::Firmware;

using Place = std::array<double, 3>;
using Path = std::vector<Place>;

struct Traced {
  Path path{{}};
  bool is_clean = true;
};

/// Ends of all blocks, mm, from zero on.
Traced traced(const std::string& text, Firmware firmware) {
  const auto trace = simulation::trace_program({.program = text, .operator_goes_on = true}, test_machine(firmware));
  Traced result{.is_clean = trace.errors.empty() && trace.alarms.empty()};
  for (const auto& block : trace.blocks) {
    result.path.push_back(
        {block.end_steps[0] / kTestSteps, block.end_steps[1] / kTestSteps, block.end_steps[2] / kTestSteps});
  }
  return result;
}

double distance_to_segment(const Place& point, const Place& from, const Place& to) {
  double along = 0;
  double length2 = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along += (point.at(axis) - from.at(axis)) * (to.at(axis) - from.at(axis));
    length2 += (to.at(axis) - from.at(axis)) * (to.at(axis) - from.at(axis));
  }
  const double share = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double off = point.at(axis) - from.at(axis) - share * (to.at(axis) - from.at(axis));
    sum += off * off;
  }
  return std::sqrt(sum);
}

/// Every corner of one path lies this close to the other one, in order: each at the first stretch behind that of the
/// corner before.
bool runs_along(const Path& corners, const Path& path, double tolerance_mm) {
  std::size_t at = 0;
  for (const Place& corner : corners) {
    while (at + 1 < path.size() && distance_to_segment(corner, path[at], path[at + 1]) > tolerance_mm) ++at;
    if (at + 1 < path.size()) continue;
    RC_LOG("lost at X" + std::to_string(corner[0]) + " Y" + std::to_string(corner[1]) + " Z" +
           std::to_string(corner[2]));
    return false;
  }
  return true;
}

/// Half a step on each axis, on both sides, and what floats add.
constexpr double kStepSlack_mm = 0.007;
/// Chords of the firmware, $12.
constexpr double kFirmwareArc_mm = 0.002;

void expect_same_way(const Path& before, const Path& after, double tolerance_mm) {
  RC_ASSERT(runs_along(after, before, tolerance_mm + kStepSlack_mm));
  RC_ASSERT(runs_along(before, after, tolerance_mm + kStepSlack_mm));
}

std::string by_chance(Firmware firmware, TestJobParts parts) {
  parts.circles = parts.circles && firmware == Firmware::GrblHal;
  parts.cycles = parts.cycles && firmware == Firmware::GrblHal;
  Dice dice(*rc::gen::arbitrary<std::uint64_t>());
  return TestJobWriter(dice, parts).write(dice.between(5, 30));
}

constexpr std::array kFirmwares{Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

std::string transformed(const std::string& program, const std::vector<TransformStep>& steps,
                        Firmware firmware = Firmware::GrblHal) {
  const auto loaded = test_program(program);
  const auto text = transformed_text(*loaded, steps, vocabulary::dialect_of(firmware));
  return text ? *text : "refused, line " + std::to_string(text.error().line) + ": " + text.error().reason;
}

RC_GTEST_PROP(TransformShape, ArcsBecomeLinesWithinTheTolerance, ()) {
  const double tolerance_mm = *rc::gen::elementOf(std::vector<double>{0.002, 0.01, 0.1});
  for (const Firmware firmware : kFirmwares) {
    const std::string program = by_chance(firmware, {});
    const std::string text = transformed(program, {ArcsToLines{tolerance_mm}}, firmware);
    RC_ASSERT(text.find("refused") == std::string::npos);
    RC_ASSERT(LineText(text).find_command('G', 2) == nullptr);
    const Traced before = traced(program, firmware);
    const Traced after = traced(text, firmware);
    RC_ASSERT(before.is_clean && after.is_clean);
    RC_LOG(program + "---\n" + text);
    expect_same_way(before.path, after.path, tolerance_mm + kFirmwareArc_mm);
  }
}

RC_GTEST_PROP(TransformShape, LinesBecomeArcsWithinTheTolerance, ()) {
  for (const Firmware firmware : kFirmwares) {
    const std::string program = by_chance(firmware, {.upright_arcs = false});
    const std::string lines = transformed(program, {ArcsToLines{0.005}}, firmware);
    const std::string arcs = transformed(lines, {LinesToArcs{0.01}}, firmware);
    RC_ASSERT(arcs.find("refused") == std::string::npos);
    const Traced before = traced(lines, firmware);
    const Traced after = traced(arcs, firmware);
    RC_ASSERT(before.is_clean && after.is_clean);
    expect_same_way(before.path, after.path, 0.01 + kFirmwareArc_mm);
  }
}

TEST(TransformShape, ACircleOfLinesBecomesArcs) {
  std::string lines =
      transformed("G21 G90\nG0 X10 Y0\nG3 X-10 Y0 I-10 J0 F500\nX10 Y0 I10 J0\nG1 X12\n", {ArcsToLines{0.005}});
  EXPECT_GT(std::ranges::count(lines, '\n'), 60);
  const std::string arcs = transformed(lines, {LinesToArcs{0.01}});
  EXPECT_LT(std::ranges::count(arcs, '\n'), 12) << arcs;
  EXPECT_THAT(arcs, HasSubstr("\nG3 X"));
}

RC_GTEST_PROP(TransformShape, DepthFollowsTheSurface, ()) {
  HeightMap map{.x_mm = {-80, -20, 0, 35, 80}, .y_mm = {-80, 10, 80}, .z_mm = {}};
  Dice dice(*rc::gen::arbitrary<std::uint64_t>());
  for (int point = 0; point < 15; ++point) map.z_mm.push_back(dice.between(-1000, 1000) / 1000.0);
  const auto shared = std::make_shared<const HeightMap>(map);
  for (const Firmware firmware : kFirmwares) {
    const std::string program = by_chance(firmware, {.arcs = false, .shifts = false, .cycles = false});
    const std::string text = transformed(program, {FollowHeights{shared}}, firmware);
    RC_ASSERT(text.find("refused") == std::string::npos);
    const Traced before = traced(program, firmware);
    const Traced after = traced(text, firmware);
    RC_ASSERT(before.is_clean && after.is_clean);
    // The exact way, finely cut. The first move comes from nobody knows where.
    Path exact;
    for (std::size_t at = 1; at < before.path.size(); ++at) {
      const Place& from = before.path[at == 1 ? 1 : at - 1];
      const Place& to = before.path[at];
      constexpr int kPieces = 3000;
      for (int piece = 0; piece <= kPieces; ++piece) {
        Place place{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          place.at(axis) = from.at(axis) + (to.at(axis) - from.at(axis)) * piece / kPieces;
        }
        place[2] += map.height_mm(place[0], place[1]);
        exact.push_back(place);
      }
    }
    Path real(after.path.begin() + 1, after.path.end());
    real.push_back(real.back());
    expect_same_way(exact, real, 0.002 + kStepSlack_mm);
  }
}

TEST(TransformShape, CutsOutsideTheGridAreRefused) {
  const auto map = std::make_shared<const HeightMap>(HeightMap{.x_mm = {0, 10}, .y_mm = {0, 10}, .z_mm = {0, 0, 1, 1}});
  const std::string text = transformed("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX11\n", {FollowHeights{map}});
  EXPECT_THAT(text, StartsWith("refused, line 4: X11.000 Y0.000 lies outside the measured grid"));
  EXPECT_EQ(transformed("G21 G90\nG0 X0 Y0 Z5\nX20 Y10\n", {FollowHeights{map}}),
            "G21 G90\nG0 X0 Y0 Z5\nX10 Y5 Z5.5\nX20 Y10 Z6\n");
}

TEST(TransformRepeat, RapidsStayAndCutsGoDeeper) {
  const std::string text = transformed("%\nG21 G90\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nX20\nG0 Z5\nM30\n%\n",
                                       {RepeatDeeper{.passes = 2, .step_mm = 0.5}});
  EXPECT_EQ(text,
            "%\nG21 G90\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nX20\nG0 Z5\n"
            "G90 G21 G17 G94 G0\nG21 G90\nG0 Z5\nG0 X1 Y2\nG1 Z-1.5 F100\nX20\nG0 Z5\nM30\n%\n");
}

TEST(TransformRepeat, ARapidFromAFedRetractGoesUpFirst) {
  const std::string text = transformed("G21 G90\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nX20\nZ2\nG0 X0\nM2\n",
                                       {RepeatDeeper{.passes = 2, .step_mm = 3}});
  EXPECT_THAT(text, testing::EndsWith("G1 Z-4 F100\nX20\nZ-1\nG0 Z2\nG0 X0\nM2\n"));
}

TEST(TransformRepeat, RefusesWhatItCannotKnow) {
  const std::vector<TransformStep> twice{RepeatDeeper{.passes = 2, .step_mm = 1}};
  EXPECT_THAT(transformed("G21 G90\nG0 X1 Y1 Z-1\nG1 X5 F100\nG0 Z5\n", twice), StartsWith("refused, line 3: A rapid"));
  EXPECT_THAT(transformed("G0 X5 Y5\nG0 Z5\nG1 Z-1 F100\nM30\n", twice),
              StartsWith("refused, line 0: The program begins"));
  EXPECT_THAT(transformed("T1 M6\nG0 Z5\nT2 M6\nG0 Z6\n", twice),
              StartsWith("refused, line 1: The program uses several"));
  EXPECT_THAT(transformed("G0 Z5\nG92 X0\nG1 X5 F100\n", twice), StartsWith("refused, line 2"));
}

TEST(TransformRepeat, CopiesSelectTheirZero) {
  const std::string text = transformed("(a)\nG21 G90 G54\nG0 Z5\nG1 X5 Z-1 F100\nG0 Z5\nM30\n", {CopyToZeros{{0, 2}}});
  EXPECT_EQ(text,
            "(a)\nG54\nG21 G90 G54\nG0 Z5\nG1 X5 Z-1 F100\nG0 Z5\n(a)\nG90 G21 G17 G94 G0 G56\nG21 G90 G56\nG0 Z5\n"
            "G1 X5 Z-1 F100\nG0 Z5\nM30\n");
}

TEST(TransformPart, TheRestHasWhatItNeedsInFront) {
  const std::string program =
      "G21 G90 G55\nT3 M6\nM3 S9000\nG4 P2\nM8\nG0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nX20 F600\nG91\nY5\nX-5\nG90 G0 Z5\nM30\n";
  EXPECT_EQ(transformed(program, {RunFromLine{12}}),
            "G90 G21 G17 G94 G55\nT3 M6\nM3 S9000\nG4 P2\nM8\nG0 Z5\nG0 X20 Y7\nG1 Z-1 F100\nG91 G21 G17 G94\nF600\n"
            "X-5\nG90 G0 Z5\nM30\n");
}

TEST(TransformPart, RefusesWhatItCannotKnow) {
  EXPECT_THAT(transformed("G0 X1 Y1 Z5\nG92 X0\nG1 X5 F100\n", {RunFromLine{3}}), StartsWith("refused, line 2"));
  EXPECT_THAT(transformed("G0 X1 Z5\nG0 X5\n", {RunFromLine{2}}), StartsWith("refused, line 2: No line before"));
  EXPECT_THAT(transformed("G0 X1 Z5\nG0 X5\n", {RunFromLine{3}}),
              StartsWith("refused, line 0: The program has no line 3"));
  EXPECT_THAT(transformed("G38.2 Z-5 F50\nG0 X5\n", {RunFromLine{2}}), StartsWith("refused, line 1: This line probes"));
}

TEST(TransformPart, ALaserDoesNotBurnOnItsWay) {
  EXPECT_EQ(transformed("G21 G90\nM4 S500\nG0 X1 Y2\nG1 X5 F600\nX9\n", {RunFromLine{5}}),
            "G90 G21 G17 G94\nG0 X5 Y2\nM4 S500\nF600\nG1 X9\n");
}

/// By chance, but with a line in the middle: the machine ends where it does, and goes the same way to there.
RC_GTEST_PROP(TransformPart, TheRestEndsWhereTheWholeDoes, ()) {
  for (const Firmware firmware : kFirmwares) {
    const std::string program = by_chance(firmware, {.shifts = false, .cycles = false});
    const auto lines = static_cast<std::uint32_t>(std::ranges::count(program, '\n'));
    const auto from = *rc::gen::inRange<std::uint32_t>(3, lines + 1);
    const std::string text = transformed(program, {RunFromLine{from}}, firmware);
    if (text.find("how fast the tool may plunge") != std::string::npos) continue;
    RC_ASSERT(text.find("refused") == std::string::npos);
    const Traced whole = traced(program, firmware);
    const Traced rest = traced(text, firmware);
    RC_ASSERT(whole.is_clean && rest.is_clean);
    if (rest.path.size() < 2) continue;
    RC_ASSERT(distance_to_segment(rest.path.back(), whole.path.back(), whole.path.back()) <= kStepSlack_mm);
  }
}

TEST(TransformPart, ToolsBecomePrograms) {
  const auto program = test_program(
      "G21 G90\nT1 M6\nM3 S9000\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG0 Z5\nM5\nT2 M6\nM3 S5000\nG0 X3 Y3\nG0 Z5\nG1 Z-2 F50\nG0 "
      "Z5\n"
      "M30\n");
  const auto& dialect = vocabulary::dialect_of(Firmware::GrblHal);
  const auto parts = tool_parts(*program, dialect);
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 2U);
  std::vector<std::string> texts;
  for (const ToolPart& part : *parts) {
    Transform transform(*program, {}, dialect, part.part);
    std::string text;
    for (auto line = transform.next(); line && *line; line = transform.next()) append_line(text, **line, true);
    texts.push_back(text);
  }
  EXPECT_EQ(texts[0], "G21 G90\nT1 M6\nM3 S9000\nG0 X1 Y1 Z5\nG1 Z-1 F100\nG0 Z5\nM5\nM5\nM9\nM30\n");
  EXPECT_EQ(texts[1], "G90 G21 G17 G94\nS9000\nF100\nT2 M6\nM3 S5000\nG0 X3 Y3\nG0 Z5\nG1 Z-2 F50\nG0 Z5\nM30\n");
}

TEST(TransformPart, AToolThatRestsOnTheOneBeforeIsRefused) {
  const auto program = test_program("G0 X1 Y1 Z5\nT1 M6\nG1 Z-1 F100\nT2 M6\nG1 X5\n");
  const auto& dialect = vocabulary::dialect_of(Firmware::Rabbit);
  const auto parts = tool_parts(*program, dialect);
  ASSERT_TRUE(parts);
  Transform transform(*program, {}, dialect, parts->back().part);
  auto line = transform.next();
  while (line && *line) line = transform.next();
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().line, 5U);
}

TEST(TransformOutline, GoesAroundTheCutsAboveThem) {
  const std::string program =
      "G21 G90\nG0 X-50 Y-50 Z8\nX0 Y0\nG1 Z-1 F100\nX10\nG3 X10 Y10 I0 J5\nG1 X0 Y0\nG0 Z3\nM30\n";
  EXPECT_EQ(
      transformed(program, {Outline{.shape = OutlineShape::Box, .feed_mm_per_min = 2000}}),
      "(Outline: nothing is cut, the spindle stands still)\nG90 G21 G17 G94\nM5\nG0 Z8\nG0 X0 Y0\nG1 X15 Y0 F2000\n"
      "G1 X15 Y10\nG1 X0 Y10\nG1 X0 Y0\nM30\n");
  const std::string hull = transformed(program, {Outline{.shape = OutlineShape::Hull}});
  EXPECT_THAT(hull, HasSubstr("G1 X10 Y10\nG1 X0 Y0\nM30\n"));
  EXPECT_THAT(transformed("G0 X1 Y1 Z0\nG1 X5 F100\n", {Outline{}}), StartsWith("refused, line 0: The program never"));
}

}  // namespace
}  // namespace kerf::rehearsal
