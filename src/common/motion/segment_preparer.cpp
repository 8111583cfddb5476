#include "common/motion/segment_preparer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::motion {

namespace {

/// A segment is stretched until it covers this many steps.
constexpr float kLeastSteps = 1.25F;

/// Nearest whole count that a firmware's conversion to 32 bits gives, without its undefined overflow.
std::uint32_t counts_from(float counts) {
  constexpr float kMost = 4294967040.0F;
  if (!(counts < kMost)) return std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::ceil(counts));
}

}  // namespace

SegmentPreparer::SegmentPreparer(Planner& planner, const MotionRules& rules) : planner_(planner), rules_(rules) {
  for (std::size_t level = 0; level < smoothing_counts_.size(); ++level) {
    smoothing_counts_[level] = rules.step_timer_hz / rules.smoothing_below_hz[level];
  }
  timer_counts_per_min_ = static_cast<float>(rules.step_timer_hz) * 60.0F;
  segment_min_ = 1.0F / (static_cast<float>(rules.segments_per_s) * 60.0F);
}

void SegmentPreparer::run() {
  stuck_ = holding_ = false;
  system_motion_ = false;
  motion_ended_ = false;
}

void SegmentPreparer::begin_hold() {
  planner_.reread_preparing_block();
  holding_ = true;
  stuck_ = motion_ended_ = false;
}

void SegmentPreparer::begin_hold_at(float speed) {
  planner_.prepared_speed_ = speed;
  begin_hold();
}

void SegmentPreparer::finish_hold() {
  planner_.replan_all();
  holding_ = false;
}

void SegmentPreparer::begin_system_motion(bool keeps_block, bool ends_block) {
  keeps_block_ = keeps_block;
  system_motion_ = true;
  motion_ended_ = false;
  if (keeps_block && block_is_partial_) kept_steps_ = steps_;
  planner_.profile_changed_ = false;
  if (!ends_block) planner_.preparing_ = nullptr;
}

void SegmentPreparer::end_system_motion() {
  if (keeps_block_) {
    planner_.replan_all();
    planner_.profile_changed_ = block_is_partial_;
    if (block_is_partial_) {
      steps_ = kept_steps_;
      least_mm_ = kLeastSteps / steps_.per_mm;
    }
  }
  next_block_keeps_decelerating_ = false;
  planner_.preparing_ = nullptr;
  holding_ = false;
  system_motion_ = false;
}

void SegmentPreparer::reset() {
  run();
  keeps_block_ = false;
  next_block_keeps_decelerating_ = false;
  block_is_partial_ = false;
  steps_ = {};
  exit_speed_ = 0;
  planner_.preparing_ = nullptr;
  planner_.profile_changed_ = false;
  planner_.prepared_speed_ = 0;
}

bool SegmentPreparer::has_work() const {
  if (stuck_ && planner_.preparing_ != nullptr) return false;
  return !motion_ended_ && (system_motion_ || planner_.preparing_ != nullptr || !planner_.is_empty());
}

std::optional<Segment> SegmentPreparer::next() {
  if (!has_work()) return std::nullopt;
  const bool wide = rules_.float_rule == FloatRule::DoubleLiterals;
  if (planner_.preparing_ == nullptr) {
    planner_.preparing_ = system_motion_ ? &planner_.system_block() : &planner_.front();
    PlannedBlock& loaded = *planner_.preparing_;
    if (planner_.profile_changed_) {
      planner_.profile_changed_ = false;
      if (!keeps_block_ || !system_motion_) next_block_keeps_decelerating_ = block_is_partial_ = false;
    } else {
      load_steps(loaded);
    }
    if (wide) {
      compute_profile<double>(loaded);
    } else {
      compute_profile<float>(loaded);
    }
  }
  PlannedBlock& block = *planner_.preparing_;
  const Ramp ramp_before = ramp_;
  const float speed_before = planner_.prepared_speed_;
  const Walk walk = wide ? walk_ramps<double>(block) : walk_ramps<float>(block);
  const bool changes =
      walk.remaining_mm != block.millimeters || planner_.prepared_speed_ != speed_before || ramp_ != ramp_before;
  const auto segment = segment_from(block, walk);
  stuck_ = !changes && segment && segment->ticks == 0;
  return segment;
}

