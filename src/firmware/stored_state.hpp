#pragma once
// What a controller remembers while it is switched off, as a value with a text form.
//
// The text form speaks the protocol's own words, one item a line:
//   state      = header { setting | startup | user-text | offset | tool | "" | "#" any }
//   header     = "# kerf state 1"
//   setting    = "$" id "=" value          id is a number, or a name with "/" (Rabbit GRBL)
//   startup    = "$N0=" line | "$N1=" line
//   user-text  = "$I=" text
//   offset     = "[" ( "G54".."G59" | "G59.1".."G59.3" | "G28" | "G30" | "G92" ) ":" number { "," number } "]"
//   tool       = "[T:" number "|" number { "," number } "|" number "]"
// Recovery: a file that does not parse is refused as a whole with its line, never half used; the caller decides whether
// to start blank. JSON was rejected because these lines can be pasted from and to a terminal.

#include <array>
#include <cstddef>
#include <expected>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::firmware {

/// An entry of the tool table.
struct StoredTool {
  std::vector<double> length_mm;  ///< one an axis
  double radius_mm = 0;
  friend bool operator==(const StoredTool&, const StoredTool&) = default;
};

/// Everything in the non-volatile memory. Only settings that differ from the default need to be present.
struct StoredState {
  /// False for a memory that was never written: a first boot (protocol.md 1.1: grblHAL then says `error:7` before its
  /// welcome).
  bool initialised = false;
  /// Setting id without `$` ("110", "Homing/Enable") to the value as the firmware prints it.
  std::map<std::string, std::string, std::less<>> settings{};
  /// "G54" to values in mm, one an axis, in machine coordinates.
  std::map<std::string, std::vector<double>, std::less<>> offsets;
  /// Tools that G10 L1 wrote, by number.
  std::map<int, StoredTool> tools{};
  std::array<std::string, 2> startup_lines;
  /// What `$I=` stored.
  std::string user_text;

  friend bool operator==(const StoredState&, const StoredState&) = default;
};

/// Where and why a text is no stored state.
struct StoredStateError {
  enum class Reason { NotAState, NotASetting, UnknownLine, BadNumber };
  Reason reason;
  std::size_t line;  ///< counted from 1
  friend bool operator==(const StoredStateError&, const StoredStateError&) = default;
};

/// The text form; `parse_stored_state` gives the same value back.
[[nodiscard]] std::string print(const StoredState& state);

/// Reads the text form. An empty text is a blank memory.
[[nodiscard]] std::expected<StoredState, StoredStateError> parse_stored_state(std::string_view text);

/// Reads `$n=value` lines (empty lines and lines that start with `#` or `;` are skipped) into `state.settings`, and
/// marks the memory as initialised. Values are checked by the controller when it starts. Any other line is
/// `NotASetting`, and `state` stays as it was.
[[nodiscard]] std::expected<void, StoredStateError> apply_settings_text(StoredState& state, std::string_view text);

}  // namespace kerf::firmware
