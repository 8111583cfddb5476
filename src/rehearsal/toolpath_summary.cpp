#include "rehearsal/toolpath_summary.hpp"

#include <algorithm>
#include <utility>

namespace kerf::rehearsal {
namespace {

constexpr std::size_t kZ = 2;
constexpr std::size_t kVerticesAtOnce = 16'384;

}  // namespace

void PathSummer::add(const PathChunk& chunk) {
  const PathVertex* before = &chunk.start;
  for (const PathVertex& vertex : chunk.vertices) {
    if (!is_event(vertex.kind) && unknown_axes_between(*before, vertex) == 0) {
      const double length_mm = length_of(before->at_mm, vertex);
      if (is_cut(vertex.kind)) {
        add_cut(before->at_mm, vertex, length_mm);
      } else {
        sum_.rapid_mm += length_mm;
        ++sum_.rapid_count;
      }
    }
    before = &vertex;
  }
  sum_.bounds.include(chunk.bounds);
}

void PathSummer::add_cut(const Point& from_mm, const PathVertex& vertex, double length_mm) {
  // A plunge begins in the air above, and a retract ends there.
  const bool is_upright = from_mm[0] == vertex.at_mm[0] && from_mm[1] == vertex.at_mm[1] && !is_arc(vertex.kind);
  if (is_upright) {
    sum_.cuts.include(from_mm[kZ] < vertex.at_mm[kZ] ? from_mm : vertex.at_mm);
  } else {
    include_motion(sum_.cuts, from_mm, vertex);
  }
  sum_.cut_mm += length_mm;
  ++sum_.cut_count;
  if (is_arc(vertex.kind)) ++sum_.arc_count;
  if (sum_.tools.empty() || sum_.tools.back().number != vertex.tool) {
    const auto known = std::ranges::find(sum_.tools, vertex.tool, &ToolUse::number);
    if (known == sum_.tools.end()) {
      sum_.tools.push_back({.number = vertex.tool, .first_line = vertex.line});
    } else {
      // The one in use stays last while its lines are added up.
      std::rotate(known, known + 1, sum_.tools.end());
    }
  }
  ToolUse& tool = sum_.tools.back();
  tool.cut_mm += length_mm;
  tool.cut_z_mm.include(static_cast<double>(from_mm[kZ]));
  tool.cut_z_mm.include(static_cast<double>(vertex.at_mm[kZ]));
  if (vertex.feed_mm_per_min > 0) {
    tool.feed_mm_per_min.include(static_cast<double>(vertex.feed_mm_per_min));
    sum_.feed_mm_per_min.include(static_cast<double>(vertex.feed_mm_per_min));
  }
  if (vertex.spindle_rpm > 0) {
    tool.spindle_rpm.include(static_cast<double>(vertex.spindle_rpm));
    sum_.spindle_rpm.include(static_cast<double>(vertex.spindle_rpm));
  }
  if (has_operation_.size() <= vertex.operation) has_operation_.resize(vertex.operation + std::size_t{1});
  if (!has_operation_[vertex.operation]) {
    has_operation_[vertex.operation] = true;
    sum_.operations.push_back(vertex.operation);
  }
}

PathSummary PathSummer::finish(const ToolpathReader& reader) {
  std::ranges::sort(sum_.tools, {}, &ToolUse::first_line);
  sum_.operation_names = reader.operations();
  sum_.time_s = reader.time_s();
  sum_.refused_lines = reader.refused_lines();
  sum_.uses_inches = reader.uses_inches();
  sum_.uses_mm = reader.uses_mm();
  return std::move(sum_);
}

PathSummary summarize(std::string_view text, const PathStart& start) {
  ToolpathReader reader(text, start);
  PathSummer summer;
  PathChunk chunk;
  for (bool goes_on = true; goes_on;) {
    goes_on = reader.read_on(chunk, kVerticesAtOnce);
    summer.add(chunk);
  }
  return summer.finish(reader);
}

}  // namespace kerf::rehearsal
