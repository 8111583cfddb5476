#pragma once
// What a controller's G-code reader and its motion go by, taken from what it told about itself.

#include "common/gcode/interpreter_settings.hpp"
#include "common/motion/rules.hpp"
#include "sender/machine/capabilities.hpp"

namespace kerf::machine {

/// Settings and equipment that decide how this controller reads a line. What it did not tell is as at the factory.
[[nodiscard]] gcode::InterpreterSettings interpreter_settings_of(const Capabilities& known);

/// Settings that decide how it moves. Values that it did not tell are 0, except for the arc tolerance.
[[nodiscard]] motion::MotionSettings motion_settings_of(const Capabilities& known);

}  // namespace kerf::machine
