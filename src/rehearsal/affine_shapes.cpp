// AffineRewriter: arcs, cycles, splines, the words that name places, and the proof.

#include <algorithm>
#include <array>
#include <cmath>

#include "rehearsal/affine_rewriter.hpp"
#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::kAxisLetters;

constexpr std::string_view kCenterLetters = "IJK";

/// An R arc of nearly half a turn: the last bits of its end decide where its centre is, or that it has none.
bool is_nearly_half_turn(const gcode::ArcMove& arc, const vocabulary::AxisValues& from_mm) {
  constexpr double kHalf = 0.99;
  const gcode::PlaneAxes axes = gcode::axes_of(arc.plane);
  const double chord =
      std::hypot(static_cast<double>(arc.target_mm.at(axes.first)) - static_cast<double>(from_mm.at(axes.first)),
                 static_cast<double>(arc.target_mm.at(axes.second)) - static_cast<double>(from_mm.at(axes.second)));
  return chord > 2.0 * kHalf * static_cast<double>(arc.radius_mm);
}

}  // namespace

void AffineRewriter::write_vector(LineText& text, const LineFacts& facts, std::string_view letters,
                                  std::array<std::size_t, 2> axes) {
  const double unit = unit_mm(facts.modal);
  ExactValues vector{};
  AxisMask named = 0;
  for (std::size_t at = 0; at < axes.size(); ++at) {
    const PlacedWord* const word = text.find(letters.at(at));
    if (word == nullptr) continue;
    vector.at(axes.at(at)) = word->value * unit;
    named |= mask_of_axis(axes.at(at));
  }
  NewWords words;
  for (std::size_t at = 0; at < axes.size(); ++at) {
    const std::size_t axis = axes.at(at);
    if (!has_axis(map_.dependents_of(named), axis)) continue;
    words.emplace_back(letters.at(at), map_.keeps_distance(axis)
                                           ? text.find(letters.at(at))->digits
                                           : length_text(map_.distance(axis, vector) / unit, unit));
  }
  put_words(text, letters, std::move(words));
}

AffineRewriter::Done AffineRewriter::rewrite_arc(LineText& text, const LineFacts& facts, std::uint32_t number) {
  const gcode::ArcMove* const arc = reading_.arc();
  if (arc == nullptr) return {};
  const PlaneMap plane = map_of_plane(map_, facts.modal.plane);
  if (!plane.keeps_circles) {
    return refuse(number,
                  "this arc would become no arc. Turn arcs into lines first: --arcs-to-lines 0.002 in front of "
                  "this transform.");
  }
  const bool clockwise = arc->clockwise != plane.turns_over;
  motion_.say(text, clockwise ? 2 : 3);
  const gcode::PlaneAxes axes = gcode::axes_of(facts.modal.plane);
  const std::string letters{kCenterLetters.at(axes.first), kCenterLetters.at(axes.second)};
  const PlacedWord* const radius = text.find('R');
  if (radius == nullptr) {
    write_vector(text, facts, letters, {axes.first, axes.second});
    return {};
  }
  const double unit = unit_mm(facts.modal);
  if (!is_nearly_half_turn(*arc, facts.from_machine_mm)) {
    if (plane.factor != 1.0) text.replace(*radius, "R" + length_text(radius->value * plane.factor, unit));
    return {};
  }
  ExactValues center{};
  center.at(axes.first) = static_cast<double>(arc->center_offset_mm[0]);
  center.at(axes.second) = static_cast<double>(arc->center_offset_mm[1]);
  std::string words;
  for (const std::size_t axis : {axes.first, axes.second}) {
    if (!words.empty()) words += ' ';
    words += kCenterLetters.at(axis) + length_text(map_.distance(axis, center) / unit, unit);
  }
  text.replace(*radius, words);
  return {};
}

AffineRewriter::Done AffineRewriter::rewrite_cycle(LineText& text, const LineFacts& facts, std::uint32_t number) {
  const std::size_t depth = gcode::axes_of(facts.modal.plane).linear;
  const double factor = map_.linear.at(depth).at(depth);
  const AxisMask alone = mask_of_axis(depth);
  if (map_.inputs_of(depth) != alone || map_.dependents_of(alone) != alone || factor <= 0) {
    return refuse(number, std::string{"it drills along "} + kAxisLetters[depth] +
                              ", and the hole would lie otherwise. Have the CAM program write plain moves.");
  }
  const double unit = unit_mm(facts.modal);
  const double moved_mm = facts.modal.incremental ? 0.0 : map_.constant.at(depth);
  const auto write = [&](char letter, double moved) {
    const PlacedWord* const word = text.find(letter);
    if (word == nullptr || (factor == 1.0 && moved == 0.0)) return;
    text.replace(*word, letter + length_text(word->value * factor + moved / unit, unit));
  };
  write(kAxisLetters[depth], moved_mm);
  write('R', moved_mm);
  write('Q', 0.0);
  return map_axes(text, facts, number, alone);
}

