#include "rehearsal/toolpath_time.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::rehearsal {

double TimeLine::machine_s(double path_s) const {
  const auto after = std::ranges::lower_bound(marks_, path_s, {}, &TimeMark::path_s);
  if (after == marks_.end()) {
    return marks_.empty() ? path_s : marks_.back().machine_s + (path_s - marks_.back().path_s);
  }
  const TimeMark before = after == marks_.begin() ? TimeMark{} : *(after - 1);
  const double way_s = after->path_s - before.path_s;
  const double share = way_s > 0 ? (path_s - before.path_s) / way_s : 1;
  return std::lerp(before.machine_s, after->machine_s, share);
}

TimeLine time_line_of(const JobEstimate& estimate, std::uint32_t lines, std::string_view text, const PathStart& start) {
  constexpr std::size_t kVerticesAtOnce = 16'384;
  std::vector<TimeMark> marks;
  const auto count = static_cast<std::uint64_t>(estimate.marks_s.size());
  // Last line of the share of lines that a mark of the estimate stands for.
  const auto last_line = [&](std::uint64_t mark) { return ((mark + 1) * lines + count - 1) / count; };
  ToolpathReader reader(text, start);
  PathChunk chunk;
  double path_s = 0;
  std::uint64_t next = 0;
  const auto mark_until = [&](std::uint64_t line) {
    for (; next < count && last_line(next) < line; ++next) {
      const double machine_s = estimate.marks_s[static_cast<std::size_t>(next)];
      if (!marks.empty() && marks.back().path_s == path_s) {
        marks.back().machine_s = machine_s;
      } else {
        marks.push_back({.path_s = path_s, .machine_s = machine_s});
      }
    }
  };
  for (bool goes_on = true; goes_on;) {
    goes_on = reader.read_on(chunk, kVerticesAtOnce);
    for (const PathVertex& vertex : chunk.vertices) {
      mark_until(vertex.line);
      path_s = vertex.time_s;
    }
  }
  mark_until(std::uint64_t{lines} + 1);
  return TimeLine(std::move(marks));
}

}  // namespace kerf::rehearsal
