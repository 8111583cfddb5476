#pragma once
// The machine that a program is checked for: how it reads, where it stands, and what it can do.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/motion/rules.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/travel.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"
#include "simulation/case_runner.hpp"

namespace kerf::rehearsal {

using vocabulary::AxisMask;
using vocabulary::AxisValues;
using vocabulary::kMaxAxes;

struct CheckMachine {
  const vocabulary::Dialect* dialect = nullptr;
  /// Reads as the controller does, and stands where it stands: modes, offsets, tool length, position.
  gcode::Interpreter reader{gcode::rules_for(vocabulary::Firmware::Unknown)};
  /// Its modes are those of the machine: what it refuses because of them is refused.
  bool knows_modes = true;
  /// It may have macros that nobody has told of.
  bool may_have_macros = false;
  /// Axes whose position is that of the machine; the others are somewhere.
  AxisMask known_place = 0;
  /// The offsets are those of the machine, so work coordinates can be told in machine coordinates.
  bool knows_offsets = false;
  std::array<std::optional<vocabulary::Travel>, kMaxAxes> travel{};
  /// Axes that the soft limits guard.
  AxisMask guarded_axes = 0;
  /// Machine coordinates mean something.
  bool is_homed = false;
  motion::MotionSettings motion{};
  /// `$30` and `$31`; 0 where they are not known.
  float spindle_rpm_max = 0;
  float spindle_rpm_min = 0;
  /// `$32`=1, whether or not this build can use it.
  bool is_laser = false;
  /// Somebody has said that a probe can make contact.
  bool has_probe = false;
  job::ToolChanges tool_changes = job::ToolChanges::ByOperator;
  /// grblHAL `$341`: M6 raises the tool, or measures it, and wants these axes homed first; the plane's upright axis
  /// alone where that is all.
  int tool_change_mode = 0;
  AxisMask homed_axes = 0;
  /// `$N0` and `$N1`.
  std::vector<std::string> startup_lines{};
};

/// What nobody can tell about a machine that is not there.
struct CheckPlace {
  /// Machine position of the work zero (G54).
  std::optional<std::vector<double>> zero_mm{};
  /// Machine position of the tool.
  std::optional<std::vector<double>> position_mm{};
};

/// A machine with these settings, homed if it can be.
[[nodiscard]] CheckMachine check_machine_of(const simulation::CaseMachine& machine, const CheckPlace& place = {});

/// The machine as it told itself to be.
[[nodiscard]] CheckMachine check_machine_of(const machine::Capabilities& known, const machine::Snapshot& snapshot);

}  // namespace kerf::rehearsal
