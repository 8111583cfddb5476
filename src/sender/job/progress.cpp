#include "sender/job/progress.hpp"

#include <algorithm>

namespace kerf::job {
namespace {

/// Below this share of the file the pace says nothing yet.
constexpr double kLeastPercentForPace = 1.0;

}  // namespace

void ProgressMeter::start(Instant now, std::uint32_t lines_total, std::uint64_t bytes_total) {
  *this = {};
  progress_.lines_total = lines_total;
  progress_.bytes_total = bytes_total;
  started_at_ = now;
}

void ProgressMeter::acknowledge(std::uint32_t file_line, std::uint64_t bytes) {
  progress_.file_line = std::max(progress_.file_line, file_line);
  progress_.lines_acknowledged = std::max(progress_.lines_acknowledged, file_line);
  progress_.bytes_acknowledged = std::max(progress_.bytes_acknowledged, bytes);
}

void ProgressMeter::set_held(Instant now, bool held) {
  if (held == held_since_.has_value()) return;
  if (held) {
    held_since_ = now;
    return;
  }
  held_ += now - *held_since_;
  held_since_.reset();
}

void ProgressMeter::complete() {
  progress_.lines_acknowledged = progress_.lines_total;
  progress_.bytes_acknowledged = progress_.bytes_total;
}

void ProgressMeter::stop(Instant now) {
  set_held(now, false);
  if (!stopped_at_) stopped_at_ = now;
}

Progress ProgressMeter::at(Instant now) const {
  Progress progress = progress_;
  const Instant until = stopped_at_.value_or(now);
  const Duration held = held_ + (held_since_ ? until - *held_since_ : Duration{});
  progress.elapsed_s = base::to_seconds(until - started_at_);
  progress.held_s = base::to_seconds(held);
  if (progress.bytes_total > 0) {
    progress.percent =
        100.0 * static_cast<double>(progress.bytes_acknowledged) / static_cast<double>(progress.bytes_total);
  }
  if (progress.percent >= kLeastPercentForPace) {
    const double moving_s = progress.elapsed_s - progress.held_s;
    progress.remaining_at_this_pace_s = moving_s * (100.0 - progress.percent) / progress.percent;
  }
  return progress;
}

}  // namespace kerf::job
