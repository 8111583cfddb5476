#pragma once
// Where the lines of a job come from, and how they are made ready for this controller.

#include <cstdint>
#include <memory>

#include "common/vocabulary/dialect.hpp"
#include "sender/job/program.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/features.hpp"
#include "sender/session/job_options.hpp"
#include "sender/streaming/line_source.hpp"

namespace kerf::session {

/// The program of one job, its form on this wire, and its flow, which the job shares.
class JobFeed {
 public:
  JobFeed(std::shared_ptr<const job::Program> program, const vocabulary::Dialect& dialect,
          const machine::ToolChangeFact& tools, const JobOptions& options);

  /// The lines from `first_line` on.
  [[nodiscard]] std::unique_ptr<streaming::LineSource> lines_from(std::uint32_t first_line) const;
  [[nodiscard]] const std::shared_ptr<job::ProgramFlow>& flow() const { return flow_; }
  [[nodiscard]] const job::WireForm& form() const { return form_; }

 private:
  std::shared_ptr<const job::Program> program_;
  job::WireForm form_;
  std::shared_ptr<job::ProgramFlow> flow_;
};

}  // namespace kerf::session
