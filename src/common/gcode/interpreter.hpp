#pragma once
// One line of G-code in, the machine's actions or the firmware's error code out.

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/action.hpp"
#include "common/gcode/offsets.hpp"
#include "common/gcode/parser_state.hpp"
#include "common/gcode/rules.hpp"
#include "common/vocabulary/errors.hpp"

namespace kerf::gcode {

using vocabulary::ErrorCode;

/// What the interpreter must know of the machine's settings and state.
struct InterpreterSettings {
  /// Axes of the machine, from X on.
  int axes = 3;
  /// `$32`=1 where the spindle can do it.
  bool laser_mode = false;
  /// State Check: Grbl then leaves the stored offset alone at M2 and M30.
  bool check_mode = false;
  /// grblHAL: `$B` or its pin; lines that begin with `/` are then skipped.
  bool block_delete = false;
  /// grblHAL: 0x88, `$O` or its pin switched optional stops off, so M1 does nothing.
  bool optional_stop_disabled = false;
  /// grblHAL `$341`=4: M6 answers ok and nothing happens.
  bool ignore_tool_change = false;
  /// grblHAL `$384`: G92 is not stored.
  bool g92_volatile = false;
  /// grblHAL `$60`: overrides go back to 100 % at program end.
  bool restore_overrides_at_end = false;
  /// grblHAL `$486`, bit n: G59.n+1 may not be changed.
  unsigned locked_work_offsets = 0;
  /// grblHAL: tools in the table; without one G43 and G43.2 do not exist.
  int tools = 0;
  /// grblHAL `$376`: bit n set where axis n turns; G20 leaves it alone.
  vocabulary::AxisMask rotary_axes = 0;
  /// grblHAL `$41` bit 2: M56 exists.
  bool parking_override_control = false;
  /// grblHAL `$28`.
  float g73_retract_mm = 0.1F;
  /// grblHAL: the line of the file that is run, for blocks without N; 0 while none is.
  std::int32_t file_line = 0;
};

/// Executes lines in the order and with the arithmetic of one firmware. A rejected line changes nothing, except for
/// what the firmware itself lets slip (GcodeRules::tool_word_acts_at_once). Pure: no clock, no I/O; soft limits and
/// machine states are the owner's affair.
class Interpreter {
 public:
  explicit Interpreter(const GcodeRules& rules, InterpreterSettings settings = {});

  /// One complete line as LineReader delivers it, `$` lines excluded. Appends to `out`, which is left alone when the
  /// line is rejected.
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

  /// A coolant toggle by realtime byte shows in the modal state too.
  void set_coolant(const Coolant& coolant) { state_.modal.coolant = coolant; }
  /// M5 and S0, after a spindle setting was changed (Rabbit).
  void stop_spindle();

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
  /// What grblHAL forgets when any line fails.
  void fail();

  const GcodeRules* rules_;
  InterpreterSettings settings_;
  ParserState state_;
  Offsets offsets_;
};

}  // namespace kerf::gcode
