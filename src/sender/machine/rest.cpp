#include "sender/machine/rest.hpp"

namespace kerf::machine {

using vocabulary::MachineState;

bool is_at_rest(const Snapshot& snapshot) {
  switch (snapshot.state) {
    case MachineState::Hold: return snapshot.substate.value_or(vocabulary::kHoldComplete) == vocabulary::kHoldComplete;
    case MachineState::Door: {
      const int substate = snapshot.substate.value_or(vocabulary::kDoorRetracting);
      return substate == vocabulary::kDoorClosedReady || substate == vocabulary::kDoorOpen;
    }
    case MachineState::Tool:
    case MachineState::Alarm:
    case MachineState::Check:
    case MachineState::Sleep: return true;
    default: return false;
  }
}

bool can_resume(const Snapshot& snapshot) {
  switch (snapshot.state) {
    case MachineState::Hold: return snapshot.substate.value_or(vocabulary::kHoldComplete) == vocabulary::kHoldComplete;
    case MachineState::Door: return snapshot.substate == vocabulary::kDoorClosedReady;
    case MachineState::Tool: return true;
    default: return false;
  }
}

bool reads_lines(MachineState state) {
  switch (state) {
    case MachineState::Idle:
    case MachineState::Run:
    case MachineState::Jog:
    case MachineState::Alarm:
    case MachineState::Check: return true;
    default: return false;
  }
}

bool may_store_settings(const Snapshot& snapshot) {
  if (snapshot.pendant_in_control || snapshot.reset_required || !snapshot.controller_file.empty()) return false;
  return snapshot.state == MachineState::Idle || snapshot.state == MachineState::Alarm;
}

}  // namespace kerf::machine
