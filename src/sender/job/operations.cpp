#include "sender/job/operations.hpp"

#include <array>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

/// What stands before a name: FreeCAD, Vectric, then what others write.
constexpr std::array<std::string_view, 7> kMarks = {
    "begin operation:", "toolpath:-", "toolpath name:", "toolpath:", "operation name:", "operation:", "op:"};
/// FreeCAD says so when one ends.
constexpr std::string_view kEndMark = "finish operation";

/// The comment of a line that has nothing else; empty if there is more, or no comment.
std::string_view lone_comment(std::string_view line) {
  line = base::trim(line);
  if (line.starts_with(';')) return base::trim(line.substr(1));
  if (!line.starts_with('(') || line.find(')') != line.size() - 1) return {};
  return base::trim(line.substr(1, line.size() - 2));
}

}  // namespace

std::optional<std::string> OperationFinder::on_line(std::string_view line) {
  const bool after_blank = after_blank_;
  after_blank_ = base::trim(line).empty();
  if (after_blank_) return std::nullopt;
  const std::string_view comment = lone_comment(line);
  if (comment.empty()) {
    has_code_ = has_code_ || line.find_first_of("GXYZgxyz") != std::string_view::npos;
    return std::nullopt;
  }
  for (const std::string_view mark : kMarks) {
    if (base::starts_with_ignoring_case(comment, mark)) return std::string{base::trim(comment.substr(mark.size()))};
  }
  if (base::starts_with_ignoring_case(comment, kEndMark)) return std::nullopt;
  // Fusion 360 writes a name alone, after a blank line and behind the program's first modes.
  if (after_blank && has_code_) return std::string{comment};
  return std::nullopt;
}

}  // namespace kerf::job
