#pragma once
// The words of `[GC:...]`, from the state that they report (protocol.md 4.2).

#include <string>

#include "common/gcode/parser_state.hpp"
#include "common/gcode/rules.hpp"

namespace kerf::gcode {

struct ModalWordsStyle {
  /// `$13`: F in inches a minute.
  bool inches = false;
  /// grblHAL: axes of the machine, for `G51:XY`.
  int axes = 3;
  /// grblHAL `$41` bit 2: M56 is shown.
  bool parking_override_control = false;
  /// grblHAL `$32`=2: G7 or G8 and G96 or G97 are shown.
  bool lathe = false;
};

/// Appends `G0 G54 ... S0`, without brackets, in the firmware's order and number format.
void append_modal_words(const ParserState& state, const Offsets& offsets, const GcodeRules& rules,
                        const ModalWordsStyle& style, std::string& out);

}  // namespace kerf::gcode