AffineRewriter::Done AffineRewriter::rewrite_spline(LineText& text, const LineFacts& facts, std::uint32_t number) {
  if (map_.keeps_distance(kX) && map_.keeps_distance(kY)) return {};
  for (const std::string_view letters : {std::string_view{"IJ"}, std::string_view{"PQ"}}) {
    if (text.has(letters[0]) != text.has(letters[1])) {
      return refuse(number, "the curve names only one of " + std::string{letters} + ". Name both.");
    }
    if (text.has(letters[0])) write_vector(text, facts, letters, {kX, kY});
  }
  return {};
}

AffineRewriter::Done AffineRewriter::rewrite_home(LineText& text, const LineFacts& facts, std::uint32_t number) {
  const auto gone = facts.named == 0 ? AxisMask{0xFF} : facts.named;
  const bool goes_straight =
      facts.modal.incremental && std::ranges::all_of(facts.words_mm, [](double mm) { return mm == 0; });
  Done done;
  if (facts.named != 0 && !goes_straight) {
    const AxisMask axes = map_.dependents_of(facts.named);
    if ((axes & ~facts.named) != 0) {
      return refuse(number, "the axes that G28 or G30 names go home, and others would have to. Name X and Y both.");
    }
    done = map_axes(text, facts, number);
  }
  mapped_ &= static_cast<AxisMask>(~map_.dependents_of(gone));
  return done;
}

AffineRewriter::Done AffineRewriter::rewrite_name(LineText& text, const LineFacts& facts, std::uint32_t number) {
  AxisMask changed = 0;
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (has_axis(map_.dependents_of(facts.named), axis) && !map_.keeps(axis)) changed |= mask_of_axis(axis);
  }
  if ((changed & mapped_) == 0) return {};
  if ((changed & ~mapped_) != 0) {
    return refuse(number,
                  "it gives the present place a name, and where that is the program knows for some axes only. "
                  "Name each axis in a line of its own.");
  }
  LineFacts named = facts;
  // Of another zero nothing is known but what is named.
  if (facts.use == AxisUse::NamesElsewhere) named.from.known = 0;
  return map_axes(text, named, number);
}

AffineRewriter::Done AffineRewriter::prove(const LineText& text, const LineFacts& facts, std::uint32_t number,
                                           LineQueue& out) {
  const auto read = proof_.read(text, number);
  if (!read) return refuse(number, "what it would become the controller does not take. " + read.error().reason);
  constexpr double kSame_mm = 1e-3;
  // A drilling cycle may peck once more for the last bit of a float.
  bool is_right =
      read->use == facts.use && (facts.use == AxisUse::Cycle || reading_.actions().size() == proof_.actions().size());
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    const bool is_known =
        (map_.inputs_of(axis) & ~facts.to.known) == 0 && has_axis(read->to.known, axis) && has_axis(mapped_, axis);
    if (!is_known) continue;
    is_right = is_right && std::abs(read->to.mm.at(axis) - map_.value(axis, facts.to.mm)) < kSame_mm;
  }
  const gcode::ArcMove* const meant = reading_.arc();
  const gcode::ArcMove* const got = proof_.arc();
  bool is_same_angle = true;
  if (meant != nullptr && got != nullptr) {
    const bool turns_over = map_of_plane(map_, facts.modal.plane).turns_over;
    const double want_rad = swept_rad(*meant, facts.from_machine_mm, *dialect_) * (turns_over ? -1 : 1);
    const double got_rad = swept_rad(*got, read->from_machine_mm, *dialect_);
    const double slack_rad = kSame_mm + 4 * kLengthTolerance_mm / static_cast<double>(got->radius_mm);
    is_same_angle = std::abs(want_rad - got_rad) < slack_rad;
  }
  if (is_right && !is_same_angle && is_whole_circle(facts) && is_whole_circle(*read)) {
    out.warn(number, std::string{kCircleWarning});
    return {};
  }
  if (is_right && is_same_angle) return {};
  if (!is_same_angle) return refuse(number, std::string{kFragileCircle});
  return refuse(number, "its numbers are too fine to be written down again.");
}

}  // namespace kerf::rehearsal
