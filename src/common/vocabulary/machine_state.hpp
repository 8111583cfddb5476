#pragma once
// The states that a status report names, and what their substates mean on each firmware (protocol.md 3.2).

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// First word of a status report. `Unknown` is also what we believe before the first report.
enum class MachineState : std::uint8_t { Unknown, Idle, Run, Hold, Jog, Home, Alarm, Check, Door, Sleep, Tool };
BOOST_DESCRIBE_ENUM(MachineState, Unknown, Idle, Run, Hold, Jog, Home, Alarm, Check, Door, Sleep, Tool)

/// The word on the wire; "Unknown" for `Unknown`.
[[nodiscard]] std::string_view name_of(MachineState state);
/// The state that `name` spells exactly.
[[nodiscard]] std::optional<MachineState> machine_state_of(std::string_view name);

struct MachineStateRow {
  MachineState state{};
  std::string_view name;   ///< as on the wire
  std::string_view title;  ///< for people
  std::string_view text;   ///< what the machine does and what gets it out of there
  FirmwareSet known_to{};
  FirmwareSet reads_lines{};  ///< who reads and answers lines in this state (protocol.md 6.6)
  friend constexpr bool operator==(const MachineStateRow&, const MachineStateRow&) = default;
};
BOOST_DESCRIBE_STRUCT(MachineStateRow, (), (state, name, title, text, known_to, reads_lines))

/// All states but `Unknown`, in enumerator order.
[[nodiscard]] std::span<const MachineStateRow> machine_state_rows();

/// A number behind the state's colon, except in Alarm, where it is the alarm's code.
struct SubstateRow {
  MachineState state{};
  int substate{};
  std::string_view title;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const SubstateRow&, const SubstateRow&) = default;
};
BOOST_DESCRIBE_STRUCT(SubstateRow, (), (state, substate, title, text, known_to))

[[nodiscard]] std::span<const SubstateRow> substate_rows();

/// The meaning of `state:substate` on `firmware`; for an unknown firmware that of the first row that fits.
[[nodiscard]] const SubstateRow* find_substate(Firmware firmware, MachineState state, int substate);

// Substates that code decides on.
inline constexpr int kHoldComplete = 0;
inline constexpr int kHoldDecelerating = 1;
inline constexpr int kDoorClosedReady = 0;
inline constexpr int kDoorOpen = 1;
inline constexpr int kDoorRetracting = 2;
inline constexpr int kDoorResumingGrbl = 3;  ///< Grbl and Rabbit
inline constexpr int kDoorResumingHal = 4;   ///< grblHAL
inline constexpr int kRunHoldPending = 1;    ///< grblHAL, `$10` bit 11
inline constexpr int kRunProbing = 2;        ///< grblHAL, `$10` bit 11

}  // namespace kerf::vocabulary
