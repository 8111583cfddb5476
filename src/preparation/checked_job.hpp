#pragma once
// A job that is checked before it begins.

#include <memory>

#include "preparation/job_preparation.hpp"
#include "sender/job/program.hpp"
#include "sender/session/job_options.hpp"

namespace kerf::preparation {

struct CheckedJob {
  std::shared_ptr<const job::Program> program{};
  /// For the journal.
  job::JobOrigin origin{};
  session::JobOptions options{};
  /// It begins although lines would be refused.
  bool despite_errors = false;
};

/// Reads the program as the machine will that was found, and tells what it finds; with errors there is no job.
[[nodiscard]] std::unique_ptr<JobPreparation> prepare_checked_job(CheckedJob job);

}  // namespace kerf::preparation
