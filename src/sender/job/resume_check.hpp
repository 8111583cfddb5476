#pragma once
// A plan to resume, read by the controller's own interpreter before anybody sees it: does it restore what the program
// left, does the rest of the program then do the same, and is the way there safe?

#include <cstddef>
#include <optional>
#include <string>

#include "sender/job/program_state.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::job {

/// A row of `$#` that is not what the program left.
struct OffsetDifference {
  std::string name;
  std::string then;
  std::string now;
};

/// The first difference that matters. What a reset wipes and the plan brings back (G92, the tool length) may be zero
/// now.
[[nodiscard]] std::optional<OffsetDifference> first_difference(const gcode::Offsets& then, const gcode::Offsets& now,
                                                               const vocabulary::Dialect& dialect, std::size_t axes);

struct PlanCheck {
  const Program& program;
  /// At the line.
  const ProgramState& state;
  const gcode::Interpreter& present;
  const vocabulary::Dialect& dialect;
  const machine::Capabilities& capabilities;
};

/// Fills `plan.path`, and says what is wrong with it.
[[nodiscard]] std::optional<ResumeRefusal> check_plan(ResumePlan& plan, const PlanCheck& with);

}  // namespace kerf::job
