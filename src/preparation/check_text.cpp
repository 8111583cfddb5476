#include "preparation/check_text.hpp"

#include <algorithm>
#include <ranges>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sender/machine/explanation_evidence.hpp"

namespace kerf::preparation {
namespace {

using rehearsal::CheckResult;
using rehearsal::Finding;
using rehearsal::FindingGroup;
using rehearsal::Severity;

/// More lines than these are told by number only.
constexpr std::size_t kInFull = 3;

std::string_view name_of(Severity severity) {
  switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: break;
  }
  return "note";
}

std::string counted(std::uint64_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string summary_of(const CheckResult& result) {
  std::vector<std::string> parts;
  if (result.errors > 0) parts.push_back(counted(result.errors, "error"));
  if (result.warnings > 0) parts.push_back(counted(result.warnings, "warning"));
  if (result.notes > 0) parts.push_back(counted(result.notes, "note"));
  return parts.empty() ? "nothing found" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string facts_of(const CheckResult& result) {
  std::string text = "  " + counted(result.lines, "line") + ", " + counted(result.moves, "move");
  for (const auto& extent : result.extents) {
    text += fmt::format(", {} {} to {}", extent.axis, machine::short_number(extent.min_mm),
                        machine::short_number(extent.max_mm));
  }
  constexpr std::size_t kMostTools = 12;
  if (!result.tools.empty()) {
    text += fmt::format("; tool{} {}", result.tools.size() > 1 ? "s" : "",
                        fmt::join(result.tools | std::views::take(kMostTools), ", "));
    if (result.tools.size() > kMostTools) text += fmt::format(" and {} more", result.tools.size() - kMostTools);
  }
  return text;
}

std::string line_of(const Finding& finding) {
  return finding.line == 0 ? "  the controller: " + finding.text
                           : fmt::format("  line {}: {}", finding.line, finding.text);
}

/// "and 12 more lines: 40, 41, 42 …, the last is 900"
std::string rest_of(const FindingGroup& group) {
  const auto numbers = group.first | std::views::drop(kInFull) |
                       std::views::transform([](const Finding& finding) { return finding.line; });
  const std::uint64_t more = group.count - std::min<std::uint64_t>(group.count, kInFull);
  const bool is_all = group.count <= group.first.size();
  return fmt::format("  and {} more: line{} {}{}", more, more == 1 ? "" : "s", fmt::join(numbers, ", "),
                     is_all ? "" : fmt::format(" ... {}", group.last_line));
}

void tell_group(std::vector<std::string>& lines, const FindingGroup& group) {
  const auto& row = rehearsal::row_of(group.kind);
  lines.push_back(
      fmt::format("{}: {}{}", name_of(group.severity), row.title, group.code.empty() ? "" : " (" + group.code + ")"));
  for (const Finding& finding : group.first | std::views::take(kInFull)) {
    lines.push_back(line_of(finding));
    lines.push_back("    " + finding.what);
  }
  if (group.count > kInFull) lines.push_back(rest_of(group));
  const Finding& first = group.first.front();
  lines.push_back("  " + first.reason);
  if (!first.next.empty()) lines.push_back("  -> " + first.next);
}

}  // namespace

std::vector<std::string> check_text(const CheckResult& result, std::string_view file, std::string_view machine) {
  std::vector<std::string> lines{fmt::format("{} on {}: {}.", file, machine, summary_of(result)), facts_of(result)};
  for (const FindingGroup& group : result.groups) {
    lines.emplace_back();
    tell_group(lines, group);
  }
  return lines;
}

std::vector<std::string> check_lines_for_run(const CheckResult& result) {
  std::vector<std::string> lines;
  for (const FindingGroup& group : result.groups) {
    const Finding& first = group.first.front();
    if (group.severity == Severity::Error) tell_group(lines, group);
    if (group.severity != Severity::Warning) continue;
    const std::string more = group.count > 1 ? fmt::format(" (and {} more)", group.count - 1) : "";
    const std::string where = first.line == 0 ? "" : fmt::format(", line {}{}", first.line, more);
    lines.push_back(fmt::format("warning{}: {}. {}", where, rehearsal::row_of(group.kind).title, first.what));
  }
  return lines;
}

io::Json check_json(const CheckResult& result, std::string_view machine) {
  io::Json json = io::Json::object();
  json["firmware"] = std::string{machine};
  json["worst"] = result.groups.empty() ? "Nothing" : io::to_json(result.worst());
  json["errors"] = result.errors;
  json["warnings"] = result.warnings;
  json["notes"] = result.notes;
  json["lines"] = result.lines;
  json["moves"] = result.moves;
  json["tools"] = result.tools;
  json["extents"] = io::to_json(result.extents);
  io::Json groups = io::Json::array();
  io::Json findings = io::Json::array();
  for (const FindingGroup& group : result.groups) {
    io::Json one = io::Json::object();
    one["kind"] = io::to_json(group.kind);
    one["title"] = std::string{rehearsal::row_of(group.kind).title};
    one["severity"] = io::to_json(group.severity);
    one["code"] = group.code;
    one["count"] = group.count;
    one["last_line"] = group.last_line;
    groups.push_back(std::move(one));
    for (const Finding& finding : group.first) findings.push_back(io::to_json(finding));
  }
  json["groups"] = std::move(groups);
  json["findings"] = std::move(findings);
  return json;
}

}  // namespace kerf::preparation
