#include "firmware/backlash.hpp"

#include <utility>

namespace kerf::firmware {

std::optional<vocabulary::AxisValues> Backlash::turn_to(const vocabulary::AxisValues& target_mm,
                                                        const vocabulary::AxisValues& play_mm) {
  vocabulary::AxisValues take_up = std::exchange(at_mm_, target_mm);
  const vocabulary::AxisValues from = take_up;
  bool turns = false;
  for (std::size_t axis = 0; axis < take_up.size(); ++axis) {
    if (!(play_mm.at(axis) > 0.0F) || target_mm.at(axis) == from.at(axis)) continue;
    const bool up = target_mm.at(axis) > from.at(axis);
    const Direction direction = up ? Direction::Positive : Direction::Negative;
    if (std::exchange(directions_.at(axis), direction) == direction) continue;
    take_up.at(axis) += up ? play_mm.at(axis) : -play_mm.at(axis);
    turns = true;
  }
  if (!turns) return std::nullopt;
  return take_up;
}

void Backlash::forget(const vocabulary::AxisValues& at_mm) {
  at_mm_ = at_mm;
  directions_ = {};
}

}  // namespace kerf::firmware
