#pragma once
// What has to be known of a whole program before its first line can be written again.

#include <cstdint>
#include <expected>
#include <optional>
#include <set>

#include "rehearsal/line_source.hpp"

namespace kerf::rehearsal {

struct ProgramSurvey {
  /// Modes at the first motion and behind the last line that is executed.
  std::optional<gcode::ModalState> modal_at_motion{};
  gcode::ModalState modal_at_end{};
  /// Lines that give places other names (G92, G10, G43.1, another zero), the first of them.
  std::uint32_t renaming_line = 0;
  /// A work zero was selected behind the first motion.
  std::uint32_t zero_change_line = 0;
  /// Numbers of T.
  std::set<int> tools{};
  std::uint32_t tool_change_line = 0;
  /// The first motion along X or Y comes before Z is told.
  bool begins_along_xy = false;
  std::optional<double> highest_mm{};
  std::optional<double> last_height_mm{};
};

/// Reads all lines; the source is rewound afterwards.
[[nodiscard]] std::expected<ProgramSurvey, TransformRefusal> survey_of(LineSource& source,
                                                                       const vocabulary::Dialect& dialect);

/// May the program begin again where it ended? The machine would go along X and Y before it goes up. A refusal if not.
[[nodiscard]] std::expected<void, TransformRefusal> check_repeatable(const ProgramSurvey& survey);

/// The words that bring a machine from one set of modes to another, G0 at the end.
[[nodiscard]] std::string mode_words(const gcode::ModalState& to);

}  // namespace kerf::rehearsal
