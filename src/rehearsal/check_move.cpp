#include "rehearsal/check_move.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::rehearsal {
namespace {

bool is_letter(char letter) {
  return letter >= 'A' && letter <= 'Z';
}

/// Takes note of a G word by its number: G28.1 and G30.1 only remember a place.
void note_command(WordsSeen& seen, std::string_view digits) {
  constexpr int kTen = 10;
  constexpr int kMost = 1000;
  int number = 0;
  std::size_t at = 0;
  for (; at < digits.size() && base::is_digit(digits[at]); ++at) {
    number = std::min(number * kTen + (digits[at] - '0'), kMost);
  }
  const bool is_whole = at == digits.size() || digits[at] != '.';
  switch (number) {
    case 10:
    case 92: seen.sets_zero = true; break;
    case 20: seen.inches = true; break;
    case 21: seen.millimetres = true; break;
    case 28:
    case 30: seen.machine_place = seen.machine_place || is_whole; break;
    case 53: seen.machine_place = true; break;
    default: break;
  }
}

}  // namespace

AxisMask WordsSeen::axes() const {
  AxisMask mask = 0;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (has(vocabulary::kAxisLetters[axis])) mask = static_cast<AxisMask>(mask | axis_bit(axis));
  }
  return mask;
}

WordsSeen words_seen_in(std::string_view wire) {
  WordsSeen seen;
  for (std::size_t at = 0; at < wire.size(); ++at) {
    const char letter = base::to_upper(wire[at]);
    if (letter == '(') {
      // Messages for the operator are the only comments left.
      at = std::min(wire.find(')', at), wire.size() - 1);
      continue;
    }
    if (!is_letter(letter)) continue;
    seen.has_lower_case = seen.has_lower_case || letter != wire[at];
    seen.letters |= 1U << static_cast<unsigned>(letter - 'A');
    if (letter == 'G') note_command(seen, wire.substr(at + 1));
  }
  return seen;
}

bool CheckedMove::goes_sideways() const {
  if (arc != nullptr) return true;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    if (axis != kZ && std::abs(to_mm[axis] - from_mm[axis]) > kSameHeightMm) return true;
  }
  return false;
}

std::string short_mm(float mm) {
  return machine::short_number(static_cast<double>(mm));
}

std::string place_on(std::size_t axis, float mm) {
  return std::string{vocabulary::kAxisLetters[axis]} + " " + short_mm(mm);
}

MoveKind CutWatch::kind_of(const CheckedMove& move) {
  if (move.feed.rapid) {
    // Sideways at its depth it is still down; a rapid up or down ends what a feed began.
    if (std::abs(move.to_mm[kZ] - move.from_mm[kZ]) > kSameHeightMm) is_down_ = false;
    return MoveKind::Rapid;
  }
  const float up = move.to_mm[kZ] - move.from_mm[kZ];
  const bool goes_sideways = move.goes_sideways();
  const bool is_below_zero = has_axis(move.known_to, kZ) && move.to_mm[kZ] - move.work_offset_mm[kZ] < -kSameHeightMm;
  if (up < -kSameHeightMm) {
    is_down_ = true;
    if (goes_sideways) return MoveKind::Cut;
    // Above the zero it may only come near the stock: what it does next will show.
    return is_below_zero || !has_axis(move.known_to, kZ) ? MoveKind::Plunge : MoveKind::Approach;
  }
  if (!goes_sideways) {
    is_down_ = is_down_ && up <= kSameHeightMm;
    return MoveKind::Air;
  }
  return is_down_ || is_below_zero ? MoveKind::Cut : MoveKind::Air;
}

}  // namespace kerf::rehearsal
