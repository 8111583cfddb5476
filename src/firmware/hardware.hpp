#pragma once
// What a controller is built with, beyond or instead of what its firmware's reference build has.

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/gcode/interpreter_settings.hpp"

namespace kerf::firmware {

/// Zeros are what the reference build has.
struct Hardware {
  int axes = 0;   ///< 0: those of the dialect
  int tools = 0;  ///< entries of grblHAL's tool table
  gcode::PortCounts ports{};
  /// Writing to memory takes as long as on the real board.
  bool slow_memory = false;
  /// The spindle has an encoder: G33, G76, G95, speeds that are waited for (grblHAL).
  bool spindle_encoder = false;

  bool operator==(const Hardware&) const = default;
};

/// Which part of some hardware a firmware has no use for, or not so much.
enum class HardwareFault : std::uint8_t { Axes, Tools, Ports, SlowMemory, SpindleEncoder };

/// The least number of axes that any firmware is built with.
inline constexpr int kFewestAxes = 3;

/// "4,4,2,2": digital inputs and outputs, analog inputs and outputs, as `[AUX IO:]` tells them.
[[nodiscard]] std::optional<gcode::PortCounts> parse_port_counts(std::string_view text);

}  // namespace kerf::firmware
