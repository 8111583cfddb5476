#include "sender/session/job_feed.hpp"

#include <utility>

#include "sender/session/program_lines.hpp"

namespace kerf::session {
namespace {

job::WireForm form_for(const vocabulary::Dialect& dialect, bool texts_keep_marks, const JobOptions& options) {
  job::WireForm form = job::wire_form_of(dialect);
  form.keeps_marks = texts_keep_marks;
  form.optional_stop = options.optional_stop;
  form.block_delete = options.block_delete;
  return form;
}

}  // namespace

JobFeed::JobFeed(std::shared_ptr<const job::Program> program, const vocabulary::Dialect& dialect, bool texts_keep_marks,
                 const machine::ToolChangeFact& tools, const JobOptions& options)
    : program_(std::move(program)),
      form_(form_for(dialect, texts_keep_marks, options)),
      flow_(std::make_shared<job::ProgramFlow>(job::tool_changes_on(tools), !form_.keeps_messages)) {}

std::unique_ptr<streaming::LineSource> JobFeed::lines_from(std::uint32_t first_line) const {
  return std::make_unique<ProgramLines>(program_, form_, flow_, first_line);
}

}  // namespace kerf::session
