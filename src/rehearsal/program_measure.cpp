#include "rehearsal/program_measure.hpp"

#include <algorithm>
#include <cmath>

#include "common/motion/arc_extent.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::AxisValues;

void widen(PathBounds& bounds, std::size_t axis, float mm) {
  bounds.least_mm.at(axis) = std::min(bounds.least_mm.at(axis), mm);
  bounds.most_mm.at(axis) = std::max(bounds.most_mm.at(axis), mm);
}

double distance_mm(const AxisValues& from, const AxisValues& to) {
  double sum = 0;
  for (std::size_t axis = 0; axis < Point{}.size(); ++axis) {
    const double way = static_cast<double>(to.at(axis)) - static_cast<double>(from.at(axis));
    sum += way * way;
  }
  return std::sqrt(sum);
}

}  // namespace

void ProgramMeasure::add_point(const AxisValues& machine_mm, AxisMask known, bool cuts) {
  const AxisValues offset = reading_.interpreter().work_coordinate_offset();
  for (std::size_t axis = 0; axis < Point{}.size(); ++axis) {
    if (!has_axis(known, axis)) continue;
    const float mm = machine_mm.at(axis) - offset.at(axis);
    widen(size_.all, axis, mm);
    if (cuts) widen(size_.cutting, axis, mm);
  }
}

std::expected<void, TransformRefusal> ProgramMeasure::add(const SourceLine& line) {
  ++size_.lines;
  const auto facts = reading_.read(LineText(line.text), line.number);
  if (!facts) return std::unexpected{facts.error()};
  AxisValues at = facts->from_machine_mm;
  // Of the way to G28 and in G53 nothing is known in these coordinates.
  const bool is_known_way = facts->use != AxisUse::Home && facts->use != AxisUse::Machine;
  const AxisMask known = is_known_way ? facts->to.known : AxisMask{0};
  for (const gcode::Action& action : reading_.actions()) {
    if (const auto* move = std::get_if<gcode::LinearMove>(&action)) {
      (move->feed.rapid ? size_.rapid_mm : size_.cutting_mm) += distance_mm(at, move->target_mm);
      if (!move->feed.rapid) add_point(at, known & facts->from.known, true);
      add_point(move->target_mm, known, !move->feed.rapid);
      at = move->target_mm;
    } else if (const auto* arc = std::get_if<gcode::ArcMove>(&action)) {
      const double swept = std::abs(swept_rad(*arc, at, reading_.dialect()));
      const auto helix = gcode::axes_of(arc->plane).linear;
      const double rise = static_cast<double>(arc->target_mm.at(helix)) - static_cast<double>(at.at(helix));
      size_.cutting_mm += std::hypot(swept * static_cast<double>(arc->radius_mm), rise);
      add_point(at, known & facts->from.known, true);
      for (const AxisValues& extreme : motion::extremes_of(motion::arc_of(*arc, at))) add_point(extreme, known, true);
      add_point(arc->target_mm, known, true);
      at = arc->target_mm;
    } else if (const auto* probe = std::get_if<gcode::ProbeMove>(&action)) {
      at = probe->target_mm;
    }
  }
  return {};
}

}  // namespace kerf::rehearsal