void SegmentPreparer::load_steps(const PlannedBlock& block) {
  steps_.block_id = ++last_id_;
  step_blocks_[last_id_ % kStepBlocks] = StepBlock{.id = last_id_,
                                                   .source_line = block.source_line,
                                                   .steps = block.steps,
                                                   .step_events = block.step_events,
                                                   .negative_axes = block.negative_axes,
                                                   .is_backlash = block.is_backlash,
                                                   .rapid = block.feed.rapid,
                                                   .laser_dynamic = block.feed.laser_dynamic,
                                                   .line_number = block.feed.line_number,
                                                   .length_mm = block.length_mm,
                                                   .programmed_rate = block.programmed_rate};
  steps_.remaining = static_cast<float>(block.step_events);
  steps_.per_mm = steps_.remaining / block.millimeters;
  steps_.dt_remainder = 0.0F;
  least_mm_ = kLeastSteps / steps_.per_mm;
  inverse_rate_ = 1.0F / block.programmed_rate;

  PlannedBlock& entered = *planner_.preparing_;
  if (holding_ || next_block_keeps_decelerating_) {
    planner_.prepared_speed_ = exit_speed_;
    entered.entry_speed_sqr = exit_speed_ * exit_speed_;
    next_block_keeps_decelerating_ = false;
  } else {
    planner_.prepared_speed_ = std::sqrt(entered.entry_speed_sqr);
  }
}

void SegmentPreparer::compute_hold_profile(const PlannedBlock& block, float inverse_2a) {
  ramp_ = Ramp::Decelerate;
  const float rest_mm = block.millimeters - inverse_2a * block.entry_speed_sqr;
  if (rest_mm < -rules_.hold_snap_mm) {
    // The whole block is too short to stop in.
    exit_speed_ = std::sqrt(block.entry_speed_sqr - 2.0F * block.acceleration * block.millimeters);
  } else {
    profile_end_mm_ = rest_mm < rules_.hold_snap_mm ? 0.0F : rest_mm;
    exit_speed_ = 0.0F;
  }
}

template <class Wide>
void SegmentPreparer::compute_profile(PlannedBlock& block) {
  const float a = block.acceleration;
  const float inverse_2a = 0.5F / a;
  profile_end_mm_ = 0.0F;
  if (holding_) {
    compute_hold_profile(block, inverse_2a);
    return;
  }
  const float entry_sqr = block.entry_speed_sqr;
  const float exit_sqr = system_motion_ ? 0.0F : planner_.exit_speed_sqr();
  const float nominal = planner_.nominal_speed(block);
  const float nominal_sqr = nominal * nominal;
  exit_speed_ = std::sqrt(exit_sqr);
  ramp_ = Ramp::Accelerate;
  accelerate_until_mm_ = block.millimeters;
  const float intersection_mm = 0.5F * (block.millimeters + inverse_2a * (entry_sqr - exit_sqr));

  if (entry_sqr > nominal_sqr) {
    // Only after an override was lowered.
    accelerate_until_mm_ = block.millimeters - inverse_2a * (entry_sqr - nominal_sqr);
    if (accelerate_until_mm_ <= 0.0F) {
      ramp_ = Ramp::Decelerate;
      exit_speed_ = std::sqrt(entry_sqr - 2.0F * a * block.millimeters);
      next_block_keeps_decelerating_ = true;
    } else {
      decelerate_after_mm_ = inverse_2a * (nominal_sqr - exit_sqr);
      top_speed_ = nominal;
      ramp_ = Ramp::DecelerateToOverride;
    }
  } else if (intersection_mm <= 0.0F) {
    accelerate_until_mm_ = 0.0F;
    top_speed_ = exit_speed_;
  } else if (intersection_mm >= block.millimeters) {
    ramp_ = Ramp::Decelerate;
  } else {
    decelerate_after_mm_ = inverse_2a * (nominal_sqr - exit_sqr);
    if (decelerate_after_mm_ < intersection_mm) {
      top_speed_ = nominal;
      if (entry_sqr == nominal_sqr) {
        ramp_ = Ramp::Cruise;
      } else {
        accelerate_until_mm_ -= inverse_2a * (nominal_sqr - entry_sqr);
      }
    } else {
      accelerate_until_mm_ = decelerate_after_mm_ = intersection_mm;
      top_speed_ = static_cast<float>(
          std::sqrt(Wide{2} * static_cast<Wide>(a) * static_cast<Wide>(intersection_mm) + static_cast<Wide>(exit_sqr)));
    }
  }
}

