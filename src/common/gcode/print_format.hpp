#pragma once
// `(print,...)`, `(debug,...)` and `(abort,...)`: texts in which `#5` and `#<name>` become values.

#include <string>
#include <string_view>

#include "common/gcode/parameter_values.hpp"
#include "common/gcode/rules.hpp"

namespace kerf::gcode {

/// `%d`, `%f` and `%.3f` say how the values after them are printed; what cannot be read becomes `N/A` (grblHAL core
/// ngc_expr.c).
[[nodiscard]] std::string substitute_parameters(std::string_view text, const GcodeRules& rules,
                                                const ParameterValues& values);

/// A value as `$#=` prints it: without zeros at the end.
[[nodiscard]] std::string trimmed_number(float value, int decimals);
/// Places that parameters are printed with unless a format says otherwise.
[[nodiscard]] int parameter_decimals(const InterpreterSettings& settings);

}  // namespace kerf::gcode
