#pragma once
// Does the machine stand still, and would a cycle start make it go on?

#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

/// At rest with its position known: a reset now raises no alarm (protocol.md 1.2).
[[nodiscard]] bool is_at_rest(const Snapshot& snapshot);

/// A cycle start is obeyed: Hold:0, Door:0 or Tool. In Hold:1 it is lost (protocol.md 2).
[[nodiscard]] bool can_resume(const Snapshot& snapshot);

/// Lines are read and answered (protocol.md 6.6), as far as the state tells: a critical alarm may still be silent.
[[nodiscard]] bool reads_lines(vocabulary::MachineState state);

/// A setting may be written: Idle, or an alarm in which lines are answered, and nobody else has the machine
/// (protocol.md 6.7).
[[nodiscard]] bool may_store_settings(const Snapshot& snapshot);

}  // namespace kerf::machine
