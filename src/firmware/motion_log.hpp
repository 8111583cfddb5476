#pragma once
// What a controller planned and what its steppers did, block by block, for those who ask for it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/time.hpp"
#include "common/motion/planner.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::firmware {

/// A block as it entered the planner.
struct PlannedMove {
  /// Lines read since the log began, the one that planned this block included; 0 for a startup line.
  std::uint32_t line = 0;
  float length_mm = 0;
  float rate_mm_per_min = 0;
  bool rapid = false;
};

/// From the first step of a block to its end, or to the rest that came before. What is left of a block after a hold
/// is a stretch of its own where the firmware loads the block again (grblHAL), and part of none where it goes on.
struct ExecutedStretch {
  Instant began{};
  Instant ended{};
  vocabulary::AxisSteps end_steps{};
};

/// What a block was meant to be, and what became of it.
struct FinishedMove {
  PlannedMove planned{};
  ExecutedStretch executed{};
};

/// Grows without bound while a controller keeps it, unless somebody takes what is finished.
class MotionLog {
 public:
  void planned(std::uint32_t line, const motion::PlannedBlock& block) {
    ++planned_;
    moves_.push_back({.line = line,
                      .length_mm = block.length_mm,
                      .rate_mm_per_min = block.programmed_rate,
                      .rapid = block.feed.rapid});
  }
  void began(Instant at) {
    ++executed_;
    stretches_.push_back({.began = at, .ended = at});
    is_open_ = true;
  }
  /// The block is done, or the steppers rest.
  void ended(Instant at, const vocabulary::AxisSteps& steps) {
    if (at > last_end_) last_end_ = at;
    if (!is_open_) return;
    is_open_ = false;
    stretches_.back().ended = at;
    stretches_.back().end_steps = steps;
  }

  /// The oldest block whose motion is over; it is forgotten here.
  [[nodiscard]] std::optional<FinishedMove> take_finished() {
    const bool is_over = stretches_.size() > 1 || !is_open_;
    return is_over ? take_begun() : std::nullopt;
  }
  /// The oldest block that has begun, over or not.
  [[nodiscard]] std::optional<FinishedMove> take_begun() {
    if (moves_.empty() || stretches_.empty()) return std::nullopt;
    const FinishedMove taken{.planned = moves_.front(), .executed = stretches_.front()};
    moves_.pop_front();
    stretches_.pop_front();
    return taken;
  }

  /// Blocks that were planned and have begun.
  [[nodiscard]] std::size_t blocks() const { return std::min(planned_, executed_); }
  [[nodiscard]] const std::deque<ExecutedStretch>& stretches() const { return stretches_; }
  /// When the steppers came to rest, or finished a block, for the last time.
  [[nodiscard]] Instant last_end() const { return last_end_; }

 private:
  std::size_t planned_ = 0;
  std::size_t executed_ = 0;
  std::deque<PlannedMove> moves_;
  std::deque<ExecutedStretch> stretches_;
  Instant last_end_{};
  bool is_open_ = false;
};

}  // namespace kerf::firmware
