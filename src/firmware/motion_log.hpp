#pragma once
// What a controller planned and what its steppers did, block by block, for those who ask for it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

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
};

/// From the first step of a block to its end, or to the rest that came before. What is left of a block after a hold
/// is a stretch of its own where the firmware loads the block again (grblHAL), and part of none where it goes on.
struct ExecutedStretch {
  Instant began{};
  Instant ended{};
  vocabulary::AxisSteps end_steps{};
};

/// Grows without bound while a controller keeps it, unless it only counts.
class MotionLog {
 public:
  enum class Keeps : std::uint8_t { Blocks, Counts };

  explicit MotionLog(Keeps keeps = Keeps::Blocks) : keeps_(keeps) {}

  void planned(std::uint32_t line, const motion::PlannedBlock& block) {
    ++planned_;
    if (keeps_ == Keeps::Counts) return;
    moves_.push_back({.line = line, .length_mm = block.length_mm, .rate_mm_per_min = block.programmed_rate});
  }
  void began(Instant at) {
    ++executed_;
    if (keeps_ == Keeps::Counts) return;
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

  /// Blocks that were planned and have begun.
  [[nodiscard]] std::size_t blocks() const { return std::min(planned_, executed_); }
  /// Empty if only counts are kept, as are the stretches.
  [[nodiscard]] const std::vector<PlannedMove>& moves() const { return moves_; }
  [[nodiscard]] const std::vector<ExecutedStretch>& stretches() const { return stretches_; }
  /// When the steppers came to rest, or finished a block, for the last time.
  [[nodiscard]] Instant last_end() const { return last_end_; }

 private:
  Keeps keeps_;
  std::size_t planned_ = 0;
  std::size_t executed_ = 0;
  std::vector<PlannedMove> moves_;
  std::vector<ExecutedStretch> stretches_;
  Instant last_end_{};
  bool is_open_ = false;
};

}  // namespace kerf::firmware
