#include "apps/progress_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "common/vocabulary/axis.hpp"

namespace kerf::apps {
namespace {

using vocabulary::MachineState;

std::string percent_text(const job::Progress& progress) {
  return fmt::format("{:3.0f} %", std::floor(progress.percent));
}

std::string line_text(const job::Progress& progress) {
  return fmt::format("line {}/{}", progress.shown_line(), progress.lines_total);
}

std::string times_text(const job::Progress& progress) {
  const auto& left = progress.remaining_s;
  return fmt::format("{} gone, {} left", clock_text(progress.elapsed_s), left ? clock_text(*left) : "-:--");
}

std::string feed_text(const machine::Snapshot& snapshot) {
  return snapshot.feed_mm_per_min ? fmt::format("F{:.0f}", *snapshot.feed_mm_per_min) : std::string();
}

std::string bar(double percent, int cells, bool with_utf8) {
  const auto filled = static_cast<int>(std::lround(percent / 100 * cells));
  std::string text;
  for (int cell = 0; cell < cells; ++cell) {
    if (with_utf8) {
      text += cell < filled ? "█" : "░";
    } else {
      text += cell < filled ? '#' : '.';
    }
  }
  return text;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    if (!text.empty()) text += "  ";
    text += part;
  }
  return text;
}

}  // namespace

std::string position_text(const machine::Snapshot& snapshot) {
  const auto& in_mm = snapshot.work_position_mm ? snapshot.work_position_mm : snapshot.machine_position_mm;
  const auto& unitless =
      snapshot.work_position_unitless ? snapshot.work_position_unitless : snapshot.machine_position_unitless;
  const auto& position = in_mm ? in_mm : unitless;
  if (!position) return {};
  std::string text;
  for (std::size_t axis = 0; axis < std::min(position->size(), vocabulary::kMaxAxes); ++axis) {
    // Rounding must not show a minus in front of zero.
    const double value = std::abs((*position)[axis]) < 0.0005 ? 0.0 : (*position)[axis];
    text += fmt::format("{}{}{:.3f}", text.empty() ? "" : " ", vocabulary::kAxisLetters[axis], value);
  }
  if (!in_mm) text += " (mm or inch is not known)";
  return text;
}

std::string state_text(const machine::Snapshot& snapshot) {
  if (snapshot.state == MachineState::Hold && snapshot.substate == vocabulary::kHoldDecelerating) {
    return "Hold (decelerating)";
  }
  // Right after a reset nobody knows.
  return snapshot.state == MachineState::Unknown ? std::string() : std::string(name_of(snapshot.state));
}

std::string progress_bar(const job::JobState& job, int columns, bool with_utf8) {
  const std::string percent = percent_text(job.progress);
  const std::string times = times_text(job.progress);
  // The last column stays free: some terminals wrap when it is written.
  const auto room = static_cast<std::size_t>(std::max(columns - 1, 1));

  std::string text = joined({percent, line_text(job.progress), times});
  constexpr std::size_t kLeastCells = 8;
  constexpr std::size_t kMostCells = 40;
  if (text.size() + 2 + kLeastCells <= room) {
    const std::size_t cells = std::min(kMostCells, room - text.size() - 2);
    return bar(job.progress.percent, static_cast<int>(cells), with_utf8) + "  " + text;
  }
  if (text.size() > room) text = joined({percent, times});
  if (text.size() > room) text = percent;
  return text.substr(0, room);
}

std::string machine_line(const machine::Snapshot& snapshot, int columns) {
  const std::string text = joined({state_text(snapshot), feed_text(snapshot), position_text(snapshot)});
  return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 1)));
}

std::string progress_line(const job::JobState& job, const machine::Snapshot& snapshot) {
  return joined({percent_text(job.progress), line_text(job.progress), times_text(job.progress), feed_text(snapshot),
                 position_text(snapshot), state_text(snapshot)});
}

}  // namespace kerf::apps
