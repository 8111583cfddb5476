#pragma once
// What a script or a person does to a virtual controller from outside, one line a deed. For those who write scripts,
// docs/virtual_controller.md describes the language; the rows in workcell_script.cpp are its definition.
//
//   line   := [timing] [deed] ["#" comment]
//   timing := "at" TIME | "after" TIME | "when state" NAME[":" N] | "when line" N
//   deed   := "door open" | "limit X on" | "drop to next 3" | "link cut" | …
//
// A line that is wrong makes the whole script wrong, before anything happens: half a scenario would be a test that says
// nothing. Rejected: JSON (nobody types it into a socket), and jumps or loops (a script must end, and tests are
// programs already: they hold the control socket).

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "firmware/byte_faults.hpp"
#include "firmware/workcell.hpp"

namespace kerf::firmware {

/// Of the wire, one or both.
struct Directions {
  bool to_controller = false;
  bool from_controller = false;
};

enum class LinkState : std::uint8_t {
  Up,
  Silent,  ///< nothing passes, and nobody is told
  Cut,     ///< the sender is told: its port is gone, its connection closed
};

struct SetLink {
  LinkState state{};
};
struct SetPower {
  bool on = false;
};
/// The reset pin of the processor, or a brown-out: power off and on at once.
struct Reboot {};
/// The main loop stands still for a while (a flash write, a bug): it reads no line, answers nothing and obeys no
/// realtime byte until the time is over. Motion that is planned goes on.
struct Stall {
  Duration time{};
};
/// A button is pressed and released.
struct PressButton {
  Input input{};
};
/// The pendant takes command over, or gives it back; nothing if it has it already, or has not.
struct PendantTakes {
  bool command = false;
};
/// Bytes from the pendant.
struct PendantSays {
  std::string bytes;
};
struct OrderByteFault {
  Directions directions;
  ByteFaultOrder order;
};
struct EndByteFaults {};
struct SeedChance {
  std::uint64_t seed = 0;
};
/// Bytes that nobody sent: noise, another sender, a boot loader.
struct InjectBytes {
  Directions directions;
  std::string bytes;
};
/// Nothing but an entry in the log.
struct WriteNote {
  std::string text;
};

using Deed = std::variant<WorkcellEvent, PressButton, SetLink, SetPower, Reboot, Stall, OrderByteFault, EndByteFaults,
                          SeedChance, InjectBytes, PendantTakes, PendantSays, WriteNote>;

/// So long after the controller was switched on first.
struct AtTime {
  Duration time{};
};
/// So long after the line before, or after this line came.
struct AfterTime {
  Duration time{};
};
/// As soon as the machine is in this state; it may be already.
struct WhenState {
  vocabulary::MachineState state{};
  std::optional<int> substate;
};
/// As soon as the controller has begun so many lines of G-code; `$` lines and empty ones do not count.
struct WhenLine {
  std::uint32_t lines = 0;
};

/// Without a timing: right after the line before.
using Timing = std::variant<AfterTime, AtTime, WhenState, WhenLine>;

/// One line. Without a deed it only waits.
struct ScriptLine {
  std::size_t number = 0;  ///< in its file, counted from 1
  std::string text;        ///< as it stands there, without comment
  Timing timing;
  std::optional<Deed> deed;
};

struct ScriptError {
  std::size_t line = 0;
  std::string what;      ///< "'dor' is no command"
  std::string accepted;  ///< what may stand there instead
};

[[nodiscard]] std::expected<std::vector<ScriptLine>, ScriptError> parse_script(std::string_view text);
/// One line; none if it says nothing.
[[nodiscard]] std::expected<std::optional<ScriptLine>, ScriptError> parse_script_line(std::string_view text,
                                                                                      std::size_t number = 1);
/// The event of a deed that only moves a part of the workcell, such as `limit X on`.
[[nodiscard]] std::optional<WorkcellEvent> parse_workcell_event(std::string_view text);

/// "drop next 3: write drop to|from|both next N …", without file and line.
[[nodiscard]] std::string explain(const ScriptError& error);
/// One line for each command: how it is written.
[[nodiscard]] std::vector<std::string_view> script_usage();

}  // namespace kerf::firmware
