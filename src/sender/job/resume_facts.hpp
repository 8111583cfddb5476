#pragma once
// What a plan to resume starts from, taken from the journal and from the machine as it is.

#include "sender/job/journal.hpp"
#include "sender/job/program.hpp"
#include "sender/job/program_start.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::job {

/// Facts about an interrupted job. `file_start` is the machine before the first line of the file: that of this job, or
/// of the first of those that it continues. `file` is the whole file.
[[nodiscard]] ResumeFacts facts_of_job(const JobHistory& job, const MachineAtStart& file_start, const Program& file,
                                       const machine::Snapshot& now, const machine::Capabilities& capabilities);

/// Facts for a program that begins in its middle although nobody knows an earlier job: it is read as if it began now.
[[nodiscard]] ResumeFacts facts_of_present(const machine::Snapshot& now, const machine::Capabilities& capabilities);

/// Lines of `file` that a controller with so many planner blocks may still be executing when `acknowledged` was
/// answered last and `sent` was sent last: behind it at most so many lines with motion can wait.
[[nodiscard]] ExecutingLines executing_by_planner(const Program& file, const ProgramStart& start,
                                                  std::uint32_t acknowledged, std::uint32_t sent, int planner_blocks);

}  // namespace kerf::job
