#include "sender/session/job_feed.hpp"

#include <utility>

#include "sender/session/program_lines.hpp"

namespace kerf::session {
namespace {

using machine::ToolChangeKind;

job::WireForm form_for(const vocabulary::Dialect& dialect, const JobOptions& options) {
  job::WireForm form = job::wire_form_of(dialect);
  form.optional_stop = options.optional_stop;
  form.block_delete = options.block_delete;
  return form;
}

// A controller whose owner has set it to ignore M6 (a mode, `$341`) does as it is told; one that knows no other way
// does not change tools, whatever it answers.
job::ToolChanges changes_for(const machine::ToolChangeFact& tools) {
  const bool is_its_own_affair =
      tools.kind == ToolChangeKind::Manual || tools.kind == ToolChangeKind::Changer || !tools.mode.empty();
  return is_its_own_affair ? job::ToolChanges::ByController : job::ToolChanges::ByOperator;
}

}  // namespace

JobFeed::JobFeed(std::shared_ptr<const job::Program> program, const vocabulary::Dialect& dialect,
                 const machine::ToolChangeFact& tools, const JobOptions& options)
    : program_(std::move(program)),
      form_(form_for(dialect, options)),
      flow_(std::make_shared<job::ProgramFlow>(changes_for(tools), !form_.keeps_messages)) {}

std::unique_ptr<streaming::LineSource> JobFeed::lines_from(std::uint32_t first_line) const {
  return std::make_unique<ProgramLines>(program_, form_, flow_, first_line);
}

}  // namespace kerf::session
