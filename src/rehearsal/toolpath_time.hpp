#pragma once
// Better times for a path than those of distance and feed: laid over it afterwards, so that nobody waits for them to
// see it.

#include <cstdint>
#include <string_view>
#include <vector>

#include "rehearsal/job_estimate.hpp"
#include "rehearsal/toolpath_reader.hpp"

namespace kerf::rehearsal {

/// PathVertex::time_s of a place, and when the machine is there.
struct TimeMark {
  double path_s = 0;
  double machine_s = 0;
  bool operator==(const TimeMark&) const = default;
};

/// From a path's own times to the machine's. Between two marks the time is shared out as the path's own times say.
class TimeLine {
 public:
  /// Both times of the marks ascend.
  explicit TimeLine(std::vector<TimeMark> marks) : marks_(std::move(marks)) {}

  [[nodiscard]] double machine_s(double path_s) const;
  [[nodiscard]] const std::vector<TimeMark>& marks() const { return marks_; }

 private:
  std::vector<TimeMark> marks_;
};

/// The times of `estimate`, of a program of `lines` lines.
[[nodiscard]] TimeLine time_line_of(const JobEstimate& estimate, std::uint32_t lines, std::string_view text,
                                    const PathStart& start);

}  // namespace kerf::rehearsal
