#pragma once
// When each line of a program ends on the machine, as a rehearsal found out before the job.

#include <cstdint>
#include <vector>

namespace kerf::job {

/// A rehearsed program, in seconds of undisturbed machining. Without it, progress can only go by acknowledged bytes,
/// which run ahead of the tool by a whole planner buffer.
struct Timeline {
  /// End of each file line (index 0 is line 1), never decreasing; the last one is the length of the job.
  std::vector<double> end_s;
  /// At most so many acknowledged lines still wait for their motion: the planner's blocks.
  std::uint32_t lines_ahead_at_most = 0;
  /// Seconds of machining that pass in one second; a virtual machine may be faster than 1.
  double speed = 1.0;
  /// Of the length of the job, what is spent in rapid motion, which follows an override of its own. 0 to 1.
  double rapid_share = 0.0;

  [[nodiscard]] double total_s() const { return end_s.empty() ? 0.0 : end_s.back(); }
  /// End of line `number` (from 1); 0 for line 0, and the end of the job beyond the last line.
  [[nodiscard]] double end_of(std::uint32_t number) const {
    if (number == 0 || end_s.empty()) return 0.0;
    return number > end_s.size() ? end_s.back() : end_s[number - 1];
  }
};

}  // namespace kerf::job
