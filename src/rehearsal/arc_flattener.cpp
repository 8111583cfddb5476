#include "rehearsal/arc_flattener.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace kerf::rehearsal {
namespace {

/// So many chords stay within the tolerance.
int chords_for(double swept_rad, double radius_mm, double tolerance_mm) {
  constexpr double kMost = 100'000;
  constexpr double kCoarsest_rad = std::numbers::pi / 4;
  const double height = std::clamp(tolerance_mm / radius_mm, 0.0, 1.0);
  const double step_rad = std::min(2.0 * std::acos(1.0 - height), kCoarsest_rad);
  if (step_rad <= 0) return static_cast<int>(kMost);
  return static_cast<int>(std::clamp(std::ceil(std::abs(swept_rad) / step_rad), 1.0, kMost));
}

constexpr std::string_view kArcLetters = "IJKRP";
constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

}  // namespace

ArcFlattener::ArcFlattener(double tolerance_mm, const vocabulary::Dialect& dialect)
    : tolerance_mm_(tolerance_mm), dialect_(&dialect), reading_(dialect) {}

void ArcFlattener::restart() {
  reading_ = ProgramReading(*dialect_);
  writer_ = {};
}

std::expected<void, TransformRefusal> ArcFlattener::on_line(SourceLine line, LineQueue& out) {
  LineText text(line.text);
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (!facts->is_over && facts->use == AxisUse::Arc && reading_.arc() != nullptr) {
    return flatten(std::move(text), *facts, line, out);
  }
  if (!facts->is_over) writer_.pass(text, *facts);
  out.put(std::move(line));
  return {};
}

std::expected<void, TransformRefusal> ArcFlattener::flatten(LineText text, const LineFacts& facts,
                                                            const SourceLine& line, LineQueue& out) {
  const gcode::ArcMove& arc = *reading_.arc();
  const gcode::PlaneAxes plane = gcode::axes_of(facts.modal.plane);
  const auto refuse = [&](std::string reason) {
    return std::unexpected{TransformRefusal{.line = line.number, .reason = std::move(reason)}};
  };
  if (facts.modal.scaling) return refuse("G51 scales this arc in the controller. Take that out.");
  if (text.may_be_skipped())
    return refuse("An arc behind '/' may be skipped, and not only its first line. Take the '/' away.");
  const bool is_placed = has_axis(facts.to.known, plane.first) && has_axis(facts.to.known, plane.second);
  if (!facts.modal.incremental && !is_placed) {
    return refuse("No line before this arc says where it begins. Have the program go there with G90 first.");
  }
  const double i = static_cast<double>(arc.center_offset_mm[0]);
  const double j = static_cast<double>(arc.center_offset_mm[1]);
  double swept = swept_rad(arc, facts.from_machine_mm, *dialect_);
  // Grbl may not see it; the words say it.
  if (is_whole_circle(facts) && std::abs(swept) < 1.0) swept = arc.clockwise ? -kFullTurn_rad : kFullTurn_rad;
  const int chords = chords_for(swept, static_cast<double>(arc.radius_mm), tolerance_mm_);
  const double begin_rad = std::atan2(-j, -i);
  const double begin_mm = std::hypot(i, j);
  const double end_mm = std::hypot(facts.to.mm.at(plane.first) - facts.from.mm.at(plane.first) - i,
                                   facts.to.mm.at(plane.second) - facts.from.mm.at(plane.second) - j);
  const auto axes = static_cast<AxisMask>(facts.named | mask_of_axis(plane.first) | mask_of_axis(plane.second));
  std::vector<ExactValues> places_mm;
  places_mm.reserve(static_cast<std::size_t>(chords));
  for (int chord = 1; chord <= chords; ++chord) {
    const double share = static_cast<double>(chord) / chords;
    ExactValues place_mm = facts.to.mm;
    if (chord < chords) {
      for (std::size_t axis = 0; axis < place_mm.size(); ++axis) {
        place_mm.at(axis) = facts.from.mm.at(axis) + share * (facts.to.mm.at(axis) - facts.from.mm.at(axis));
      }
      const double angle = begin_rad + share * swept;
      const double radius = begin_mm + share * (end_mm - begin_mm);
      place_mm.at(plane.first) = facts.from.mm.at(plane.first) + i + radius * std::cos(angle);
      place_mm.at(plane.second) = facts.from.mm.at(plane.second) + j + radius * std::sin(angle);
    }
    places_mm.push_back(place_mm);
  }
  writer_.put(std::move(text), facts, line, places_mm, axes, 1, kArcLetters, out);
  return {};
}

}  // namespace kerf::rehearsal
