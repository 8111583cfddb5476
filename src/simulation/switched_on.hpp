#pragma once
// A controller as the recordings of real firmware begin.

#include <string_view>

#include "firmware/virtual_controller.hpp"

namespace kerf::simulation {

/// Switches `controller` on and drops what it says. The recorded machines were told their settings when they were on
/// already, so `$22` did not lock them: what locks at power-up is unlocked.
/// `told` are lines that would mean something else in its memory.
inline void switch_on(firmware::VirtualController& controller, Instant now, std::string_view told) {
  constexpr std::string_view kUnlock = "$X\n";
  controller.power_on(now);
  controller.advance_to(now);
  if (controller.state() == vocabulary::MachineState::Alarm) {
    controller.on_bytes(now, kUnlock);
    controller.advance_to(now);
  }
  if (!told.empty()) {
    controller.on_bytes(now, told);
    controller.advance_to(now);
  }
  static_cast<void>(controller.take_outbox());
}

}  // namespace kerf::simulation
