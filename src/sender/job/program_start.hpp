#pragma once
// The machine before the first line of a program, as its own interpreter would know it.

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/job/journal.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// Everything from which the reading of a program begins.
struct ProgramStart {
  const vocabulary::Dialect* dialect = nullptr;
  gcode::InterpreterSettings settings{};
  gcode::Offsets offsets{};
  vocabulary::AxisValues position_mm{};
  machine::ParserModes modes{};
  std::vector<std::string> parser_words{};
  int tool = 0;
};

/// What is missing is a sentence.
struct StartUnknown {
  std::string what;
};

/// The machine as a snapshot has it, in the form in which the journal keeps it.
[[nodiscard]] MachineAtStart present_machine(const machine::Snapshot& now, const machine::Capabilities& capabilities);

/// Fails with what is not known: position, modes, offsets. `settings` as machine::interpreter_settings_of() has them.
[[nodiscard]] std::expected<ProgramStart, StartUnknown> program_start_of(const MachineAtStart& machine,
                                                                         const gcode::InterpreterSettings& settings);

/// A machine at rest in these modes, with these offsets, at this place; nothing if its own interpreter refuses them.
[[nodiscard]] std::optional<gcode::Interpreter> interpreter_at(const ProgramStart& start);

/// Row of `$#` for each work offset, in the order of gcode::Offsets.
[[nodiscard]] std::string_view work_offset_name(std::size_t index);

}  // namespace kerf::job
