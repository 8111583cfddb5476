#pragma once
// Every parameter that can be read: those that programs write, and those that tell about interpreter and machine
// (grblHAL core ngc_params.c).

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/gcode/interpreter_settings.hpp"
#include "common/gcode/machine_facts.hpp"
#include "common/gcode/offsets.hpp"
#include "common/gcode/parameters.hpp"
#include "common/gcode/parser_state.hpp"

namespace kerf::gcode {

/// Looks at one interpreter; lives no longer than a line. `machine` may be null.
struct ParameterValues {
  Parameters& written;
  ParserState& state;
  const Offsets& offsets;
  const InterpreterSettings& settings;
  const MachineFacts* machine = nullptr;

  /// Nothing for numbers that do not exist.
  [[nodiscard]] std::optional<float> get(std::uint16_t id) const;
  /// Any spelling of the name; nothing for unknown ones.
  [[nodiscard]] std::optional<float> get(std::string_view name) const;
  /// Writing to a name that the firmware defines is accepted and does nothing. False if the name is none.
  bool set(std::string_view name, float value) const;

  [[nodiscard]] AxisValues machine_position_mm() const {
    return machine != nullptr ? machine->position_mm() : state.position_mm;
  }
};

}  // namespace kerf::gcode
