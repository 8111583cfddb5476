#pragma once
// The `$` commands: one handler each, which says things, changes the board, or leaves steps to do.

#include <expected>
#include <string_view>

#include "firmware/board.hpp"
#include "firmware/card_commands.hpp"
#include "firmware/listing.hpp"
#include "firmware/reporter.hpp"
#include "firmware/step.hpp"
#include "firmware/tool_change.hpp"

namespace kerf::firmware {

/// Executes `$` lines. The steps that it appends end in the line's answer, and a reset may follow that.
class SystemCommands {
 public:
  SystemCommands(Board& board, Reporter& reporter, ToolChange& tool_change)
      : board_(board), reporter_(reporter), tool_change_(tool_change), listing_(board), card_commands_(board) {}

  /// `line` without its `$`, but with it where lines may begin with `[` as well. An error leaves `steps` alone.
  std::expected<void, ErrorCode> execute(std::string_view line, Steps& steps);

 private:
  using Result = std::expected<void, ErrorCode>;

  Result understand(std::string_view line, Steps& steps);
  Result dispatch(const ParsedCommand& command, Steps& steps);
  Result dispatch_listing(const ParsedCommand& command);
  Result tell_parameter(std::string_view text);
  Result describe_setting(const ParsedCommand& command);
  Result read_setting(const ParsedCommand& command);
  Result write_setting(const ParsedCommand& command, Steps& steps);
  // Rabbit's.
  Result read_named_setting(const ParsedCommand& command);
  Result release_motors(const ParsedCommand& command);
  [[nodiscard]] Result may_write(const ParsedCommand& command) const;
  /// A new value of most spindle settings stops the spindle and forgets its speed.
  void restart_spindle_after(const ParsedCommand& command, Steps& steps);
  Result check_mode(Steps& steps);
  Result unlock();
  Result home(const ParsedCommand& command, Steps& steps);
  Result jog(const ParsedCommand& command, Steps& steps);
  Result store_user_text(const ParsedCommand& command);
  Result store_startup_line(const ParsedCommand& command, Steps& steps);
  Result restore(const ParsedCommand& command, Steps& steps);
  Result sleep(Steps& steps);
  Result toggle(Command command);
  Result list_codes(const ParsedCommand& command);
  Result set_tool_reference();
  Result probe_tool_plate(Steps& steps);
  /// What forbids `$X`, or homing (grblHAL system.c check_status).
  [[nodiscard]] std::optional<ErrorCode> lock_reason(bool homing) const;

  Board& board_;
  Reporter& reporter_;
  ToolChange& tool_change_;
  Listing listing_;
  CardCommands card_commands_;
};

/// True while `$22` bit 2 demands homing first (grblHAL machine_limits.c limits_homing_required).
[[nodiscard]] bool homing_is_required(const Board& board);

// Named policies for Personality::parse_command.
std::expected<ParsedCommand, ErrorCode> parse_command_grbl(const Personality& personality, std::string_view line,
                                                           MachineState state, bool critical);
std::expected<ParsedCommand, ErrorCode> parse_command_rabbit(const Personality& personality, std::string_view line,
                                                             MachineState state, bool critical);
std::expected<ParsedCommand, ErrorCode> parse_command_grblhal(const Personality& personality, std::string_view line,
                                                              MachineState state, bool critical);

}  // namespace kerf::firmware
