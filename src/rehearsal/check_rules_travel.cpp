// The rules about where the machine may go.

#include <algorithm>
#include <cmath>

#include "common/motion/arc.hpp"
#include "common/motion/arc_extent.hpp"
#include "rehearsal/check_rules.hpp"

namespace kerf::rehearsal {
namespace {

/// Rounding of numbers is not worth a word; a controller that guards its limits thinks otherwise.
constexpr float kToleranceMm = 0.002F;

/// The box around the whole circle of an arc.
bool circle_fits(const gcode::ArcMove& arc, const AxisValues& from_mm, std::size_t axis, std::size_t which,
                 const vocabulary::Travel& travel) {
  const float center = from_mm.at(axis) + arc.center_offset_mm.at(which);
  const float radius = std::hypot(arc.center_offset_mm[0], arc.center_offset_mm[1]) + kToleranceMm;
  return center - radius >= travel.min_mm && center + radius <= travel.max_mm;
}

}  // namespace

TravelRule::TravelRule(const CheckMachine& machine) : machine_(machine) {
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (!machine.travel.at(axis)) continue;
    const AxisMask bit = axis_bit(axis);
    const bool is_placed = machine.knows_offsets;
    const bool is_guarded = has_axis(machine.guarded_axes, axis);
    AxisMask& mask = is_placed && is_guarded ? guarded_ : is_placed && machine.is_homed ? watched_ : measured_;
    mask = static_cast<AxisMask>(mask | bit);
  }
}

std::optional<TravelRule::Excess> TravelRule::excess_at(const AxisValues& place_mm, AxisMask axes,
                                                        float tolerance_mm) const {
  std::optional<Excess> worst;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (!has_axis(axes, axis)) continue;
    const vocabulary::Travel& travel = *machine_.travel.at(axis);
    const float place = place_mm.at(axis);
    const float excess = std::max(travel.min_mm - place, place - travel.max_mm);
    if (excess <= tolerance_mm || (worst && worst->excess_mm >= excess)) continue;
    worst = Excess{.axis = axis, .place_mm = place, .excess_mm = excess};
  }
  return worst;
}

/// Of an arc as the controller cuts it, or as it is drawn.
std::optional<TravelRule::Excess> TravelRule::excess_on_arc(const CheckedMove& move, AxisMask axes, bool as_cut) const {
  const auto plane = gcode::axes_of(move.arc->plane);
  const auto fits = [&](std::size_t axis, std::size_t which) {
    return !has_axis(axes, axis) || circle_fits(*move.arc, move.from_mm, axis, which, *machine_.travel.at(axis));
  };
  if (fits(plane.first, 0) && fits(plane.second, 1)) return std::nullopt;
  const motion::Arc arc = motion::arc_of(*move.arc, move.from_mm);
  if (!as_cut) {
    for (const AxisValues& place : motion::extremes_of(arc)) {
      if (const auto excess = excess_at(place, axes, kToleranceMm)) return excess;
    }
    return std::nullopt;
  }
  motion::ArcChords chords(arc, motion::rules_of(machine_.dialect->firmware), machine_.motion);
  std::optional<Excess> worst;
  while (const auto chord = chords.next()) {
    const auto excess = excess_at(*chord, axes, 0);
    // Up to the first place where it turns back: there may be very many turns.
    if (worst && (!excess || excess->excess_mm < worst->excess_mm)) break;
    if (excess) worst = excess;
  }
  return worst;
}

/// An axis that stays where it was told to be outside.
AxisMask TravelRule::still_outside(const CheckedMove& move) {
  for (std::size_t axis = 0; outside_ != 0 && axis < kMaxAxes; ++axis) {
    if (move.to_mm.at(axis) != move.from_mm.at(axis)) outside_ = static_cast<AxisMask>(outside_ & ~axis_bit(axis));
  }
  return outside_;
}

