#pragma once
// A job's progress in words. Pure: what is shown follows from the values.

#include <string>

#include "common/base/duration_text.hpp"
#include "sender/job/job_state.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::apps {

using base::clock_text;

/// "X12.345 Y-3.000 Z0.500", the work position if it is known, else the machine position; axes are named in Grbl's
/// order.
[[nodiscard]] std::string position_text(const machine::Snapshot& snapshot);

/// "Run", "Hold (decelerating)"
[[nodiscard]] std::string state_text(const machine::Snapshot& snapshot);

/// Bar, percent, line, elapsed and remaining time, in at most `columns`. What does not fit is left out: the bar first,
/// then the line.
[[nodiscard]] std::string progress_bar(const job::JobState& job, int columns, bool with_utf8);

/// State, feed and position, in at most `columns`.
[[nodiscard]] std::string machine_line(const machine::Snapshot& snapshot, int columns);

/// Both in one line without a bar, for a log file.
[[nodiscard]] std::string progress_line(const job::JobState& job, const machine::Snapshot& snapshot);

}  // namespace kerf::apps
