#include "sender/session/program_lines.hpp"

#include <utility>

namespace kerf::session {

ProgramLines::ProgramLines(std::shared_ptr<const job::Program> program, job::WireForm form)
    : program_(std::move(program)), form_(form), line_(program_->line_at(0, 1)) {
  find_next();
}

void ProgramLines::find_next() {
  for (; line_; line_ = program_->line_at(program_->offset_after(*line_), line_->number + 1)) {
    text_.clear();
    job::append_wire_form(text_, line_->text, form_);
    if (!text_.empty()) return;
  }
}

std::optional<streaming::SourceLine> ProgramLines::next() {
  if (!line_) return std::nullopt;
  return streaming::SourceLine{
      .file_line = line_->number, .file_offset_after = program_->offset_after(*line_), .text = text_};
}

void ProgramLines::move_on() {
  if (!line_) return;
  line_ = program_->line_at(program_->offset_after(*line_), line_->number + 1);
  find_next();
}

}  // namespace kerf::session
