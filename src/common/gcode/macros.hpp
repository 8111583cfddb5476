#pragma once
// The macros that grblHAL has built in, and how G65, G66 and M98 call them (grblHAL core ngc_params.c). There are no
// files to take others from.

#include "common/gcode/block.hpp"

namespace kerf::gcode {

/// Begins a call and gives it its words as #1 to #26; false if calls are nested too deeply.
[[nodiscard]] bool begin_macro(const MacroRequest& macro, BlockContext& context);
/// Runs the macro and ends its call.
[[nodiscard]] ErrorCode finish_macro(const MacroRequest& macro, BlockContext& context);
/// Both.
[[nodiscard]] ErrorCode call_macro(const MacroRequest& macro, BlockContext& context);

}  // namespace kerf::gcode
