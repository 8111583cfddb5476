#pragma once
// Coordinate data that outlives blocks: what `$#` prints and what non-volatile storage keeps.

#include <array>
#include <cstddef>
#include <vector>

#include "common/gcode/action.hpp"

namespace kerf::gcode {

inline constexpr std::size_t kMaxWorkOffsets = 9;

/// One entry of grblHAL's tool table.
struct Tool {
  AxisValues length_mm{};
  float radius_mm = 0.0F;
  bool operator==(const Tool&) const = default;
};

/// All values in mm. Which of them survive a reset is the firmware's affair (protocol.md 1.2).
struct Offsets {
  /// G54 to G59, then grblHAL's G59.1 to G59.3.
  std::array<AxisValues, kMaxWorkOffsets> work{};
  AxisValues g28{};
  AxisValues g30{};
  AxisValues g92{};
  /// grblHAL: what G92.3 and power-up bring back; G92.2 clears `g92` only.
  AxisValues g92_stored{};
  /// Grbl and Rabbit use Z only.
  AxisValues tool_length{};
  /// The tool table: entry 0 is for tools that have none, and lives until power-off only. Empty where there is no
  /// table.
  std::vector<Tool> tools;
  /// Machine position of the last probe contact, and whether there was one.
  AxisValues probe{};
  bool probe_succeeded = false;
  /// The work offset in force at that contact.
  std::uint8_t probe_work_offset = 0;

  bool operator==(const Offsets&) const = default;
};

}  // namespace kerf::gcode
