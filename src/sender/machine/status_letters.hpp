#pragma once
// Letters and words of reports, by name.

#include <string>
#include <string_view>
#include <vector>

#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

/// `Pn:XPD`. The letters mean the same on all firmwares, as far as they have them (protocol.md 3.3).
[[nodiscard]] Inputs inputs_of(std::string_view letters);

/// `A:SF`.
[[nodiscard]] Accessories accessories_of(std::string_view letters);

/// `[GC:G0 G54 G17 ...]`; F is multiplied by `mm_per_unit`, because it comes in the units of `$13` (protocol.md 4.2).
[[nodiscard]] ParserModes modes_of(const std::vector<std::string>& words, double mm_per_unit);

/// What `line` may change once it is executed.
struct LineEffect {
  bool parser_state = false;
  bool offsets = false;
};
/// G-code may always change modes; offsets are changed by a few words and `$` lines only. Cheap: jobs ask it for every
/// line.
[[nodiscard]] LineEffect effect_of(std::string_view line);

/// The state in which the controller waits for the operator after it has said `text`; Unknown if it does not wait.
[[nodiscard]] vocabulary::MachineState waits_in(vocabulary::FeedbackText text);

}  // namespace kerf::machine