void TravelRule::check_place(const CheckedMove& move, AxisMask axes, FindingKind kind, Findings& findings) {
  const bool is_guarded = kind == FindingKind::SoftLimit;
  axes = static_cast<AxisMask>(axes & move.known_to & ~still_outside(move));
  if (axes == 0) return;
  auto excess = excess_at(move.to_mm, axes, is_guarded ? 0.0F : kToleranceMm);
  bool is_on_the_way = false;
  if (!excess && move.arc != nullptr) {
    excess = excess_on_arc(move, axes, is_guarded);
    is_on_the_way = excess.has_value();
  }
  if (!excess) return;
  outside_ = static_cast<AxisMask>(outside_ | axis_bit(excess->axis));
  findings.add(
      kind, move.line.number, move.line.text,
      [&] {
        const vocabulary::Travel& travel = *machine_.travel.at(excess->axis);
        const float work_mm = excess->place_mm - move.work_offset_mm.at(excess->axis);
        return (is_on_the_way ? "The arc bulges out to " : "It goes to ") + place_on(excess->axis, work_mm) +
               ", in machine coordinates " + short_mm(excess->place_mm) + ": " + short_mm(excess->excess_mm) +
               " mm beyond the travel from " + short_mm(travel.min_mm) + " to " + short_mm(travel.max_mm) + ".";
      },
      is_guarded ? "ALARM:2" : "");
}

void TravelRule::extend(const CheckedMove& move, const AxisValues& place_mm, AxisMask axes, Findings& findings) {
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (!has_axis(axes, axis)) continue;
    Span& span = spans_.at(axis);
    const float place = place_mm.at(axis);
    span.min_mm = std::min(span.min_mm, place);
    span.max_mm = std::max(span.max_mm, place);
    const vocabulary::Travel& travel = *machine_.travel.at(axis);
    const float room = travel.max_mm - travel.min_mm;
    if (span.max_mm - span.min_mm <= room + kToleranceMm || has_axis(told_, axis)) continue;
    told_ = static_cast<AxisMask>(told_ | axis_bit(axis));
    findings.add(FindingKind::LargerThanMachine, move.line.number, move.line.text, [&] {
      const float zero = move.work_offset_mm.at(axis);
      return "Up to here it needs " + place_on(axis, span.min_mm - zero) + " to " + short_mm(span.max_mm - zero) +
             ", which is " + short_mm(span.max_mm - span.min_mm) + " mm; the axis has " + short_mm(room) + ".";
    });
  }
}

/// The circle goes nowhere where the program has not been.
bool TravelRule::is_within_spans(const CheckedMove& move) const {
  const auto plane = gcode::axes_of(move.arc->plane);
  const float radius = std::hypot(move.arc->center_offset_mm[0], move.arc->center_offset_mm[1]);
  const auto is_within = [&](std::size_t axis, std::size_t which) {
    const float center = move.from_mm.at(axis) + move.arc->center_offset_mm.at(which);
    return center - radius >= spans_.at(axis).min_mm && center + radius <= spans_.at(axis).max_mm;
  };
  return is_within(plane.first, 0) && is_within(plane.second, 1);
}

void TravelRule::check_span(const CheckedMove& move, Findings& findings) {
  if (move.frame != frame_) spans_ = {};
  frame_ = move.frame;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    // Here a place becomes known: what was before cannot be compared with it.
    const bool is_new = has_axis(move.known_to, axis) && !has_axis(move.known_from, axis);
    if (is_new && !has_axis(move.lost_from, axis)) spans_.at(axis) = {};
  }
  const auto axes = static_cast<AxisMask>(measured_ & ~move.lost_to);
  extend(move, move.to_mm, axes, findings);
  if (move.arc == nullptr || is_within_spans(move)) return;
  for (const AxisValues& place : motion::extremes_of(motion::arc_of(*move.arc, move.from_mm))) {
    extend(move, place, static_cast<AxisMask>(axes & ~move.lost_from), findings);
  }
}

void TravelRule::on_move(const CheckedMove& move, Findings& findings) {
  if (guarded_ != 0) check_place(move, guarded_, FindingKind::SoftLimit, findings);
  if (watched_ != 0) check_place(move, watched_, FindingKind::BeyondTravel, findings);
  if (measured_ != 0) check_span(move, findings);
}

}  // namespace kerf::rehearsal
