#pragma once
// One line of G-code in, the machine's actions or the firmware's error code out.

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/action.hpp"
#include "common/gcode/flow.hpp"
#include "common/gcode/interpreter_settings.hpp"
#include "common/gcode/machine_facts.hpp"
#include "common/gcode/offsets.hpp"
#include "common/gcode/parameters.hpp"
#include "common/gcode/parser_state.hpp"
#include "common/gcode/rules.hpp"
#include "common/vocabulary/errors.hpp"

namespace kerf::gcode {

using vocabulary::ErrorCode;

struct BlockContext;

/// Executes lines in the order and with the arithmetic of one firmware. A rejected line changes nothing, except for
/// what the firmware itself lets slip (GcodeRules::tool_word_acts_at_once). Pure: no clock, no I/O; soft limits and
/// machine states are the owner's affair.
class Interpreter {
 public:
  explicit Interpreter(const GcodeRules& rules, InterpreterSettings settings = {});

  /// One complete line as LineReader delivers it, `$` lines excluded. Appends to `out`; of a rejected line the
  /// owner carries out nothing but what it says.
  std::expected<void, ErrorCode> interpret(std::string_view line, std::vector<Action>& out);

  /// The text after `$J=`. Changes no state: the owner checks the travel, then calls sync_position with the target.
  std::expected<JogMove, ErrorCode> interpret_jog(std::string_view after_dollar_j);

  /// grblHAL's 0x19: as reset(), but the selected work offset and the kind of tool length offset stay.
  void stop();
  /// Soft reset: modal state, tool and offsets as this firmware clears them (protocol.md 1.2); the position stays.
  void reset();

  /// Machine position after a stop, a probe, homing or a jog.
  void sync_position(const AxisValues& mm);

  /// The waiting M6 is done (cycle start) or given up (reset, failed line).
  void complete_tool_change();
  void abort_tool_change();
  /// A tool was measured: G43.1 with this length on one axis.
  void set_tool_length(std::size_t axis, float mm);

  /// A coolant toggle by realtime byte shows in the modal state too.
  void set_coolant(const Coolant& coolant) { state_.modal.coolant = coolant; }
  /// M5 and S0, after a spindle setting was changed (Rabbit).
  void stop_spindle();

  /// What parameters may ask of the machine; it must outlive the interpreter.
  void watch(MachineFacts& machine) { machine_ = &machine; }
  /// A parameter as `$#=5` and `$#=_x` print it; nothing if there is none.
  [[nodiscard]] std::optional<float> parameter(std::uint16_t id);
  [[nodiscard]] std::optional<float> parameter(std::string_view name);

  /// Where the file that is run is read on after an O word; asked for once.
  [[nodiscard]] std::optional<FilePlace> take_file_jump() { return flow_.take_jump(); }

  /// Work offset, G92 and tool length together: machine position minus this is the work position.
  [[nodiscard]] AxisValues work_coordinate_offset() const;

  [[nodiscard]] const ParserState& state() const { return state_; }
  [[nodiscard]] const Offsets& offsets() const { return offsets_; }
  /// Whoever writes here (stored values at power-up, `$RST=#`, a probe result) calls reload_offsets afterwards.
  [[nodiscard]] Offsets& offsets() { return offsets_; }
  void reload_offsets();
  [[nodiscard]] const GcodeRules& rules() const { return *rules_; }
  [[nodiscard]] InterpreterSettings& settings() { return settings_; }
  [[nodiscard]] const InterpreterSettings& settings() const { return settings_; }

 private:
  [[nodiscard]] BlockContext context_for(std::vector<Action>& out);
  /// What grblHAL forgets when any line fails.
  void fail();

  const GcodeRules* rules_;
  InterpreterSettings settings_;
  ParserState state_;
  Offsets offsets_;
  Parameters parameters_;
  FlowControl flow_;
  MachineFacts* machine_ = nullptr;
};

}  // namespace kerf::gcode
