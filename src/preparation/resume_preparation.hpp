#pragma once
// From a machine that was found to a job that goes on in the middle of its program: home, plan, rehearse, show, ask.

#include <memory>
#include <optional>
#include <string>

#include "io/program_file.hpp"
#include "preparation/job_preparation.hpp"
#include "sender/job/journal.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::preparation {

/// An interrupted job, as its journal has it.
struct InterruptedWork {
  std::int64_t number = 0;
  /// Its address, as it was given.
  std::string machine{};
  job::JobHistory history;
  /// Of the first of the jobs that it continues.
  job::MachineAtStart file_start;
};

struct ResumeWish {
  io::ProgramFile file;
  std::string path;
  /// Empty: the program begins at a line, and nobody knows an earlier job.
  std::optional<InterruptedWork> work{};
  job::ResumeChoice choice;
  bool dry_run = false;
  bool says_yes = false;
};

[[nodiscard]] std::unique_ptr<JobPreparation> prepare_resume(ResumeWish wish);

}  // namespace kerf::preparation