template <class Wide>
SegmentPreparer::Walk SegmentPreparer::walk_ramps(const PlannedBlock& block) {
  Walk walk{.dt_limit = segment_min_, .slice = segment_min_, .remaining_mm = block.millimeters};
  // Never below zero; the firmwares' own comparison, so that a NaN stays one.
  float enough_mm = walk.remaining_mm - least_mm_;
  if (enough_mm < 0.0F) enough_mm = 0.0F;
  do {
    advance_ramp<Wide>(block, walk);
    walk.dt += walk.slice;
    if (walk.dt < walk.dt_limit) {
      walk.slice = walk.dt_limit - walk.dt;
    } else if (walk.remaining_mm > enough_mm) {
      // Not one step yet: make the segment longer.
      walk.dt_limit = static_cast<float>(static_cast<Wide>(walk.dt_limit) +
                                         Wide{1} / (static_cast<Wide>(rules_.segments_per_s) * Wide{60}));
      walk.slice = walk.dt_limit - walk.dt;
    } else {
      break;
    }
  } while (walk.remaining_mm > profile_end_mm_);
  return walk;
}

template <class Wide>
void SegmentPreparer::slow_to_override(const PlannedBlock& block, Walk& walk) {
  float& speed = planner_.prepared_speed_;
  const float delta = block.acceleration * walk.slice;
  const float way = static_cast<float>(static_cast<Wide>(walk.slice) *
                                       (static_cast<Wide>(speed) - Wide{0.5} * static_cast<Wide>(delta)));
  const bool arrives = rules_.override_ramp_ends_by_distance
                           ? walk.remaining_mm - way < accelerate_until_mm_ || way <= 0.0F
                           : speed - top_speed_ <= delta;
  if (arrives) {
    walk.remaining_mm = accelerate_until_mm_;
    walk.slice = 2.0F * (block.millimeters - walk.remaining_mm) / (speed + top_speed_);
    ramp_ = Ramp::Cruise;
    speed = top_speed_;
  } else {
    walk.remaining_mm -= way;
    speed -= delta;
  }
}

