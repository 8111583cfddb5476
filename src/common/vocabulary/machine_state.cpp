#include "common/vocabulary/machine_state.hpp"

#include <algorithm>
#include <array>

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kNone = FirmwareSet::None;
constexpr auto kGrblAndRabbit = FirmwareSet::Grbl | FirmwareSet::Rabbit;

constexpr std::array kStates{
    MachineStateRow{MachineState::Idle, "Idle", "idle", "Nothing moves. Also shown during a dwell.", kAll, kAll},
    MachineStateRow{MachineState::Run, "Run", "running", "A program or a single line moves the machine.", kAll, kAll},
    MachineStateRow{MachineState::Hold, "Hold", "on hold",
                    "Stopped, or stopping, with the plan kept. Cycle start goes on, reset gives up.", kAll, kNone},
    MachineStateRow{MachineState::Jog, "Jog", "jogging", "Moved by hand. Only jogs and queries are accepted.", kAll,
                    kAll},
    MachineStateRow{MachineState::Home, "Home", "homing", "Looking for the limit switches. Only a reset stops it.",
                    kAll, kNone},
    MachineStateRow{MachineState::Alarm, "Alarm", "in alarm",
                    "Motion is locked. Unlock with $X or home with $H, after a reset if the alarm is critical.", kAll,
                    kAll},
    MachineStateRow{MachineState::Check, "Check", "checking",
                    "G-code is read and checked but nothing moves. $C leaves with a reset.", kAll, kAll},
    MachineStateRow{MachineState::Door, "Door", "safety door",
                    "The safety door is or was open: spindle and coolant are off. Close it, then cycle start.", kAll,
                    kNone},
    MachineStateRow{MachineState::Sleep, "Sleep", "asleep", "Motors are off. Only a reset wakes it, into Alarm.", kAll,
                    kHal},
    MachineStateRow{MachineState::Tool, "Tool", "waiting for a tool", "Change the tool, then cycle start.", kHal,
                    kNone},
};

constexpr std::array kSubstates{
    SubstateRow{MachineState::Run, kRunHoldPending, "hold pending",
                "A feed hold waits for a block that may not be held.", kHal},
    SubstateRow{MachineState::Run, kRunProbing, "probing", "A probing cycle moves.", kHal},
    SubstateRow{MachineState::Hold, kHoldComplete, "stopped", "Cycle start resumes.", kAll},
    SubstateRow{MachineState::Hold, kHoldDecelerating, "braking", "Still moving; cycle start would be lost.", kAll},
    SubstateRow{MachineState::Door, kDoorClosedReady, "closed", "Cycle start resumes.", kAll},
    SubstateRow{MachineState::Door, kDoorOpen, "open", "Close the door to go on.", kAll},
    SubstateRow{MachineState::Door, kDoorRetracting, "retracting", "Braking, or moving to the parking position.", kAll},
    SubstateRow{MachineState::Door, kDoorResumingGrbl, "resuming", "Spindle and coolant come back, then motion.",
                kGrblAndRabbit},
    SubstateRow{MachineState::Door, kDoorResumingHal, "resuming", "Spindle and coolant come back, then motion.", kHal},
};

}  // namespace

std::string_view name_of(MachineState state) {
  const auto at = std::ranges::find(kStates, state, &MachineStateRow::state);
  return at == kStates.end() ? "Unknown" : at->name;
}

std::optional<MachineState> machine_state_of(std::string_view name) {
  const auto at = std::ranges::find(kStates, name, &MachineStateRow::name);
  if (at == kStates.end()) return std::nullopt;
  return at->state;
}

std::span<const MachineStateRow> machine_state_rows() {
  return kStates;
}

std::span<const SubstateRow> substate_rows() {
  return kSubstates;
}

const SubstateRow* find_substate(Firmware firmware, MachineState state, int substate) {
  const auto fits = [&](const SubstateRow& row) {
    const bool is_known = firmware == Firmware::Unknown || contains(row.known_to, firmware);
    return row.state == state && row.substate == substate && is_known;
  };
  const auto at = std::ranges::find_if(kSubstates, fits);
  return at == kSubstates.end() ? nullptr : &*at;
}

}  // namespace kerf::vocabulary
