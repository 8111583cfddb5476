#pragma once

#include <cstdint>
#include <optional>

#include "common/vocabulary/axis.hpp"

namespace kerf::gcode {

/// User inputs and outputs of the machine (grblHAL).
struct PortCounts {
  int digital_inputs = 0;
  int digital_outputs = 0;
  int analog_inputs = 0;
  int analog_outputs = 0;
  bool operator==(const PortCounts&) const = default;
};

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
  /// grblHAL `$32`=2: G7, G8, G96 and G97 exist.
  bool lathe_mode = false;
  /// grblHAL `$30`, what G96 without D allows.
  float spindle_rpm_max = 0.0F;
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
  /// Without any M62 to M68 do not exist.
  PortCounts ports{};
  /// The spindle has an encoder: G33, G76 and G95 exist.
  bool spindle_encoder = false;
  /// grblHAL `$31`, what G76 wants at least.
  float spindle_rpm_min = 0.0F;
  /// grblHAL `$28`.
  float g73_retract_mm = 0.1F;
  /// `$13`: grblHAL's parameters tell positions in other units then.
  bool report_inches = false;
  /// grblHAL `$534`: `(debug,...)` is printed.
  bool prints_debug = false;
  /// grblHAL: the line of the file that is run, for blocks without N; 0 while none is.
  std::int32_t file_line = 0;
  /// grblHAL: where that file is read on behind this line; nothing while none is.
  std::optional<std::uint64_t> file_position{};
};

}  // namespace kerf::gcode