template <class Wide>
void SegmentPreparer::advance_ramp(const PlannedBlock& block, Walk& walk) {
  float& speed = planner_.prepared_speed_;
  const auto half_way = [&](float delta) {
    return static_cast<Wide>(walk.slice) * (static_cast<Wide>(speed) + Wide{0.5} * static_cast<Wide>(delta));
  };
  switch (ramp_) {
    case Ramp::DecelerateToOverride: slow_to_override<Wide>(block, walk); return;
    case Ramp::Accelerate: {
      const float delta = block.acceleration * walk.slice;
      walk.remaining_mm = static_cast<float>(static_cast<Wide>(walk.remaining_mm) - half_way(delta));
      if (!(walk.remaining_mm < accelerate_until_mm_)) {
        speed += delta;
        return;
      }
      walk.remaining_mm = accelerate_until_mm_;
      walk.slice = 2.0F * (block.millimeters - walk.remaining_mm) / (speed + top_speed_);
      ramp_ = walk.remaining_mm == decelerate_after_mm_ ? Ramp::Decelerate : Ramp::Cruise;
      speed = top_speed_;
      return;
    }
    case Ramp::Cruise: {
      const float remaining = walk.remaining_mm - top_speed_ * walk.slice;
      if (remaining < decelerate_after_mm_) {
        walk.slice = (walk.remaining_mm - decelerate_after_mm_) / top_speed_;
        walk.remaining_mm = decelerate_after_mm_;
        ramp_ = Ramp::Decelerate;
      } else {
        walk.remaining_mm = remaining;
      }
      return;
    }
    case Ramp::Decelerate: {
      const float delta = block.acceleration * walk.slice;
      if (speed > delta) {
        const auto remaining = static_cast<float>(static_cast<Wide>(walk.remaining_mm) - half_way(-delta));
        if (remaining > profile_end_mm_) {
          walk.remaining_mm = remaining;
          speed -= delta;
          return;
        }
      }
      // The tail. With a speed that has rounded to almost nothing it takes seconds: the firmwares' crawl
      // (motion.md 1.3).
      walk.slice = 2.0F * (walk.remaining_mm - profile_end_mm_) / (speed + exit_speed_);
      walk.remaining_mm = profile_end_mm_;
      speed = exit_speed_;
      return;
    }
  }
}

std::optional<Segment> SegmentPreparer::segment_from(PlannedBlock& block, const Walk& walk) {
  const float steps_left = steps_.per_mm * walk.remaining_mm;
  const float whole_steps_left = std::ceil(steps_left);
  const float whole_steps_before = std::ceil(steps_.remaining);
  const float whole_steps = whole_steps_before - whole_steps_left;
  const std::uint32_t steps = whole_steps > 0.0F ? static_cast<std::uint32_t>(whole_steps) : 0;
  if (steps == 0 && holding_) {
    end_motion();
    return std::nullopt;
  }

  Segment segment{.block_id = steps_.block_id, .is_decelerating = ramp_ == Ramp::Decelerate};
  segment.end_speed = planner_.prepared_speed_;
  if (block.feed.laser_dynamic)
    segment.dynamic_rpm = block.feed.spindle_rpm * (planner_.prepared_speed_ * inverse_rate_);
  // A step that the segment only begins is stepped by the next one; its share of the time is carried over.
  const float minutes_per_step = (walk.dt + steps_.dt_remainder) / (whole_steps_before - steps_left);
  set_rate(segment, steps, minutes_per_step);

  block.millimeters = walk.remaining_mm;
  steps_.remaining = whole_steps_left;
  steps_.dt_remainder = (whole_steps_left - steps_left) * minutes_per_step;

  if (walk.remaining_mm <= profile_end_mm_) {
    if (walk.remaining_mm > 0.0F) {
      end_motion();
    } else if (system_motion_) {
      segment.ends_block = true;
      motion_ended_ = true;
    } else {
      segment.ends_block = true;
      planner_.preparing_ = nullptr;
      planner_.discard_front();
    }
  }
  return segment;
}

void SegmentPreparer::set_rate(Segment& segment, std::uint32_t steps, float minutes_per_step) const {
  std::uint32_t counts = counts_from(timer_counts_per_min_ * minutes_per_step);
  std::uint8_t level = 0;
  while (level < smoothing_counts_.size() && counts >= smoothing_counts_[level]) ++level;
  counts >>= level;
  segment.smoothing = level;
  segment.ticks = steps << level;
  segment.counts_per_tick = std::uint64_t{std::min(counts, rules_.longest_tick_counts)} + rules_.extra_counts_per_tick;
}

void SegmentPreparer::end_motion() {
  motion_ended_ = true;
  if (!(system_motion_ && keeps_block_)) block_is_partial_ = true;
}

}  // namespace kerf::motion
