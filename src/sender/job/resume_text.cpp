// A plan to resume as a program, and as text.

#include <algorithm>
#include <string>
#include <utility>

#include "common/base/text.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::job {
namespace {

std::string line_count(std::uint32_t lines) {
  return std::to_string(lines) + (lines == 1 ? " line" : " lines");
}

}  // namespace

std::vector<std::string> ResumePlan::preamble() const {
  std::vector<std::string> lines;
  for (const ResumeStep& step : steps) lines.insert(lines.end(), step.lines.begin(), step.lines.end());
  return lines;
}

ResumedText resumed_text(const Program& file, const ResumePlan& plan) {
  ResumedText text;
  const std::vector<std::string> before = plan.preamble();
  const std::size_t skipped = plan.from_line - 1;
  text.blank_lines = skipped - std::min(skipped, before.size());
  for (const std::string& line : before) (text.head += line) += '\n';
  auto line = file.line(plan.from_line);
  while (line && plan.rewritten && line->number <= plan.rewritten->line) {
    const bool is_rewritten = line->number == plan.rewritten->line;
    (text.head += is_rewritten ? std::string_view{plan.rewritten->text} : line->text) += '\n';
    line = file.line_at(file.offset_after(*line), line->number + 1);
  }
  if (line) text.rest = file.text().substr(line->offset_bytes);
  return text;
}

JobOrigin origin_of(const ResumePlan& plan) {
  const auto wanted = static_cast<std::uint32_t>(plan.preamble().size());
  return {.first_line = plan.from_line, .preamble_lines = std::max(plan.from_line - 1, wanted)};
}

ResumedProgram resumed_program(const Program& file, const ResumePlan& plan) {
  const ResumedText text = resumed_text(file, plan);
  ResumedProgram resumed{.program = nullptr, .origin = origin_of(plan)};
  auto program = Program::load(file.name(), std::string(text.blank_lines, '\n') + text.head + std::string{text.rest});
  if (program) resumed.program = *std::move(program);
  return resumed;
}

std::vector<std::string> text_of(const ResumePlan& plan) {
  std::vector<std::string> lines;
  if (plan.executing.known_by != ExecutingKnownBy::Nothing) {
    lines.push_back("Executing when it ended: line " + std::to_string(plan.executing.from) + " to " +
                    std::to_string(plan.executing.to) + ".");
  }
  lines.push_back("Goes on from line " + std::to_string(plan.from_line) + ": " + plan.from_because);
  int number = 0;
  for (const ResumeStep& step : plan.steps) {
    lines.push_back(std::to_string(++number) + ". " + step.text);
    lines.push_back("     " + step.reason);
    std::string sent;
    for (const std::string& line : step.lines) (sent += sent.empty() ? "" : " | ") += line;
    if (!sent.empty()) lines.push_back("     > " + sent);
  }
  const auto cuts = std::ranges::count(plan.path, ResumeMotion::Cut, &ResumePoint::kind);
  lines.push_back("Way to the cut: " + line_count(static_cast<std::uint32_t>(plan.preamble().size())) + ", " +
                  std::to_string(plan.path.size() - static_cast<std::size_t>(cuts)) + " points.");
  for (const std::string& warning : plan.warnings) lines.push_back("Mind: " + warning);
  return lines;
}

}  // namespace kerf::job
