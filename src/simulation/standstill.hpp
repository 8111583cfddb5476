#pragma once
// Ends the simulation of a controller that goes round in circles.

#include <cstddef>

#include "firmware/virtual_controller.hpp"

namespace kerf::simulation {

/// Counts turns in which neither a motor stepped nor anything else came forward. A move so long that 32 bits lose its
/// segments starts again and again for ever; a turn costs a microsecond, so many of them are let pass.
class Standstill {
 public:
  /// One turn more; `progress` counts whatever else may come forward. True when the controller will never get anywhere.
  bool lasts(const firmware::VirtualController& controller, std::size_t progress) {
    if (++turns_ % kTurnsBetweenLooks != 0) return false;
    const vocabulary::AxisSteps steps = controller.position_steps();
    const bool stands = steps == steps_ && progress == progress_;
    steps_ = steps;
    progress_ = progress;
    return stands;
  }

 private:
  static constexpr std::size_t kTurnsBetweenLooks = 100'000;

  std::size_t turns_ = 0;
  vocabulary::AxisSteps steps_{};
  std::size_t progress_ = 0;
};

}  // namespace kerf::simulation
