// The path that the virtual controller takes with a transformed program, step by step.

#include "rehearsal/transform.hpp"

#include <algorithm>
#include <map>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "rehearsal/affine.hpp"
#include "rehearsal/transform_test_job.hpp"

namespace kerf::rehearsal {
namespace {

using simulation::Dice;
using simulation::MotionTrace;
using vocabulary::Firmware;

constexpr std::array kFirmwares{Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

/// Firmware reads and adds lengths in floats of 32 bits, of which the last one is up to 8e-6 mm where these programs
/// go, and a mapped program has other numbers to read and add. So a motor may stand one step beside the one that is
/// nearest to the exact place, but only where that place lies within this share of a step of the middle between both.
constexpr double kFloatSteps = 0.03;

MotionTrace trace_of(const std::string& text, Firmware firmware) {
  return simulation::trace_program({.program = text, .operator_goes_on = true}, test_machine(firmware));
}

/// Last block of each line that has any.
std::map<std::uint32_t, vocabulary::AxisSteps> ends_of(const MotionTrace& trace) {
  std::map<std::uint32_t, vocabulary::AxisSteps> ends;
  for (const auto& block : trace.blocks) ends[block.line] = block.end_steps;
  return ends;
}

/// Both programs have the same lines; `text` leads where `map` says.
void expect_mapped(const job::Program& program, const std::string& text, const Affine& map, Firmware firmware) {
  const auto& dialect = vocabulary::dialect_of(firmware);
  const auto places = places_of(program, dialect);
  const MotionTrace before = trace_of(std::string{program.text()}, firmware);
  const MotionTrace after = trace_of(text, firmware);
  RC_ASSERT(before.errors.empty());
  RC_ASSERT(after.errors.empty());
  for (const auto& [line, steps] : ends_of(after)) {
    const ExactValues place{places[line][0], places[line][1], places[line][2]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double exact_steps = map.value(axis, place) * kTestSteps;
      const double off = std::abs(steps.at(axis) - exact_steps);
      if (off > 0.5 + kFloatSteps) {
        RC_LOG(std::to_string(line) + " axis " + std::to_string(axis) + " off " + std::to_string(off) + "\n" +
               std::string{program.text()} + "---\n" + text);
      }
      RC_ASSERT(off <= 0.5 + kFloatSteps);
    }
  }
  // Within arcs: as many chords, each where the map puts it. Both ends of the comparison are rounded to steps, and the
  // number of chords hangs on the last bit of the angle once in a while.
  if (map_of_plane(map, gcode::Plane::XY).factor != 1.0) return;
  if (!std::ranges::equal(before.blocks, after.blocks, {}, &simulation::BlockTrace::line,
                          &simulation::BlockTrace::line)) {
    const auto more = std::max(before.blocks.size(), after.blocks.size());
    // So do the pecks of a cycle, the last of which may be one bit deep: two blocks a hole.
    constexpr std::size_t kPecks = 20;
    RC_ASSERT(more - std::min(before.blocks.size(), after.blocks.size()) <= kPecks + more / 100);
    return;
  }
  for (std::size_t at = 0; at < before.blocks.size(); ++at) {
    ExactValues was_mm{};
    for (std::size_t axis = 0; axis < 3; ++axis) was_mm.at(axis) = before.blocks[at].end_steps.at(axis) / kTestSteps;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double slack = 0.5 + 2 * kFloatSteps;
      for (const double part : map.linear.at(axis)) slack += 0.5 * std::abs(part);
      const double off = std::abs(after.blocks[at].end_steps.at(axis) - map.value(axis, was_mm) * kTestSteps);
      if (off > slack) {
        RC_LOG("block " + std::to_string(at) + " of line " + std::to_string(before.blocks[at].line) + " axis " +
               std::to_string(axis) + "\n" + std::string{program.text()} + "---\n" + text);
      }
      RC_ASSERT(off <= slack);
    }
  }
}

std::string by_chance(Firmware firmware, TestJobParts parts) {
  parts.circles = parts.circles && firmware == Firmware::GrblHal;
  parts.cycles = parts.cycles && firmware == Firmware::GrblHal;
  Dice dice(*rc::gen::arbitrary<std::uint64_t>());
  return TestJobWriter(dice, parts).write(dice.between(5, 40));
}

void check_map(const std::vector<TransformStep>& steps, const Affine& map, const TestJobParts& parts) {
  for (const Firmware firmware : kFirmwares) {
    const auto program = test_program(by_chance(firmware, parts));
    const auto text = transformed_text(*program, steps, vocabulary::dialect_of(firmware));
    if (!text) {
      RC_LOG(std::to_string(text.error().line) + ": " + text.error().reason + "\n" + std::string{program->text()});
    }
    RC_ASSERT(text.has_value());
    expect_mapped(*program, *text, map, firmware);
  }
}

double length_by_chance() {
  return static_cast<double>(*rc::gen::inRange(-20000, 20000)) / 1000.0;
}

RC_GTEST_PROP(TransformPath, IsTranslatedToTheStep, ()) {
  const Translate by{length_by_chance(), length_by_chance(), length_by_chance()};
  check_map({by}, translation(by.x_mm, by.y_mm, by.z_mm), {});
}

RC_GTEST_PROP(TransformPath, IsTurnedToTheStep, ()) {
  const double angle = *rc::gen::elementOf(std::vector<double>{30, 45, 12.5, -77.3});
  const Rotate by{angle, length_by_chance(), length_by_chance()};
  check_map({by}, rotation(angle, by.about_x_mm, by.about_y_mm), {.upright_arcs = false});
}

RC_GTEST_PROP(TransformPath, IsTurnedByRightAnglesToTheStep, ()) {
  const double angle = *rc::gen::elementOf(std::vector<double>{90, 180, 270, -90});
  check_map({Rotate{angle, 0, 0}}, rotation(angle, 0, 0), {.upright_arcs = angle == 180});
}

RC_GTEST_PROP(TransformPath, IsMirroredToTheStep, ()) {
  const auto axis = *rc::gen::elementOf(std::vector<MirrorAxis>{MirrorAxis::X, MirrorAxis::Y, MirrorAxis::Z});
  const double at = length_by_chance();
  check_map({Mirror{axis, at}}, mirror(static_cast<std::size_t>(axis), at), {.cycles = axis != MirrorAxis::Z});
}

RC_GTEST_PROP(TransformPath, IsScaledToTheStep, ()) {
  const double factor = *rc::gen::elementOf(std::vector<double>{0.5, 1.25, 1.003});
  check_map({Scale{factor, factor, factor}}, scaling(factor, factor, factor), {});
}

RC_GTEST_PROP(TransformPath, IsStretchedToTheStep, ()) {
  check_map({Scale{1.5, 0.8, 1}}, scaling(1.5, 0.8, 1), {.arcs = false});
}

RC_GTEST_PROP(TransformPath, StaysInTheOtherUnit, ()) {
  const auto unit = *rc::gen::elementOf(std::vector<LengthUnit>{LengthUnit::Mm, LengthUnit::Inch});
  check_map({ConvertUnits{unit}}, Affine{}, {});
}

RC_GTEST_PROP(TransformPath, StaysWithoutCommentsAndNeedlessDecimals, ()) {
  check_map({StripComments{}, TrimDecimals{5}}, Affine{}, {});
}

RC_GTEST_PROP(TransformPath, ComesBack, ()) {
  const auto there_and_back = *rc::gen::elementOf(std::vector<std::vector<TransformStep>>{
      {Translate{12.345, -7.5, 0.25}, Translate{-12.345, 7.5, -0.25}},
      {Rotate{90}, Rotate{90}, Rotate{90}, Rotate{90}},
      {Mirror{MirrorAxis::Y, 3}, Mirror{MirrorAxis::Y, 3}},
      {Scale{2, 2, 2}, Scale{0.5, 0.5, 0.5}},
      {ConvertUnits{LengthUnit::Inch}, ConvertUnits{LengthUnit::Mm}},
  });
  const bool turns = std::holds_alternative<Rotate>(there_and_back.front());
  const bool converts = std::holds_alternative<ConvertUnits>(there_and_back.front());
  // Inches lie anywhere between two steps, and zeros that are gone from the end of a number may change its last bit.
  const bool has_inches = !converts && *rc::gen::arbitrary<bool>();
  for (const Firmware firmware : kFirmwares) {
    const auto program = test_program(by_chance(firmware, {.upright_arcs = !turns, .inches = has_inches}));
    const auto text = transformed_text(*program, there_and_back, vocabulary::dialect_of(firmware));
    if (!text) RC_LOG(text.error().reason + "\n" + std::string{program->text()});
    RC_ASSERT(text.has_value());
    expect_mapped(*program, *text, Affine{}, firmware);
    if (has_inches) continue;
    const MotionTrace before = trace_of(std::string{program->text()}, firmware);
    const MotionTrace after = trace_of(*text, firmware);
    if (ends_of(before) != ends_of(after)) RC_LOG(std::string{program->text()} + "---\n" + *text);
    RC_ASSERT(ends_of(before) == ends_of(after));
  }
}

}  // namespace
}  // namespace kerf::rehearsal
