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

ResumedProgram resumed_program(const Program& file, const ResumePlan& plan) {
  const std::vector<std::string> before = plan.preamble();
  const auto wanted = static_cast<std::uint32_t>(before.size());
  const std::uint32_t skipped = plan.from_line - 1;
  // Blank lines are never sent; they keep the numbers of the lines behind them.
  std::string text(skipped > wanted ? skipped - wanted : 0, '\n');
  for (const std::string& line : before) (text += line) += '\n';
  for (auto line = file.line(plan.from_line); line; line = file.line_at(file.offset_after(*line), line->number + 1)) {
    const bool is_rewritten = plan.rewritten && plan.rewritten->line == line->number;
    if (!is_rewritten && (!plan.rewritten || plan.rewritten->line < line->number)) {
      text += file.text().substr(line->offset_bytes);
      break;
    }
    (text += is_rewritten ? std::string_view{plan.rewritten->text} : line->text) += '\n';
  }
  ResumedProgram resumed;
  if (auto program = Program::load(file.name(), std::move(text))) resumed.program = *std::move(program);
  resumed.origin = {.first_line = plan.from_line, .preamble_lines = std::max(skipped, wanted)};
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
