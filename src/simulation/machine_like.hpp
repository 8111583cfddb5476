#pragma once
// A virtual machine with the settings of a real one.

#include "sender/machine/capabilities.hpp"
#include "simulation/case_runner.hpp"

namespace kerf::simulation {

/// Switched on at its zero, with the settings that `capabilities` tell except for locks and limits: it must be known
/// which firmware it is.
[[nodiscard]] CaseMachine machine_like(const machine::Capabilities& capabilities);

}  // namespace kerf::simulation
