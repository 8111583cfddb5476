#include "sender/job/program_flow.hpp"

#include <algorithm>
#include <utility>

#include "common/base/text.hpp"
#include "sender/job/line_words.hpp"

namespace kerf::job {
namespace {

bool is_word(const LineWord& word, char letter, int number) {
  return word.letter == letter && base::parse_decimal(word.digits) == static_cast<double>(number);
}

}  // namespace

ToolChanges tool_changes_on(const machine::ToolChangeFact& controller) {
  using machine::ToolChangeKind;
  const bool is_its_own_affair = controller.kind == ToolChangeKind::Manual ||
                                 controller.kind == ToolChangeKind::Changer || !controller.mode.empty();
  return is_its_own_affair ? ToolChanges::ByController : ToolChanges::ByOperator;
}

FlowWords flow_words_of(std::string_view text) {
  // Most lines are motion without any of these.
  if (text.find_first_of("MmTtPp") == std::string_view::npos) return {};
  FlowWords words;
  bool dwells = false;
  std::optional<double> p;
  for (const LineWord& word : words_of(text)) {
    if (is_word(word, 'M', 0) || is_word(word, 'M', 60)) words.pauses = true;
    if (is_word(word, 'M', 1)) words.pauses_optionally = true;
    if (is_word(word, 'M', 2) || is_word(word, 'M', 30)) words.ends_program = true;
    if (is_word(word, 'M', 6)) words.changes_tool = true;
    if (is_word(word, 'G', 4)) dwells = true;
    if (word.letter == 'T') words.tool = base::parse_int<int>(word.digits);
    if (word.letter == 'P') p = base::parse_decimal(word.digits);
  }
  if (dwells) words.dwell_s = p.value_or(-1);
  return words;
}

std::string_view message_in(std::string_view line) {
  for (std::size_t open = line.find('('); open != std::string_view::npos; open = line.find('(', open + 1)) {
    const std::size_t close = line.find(')', open);
    if (close == std::string_view::npos) break;
    const std::string_view comment = base::trim(line.substr(open + 1, close - open - 1));
    constexpr std::string_view kStart = "MSG,";
    if (base::starts_with_ignoring_case(comment, kStart)) return base::trim(comment.substr(kStart.size()));
    open = close;
  }
  return {};
}

std::string without_word(std::string_view text, char letter, int number) {
  std::string rest;
  std::size_t kept = 0;
  for (const LineWord& word : words_of(text)) {
    if (!is_word(word, letter, number)) continue;
    const auto digits_at = static_cast<std::size_t>(word.digits.data() - text.data());
    rest += text.substr(kept, digits_at - 1 - kept);
    kept = digits_at + word.digits.size();
  }
  return rest += text.substr(kept);
}

void ProgramFlow::note_message(std::uint32_t number, std::string_view line) {
  if (!tells_messages_ || number <= message_noted_at_) return;
  message_noted_at_ = number;
  const std::string_view text = message_in(line);
  if (text.empty()) return;
  // Not plain text would reach a terminal: control characters are shown, not sent there.
  messages_.push_back({.after_line = last_sent_, .file_line = number, .text = base::escape(text)});
}

Passage ProgramFlow::admit(std::uint32_t number, std::string_view line, std::string& wire) {
  if (gate_ && !gate_->by_operator) return Passage::Wait;
  if (end_line_ != 0) return Passage::End;
  note_message(number, line);
  // The first `%` opens a program, the next one ends it; a lone one behind lines does so too.
  if (base::trim(line) == "%") {
    if (has_begun_) end_line_ = number;
    return wire.empty() ? Passage::LeaveOut : Passage::Send;
  }
  if (wire.empty()) return Passage::LeaveOut;
  has_begun_ = true;
  const FlowWords words = flow_words_of(wire);
  if (words.tool) tool_ = words.tool;
  if (words.changes_tool) {
    const bool by_operator = changes_ == ToolChanges::ByOperator;
    if (passed_gate_at_ != number) gate_ = ToolGate{.file_line = number, .tool = tool_, .by_operator = by_operator};
    if (gate_ && by_operator) return Passage::Wait;
    if (by_operator) wire = without_word(wire, 'M', 6);
  }
  if (words.ends_program) end_line_ = number;
  last_sent_ = number;
  return wire.empty() ? Passage::LeaveOut : Passage::Send;
}

void ProgramFlow::go_back_to(std::uint32_t line) {
  gate_.reset();
  if (end_line_ >= line) end_line_ = 0;
  last_sent_ = std::min(last_sent_, line - 1);
}

void ProgramFlow::pass_gate() {
  if (!gate_) return;
  passed_gate_at_ = gate_->file_line;
  gate_.reset();
}

std::vector<DueMessage> ProgramFlow::take_messages(std::uint32_t acknowledged_line) {
  std::vector<DueMessage> due;
  while (!messages_.empty() && messages_.front().after_line <= acknowledged_line) {
    due.push_back(std::move(messages_.front()));
    messages_.pop_front();
  }
  return due;
}

}  // namespace kerf::job
