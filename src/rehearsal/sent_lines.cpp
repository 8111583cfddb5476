#include "rehearsal/sent_lines.hpp"

namespace kerf::rehearsal {

job::ToolChanges tool_changes_on(const vocabulary::Dialect& dialect) {
  using vocabulary::ToolChangeRule;
  return dialect.tool_change == ToolChangeRule::AsTold ? job::ToolChanges::ByController : job::ToolChanges::ByOperator;
}

SentLines::SentLines(const job::Program& program, const vocabulary::Dialect& dialect)
    : SentLines(program, job::wire_form_of(dialect), tool_changes_on(dialect)) {}

SentLines::SentLines(const job::Program& program, job::WireForm form, job::ToolChanges changes)
    : program_(&program), form_(form), flow_(changes, false) {}

std::optional<SentLine> SentLines::next() {
  const auto line = program_->line_at(offset_bytes_, next_number_);
  if (!line) return std::nullopt;
  wire_.clear();
  job::append_wire_form(wire_, line->text, form_);
  SentLine sent{.number = line->number, .text = line->text, .wire = {}};
  auto passage = flow_.admit(line->number, line->text, wire_);
  if (passage == job::Passage::Wait) {
    // The gate in front of this line, or the one behind the line before it.
    if (flow_.gate()->file_line == line->number) sent.tool_change = flow_.gate();
    flow_.pass_gate();
    passage = flow_.admit(line->number, line->text, wire_);
  }
  if (passage == job::Passage::End) return std::nullopt;
  if (flow_.gate() && flow_.gate()->file_line == line->number) sent.tool_change = flow_.gate();
  offset_bytes_ = program_->offset_after(*line);
  ++next_number_;
  if (passage == job::Passage::Send) sent.wire = wire_;
  return sent;
}

bool SentText::read_on(std::string& lines) {
  const auto line = lines_.next();
  if (line) (lines += line->wire) += '\n';
  return line.has_value();
}

}  // namespace kerf::rehearsal
