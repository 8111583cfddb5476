#pragma once
// How long a program takes, in two grades: with the planner kept full, and over a link.

#include <optional>
#include <vector>

#include "io/json.hpp"
#include "rehearsal/job_estimate.hpp"

namespace kerf::preparation {

/// What is true of the machine, and of the link to it.
struct Grades {
  rehearsal::JobEstimate planner;
  /// Only where a link was named.
  std::optional<rehearsal::JobEstimate> world{};
  std::vector<rehearsal::LostTime> losses{};
};

[[nodiscard]] Grades grades_of(const job::Program& program, const simulation::CaseMachine& machine,
                               simulation::ProgramLink link = {});

/// What `kerf estimate --json` prints.
[[nodiscard]] io::Json estimate_json(const Grades& grades);

}  // namespace kerf::preparation
