#include "sender/job/progress.hpp"

#include <algorithm>
#include <utility>

namespace kerf::job {
namespace {

/// Below this share of the file the pace says nothing yet.
constexpr double kLeastPercentForPace = 1.0;
/// The rehearsal is trusted as if the job had kept to it for so long before it began: what the planner holds at the
/// start, and lines that come in bursts, say little about the rest.
constexpr double kTrustInRehearsal_s = 30.0;

}  // namespace

void ProgressMeter::start(Instant now, std::uint32_t lines_total, std::uint64_t bytes_total,
                          std::shared_ptr<const Timeline> timeline) {
  *this = {};
  progress_.lines_total = lines_total;
  progress_.bytes_total = bytes_total;
  timeline_ = std::move(timeline);
  started_at_ = counted_at_ = now;
}

double ProgressMeter::due_s_since_count(Instant at) const {
  if (!timeline_ || held_since_) return 0;
  return base::to_seconds(at - counted_at_) * timeline_->speed * override_factor_;
}

double ProgressMeter::machining_s_at(Instant at) const {
  if (!timeline_) return 0;
  // The tool is neither past what the controller has taken nor further behind it than its planner is long.
  const std::uint32_t taken = progress_.lines_acknowledged;
  const std::uint32_t surely_done = taken - std::min(taken, timeline_->lines_ahead_at_most);
  return std::clamp(machining_s_ + due_s_since_count(at), timeline_->end_of(surely_done), timeline_->end_of(taken));
}

double ProgressMeter::pace_at(Instant at) const {
  return (machining_s_at(at) + kTrustInRehearsal_s) / (due_s_ + due_s_since_count(at) + kTrustInRehearsal_s);
}

void ProgressMeter::count_until(Instant now) {
  const double machining_s = machining_s_at(now);
  due_s_ += due_s_since_count(now);
  machining_s_ = machining_s;
  counted_at_ = now;
}

void ProgressMeter::acknowledge(std::uint32_t file_line, std::uint64_t bytes) {
  progress_.file_line = std::max(progress_.file_line, file_line);
  progress_.lines_acknowledged = std::max(progress_.lines_acknowledged, file_line);
  progress_.bytes_acknowledged = std::max(progress_.bytes_acknowledged, bytes);
}

void ProgressMeter::set_held(Instant now, bool held) {
  if (held == held_since_.has_value()) return;
  count_until(now);
  if (held) {
    held_since_ = now;
    return;
  }
  held_ += now - *held_since_;
  held_since_.reset();
}

void ProgressMeter::set_overrides(Instant now, int feed_percent, int rapid_percent) {
  if (feed_percent <= 0 || rapid_percent <= 0) return;
  const double rapid_share = timeline_ ? timeline_->rapid_share : 0.0;
  const double factor = 1.0 / ((1.0 - rapid_share) * 100.0 / feed_percent + rapid_share * 100.0 / rapid_percent);
  if (factor == override_factor_) return;
  count_until(now);
  override_factor_ = factor;
}

void ProgressMeter::complete() {
  is_complete_ = true;
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
  estimate(progress, until);
  return progress;
}

void ProgressMeter::estimate(Progress& progress, Instant at) const {
  if (is_complete_) {
    if (timeline_) progress.cutting_line = progress.lines_total;
    progress.percent = 100.0;
    progress.remaining_s = 0.0;
    return;
  }
  if (timeline_ && timeline_->total_s() > 0) {
    const double done_s = machining_s_at(at);
    const double total_s = timeline_->total_s();
    const auto next = std::ranges::upper_bound(timeline_->end_s, done_s);
    const auto line = static_cast<std::uint32_t>(next - timeline_->end_s.begin()) + 1;
    progress.cutting_line = std::min(line, progress.lines_total);
    progress.percent = 100.0 * done_s / total_s;
    progress.remaining_s = (total_s - done_s) / (timeline_->speed * override_factor_ * pace_at(at));
    return;
  }
  if (progress.bytes_total > 0) {
    progress.percent =
        100.0 * static_cast<double>(progress.bytes_acknowledged) / static_cast<double>(progress.bytes_total);
  }
  if (progress.percent >= kLeastPercentForPace) {
    const double moving_s = progress.elapsed_s - progress.held_s;
    progress.remaining_s = moving_s * (100.0 - progress.percent) / progress.percent;
  }
}

}  // namespace kerf::job
