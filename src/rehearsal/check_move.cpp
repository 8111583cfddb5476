#include "rehearsal/check_move.hpp"

#include <cmath>

#include "sender/machine/explanation_evidence.hpp"

namespace kerf::rehearsal {
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
