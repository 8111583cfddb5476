#include "sender/session/program_lines.hpp"

#include <utility>

namespace kerf::session {

ProgramLines::ProgramLines(std::shared_ptr<const job::Program> program, job::WireForm form,
                           std::shared_ptr<job::ProgramFlow> flow, std::uint32_t first_line)
    : program_(std::move(program)), form_(form), flow_(std::move(flow)), line_(program_->line(first_line)) {
  find_next();
}

void ProgramLines::step() {
  line_ = program_->line_at(program_->offset_after(*line_), line_->number + 1);
}

void ProgramLines::find_next() {
  for (waits_ = false; line_; step()) {
    text_.clear();
    job::append_wire_form(text_, line_->text, form_);
    switch (flow_->admit(line_->number, line_->text, text_)) {
      case job::Passage::Send: return;
      case job::Passage::LeaveOut: break;
      case job::Passage::Wait: waits_ = true; return;
      case job::Passage::End: line_.reset(); return;
    }
  }
}

std::optional<streaming::SourceLine> ProgramLines::next() {
  if (waits_ && !flow_->gate()) find_next();
  if (!line_ || waits_) return std::nullopt;
  return streaming::SourceLine{
      .file_line = line_->number, .file_offset_after = program_->offset_after(*line_), .text = text_};
}

void ProgramLines::move_on() {
  if (!line_) return;
  step();
  find_next();
}

}  // namespace kerf::session
