#include "common/motion/executor.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kerf::motion {

namespace {
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
}

Executor::Executor(Planner& planner, const MotionRules& rules)
    : planner_(planner), rules_(rules), preparer_(planner, rules) {
  const std::int64_t hz = rules.step_timer_hz;
  const std::int64_t common = std::gcd(kNanosecondsPerSecond, hz);
  num_ = kNanosecondsPerSecond / common;
  den_ = hz / common;
}

Instant Executor::instant_of(std::int64_t counts) const {
  return started_ + Duration{(counts * num_ + den_ - 1) / den_};
}

std::int64_t Executor::counts_at(Instant at) const {
  return (at - started_).count() * den_ / num_;
}

std::int64_t Executor::ticks_until(std::int64_t counts) const {
  if (stage_ != Stage::Stepping || counts < segment_start_) return 0;
  const auto ticks = (counts - segment_start_) / static_cast<std::int64_t>(current_.counts_per_tick) + 1;
  return std::min<std::int64_t>(ticks, current_.ticks);
}

std::int64_t Executor::progress_until(Instant at) const {
  return ticks_until(counts_at(at)) * StepCursor::progress_per_tick(current_.smoothing);
}

void Executor::cycle_start(Instant now, Duration after) {
  advance_to(now);
  if (stage_ != Stage::Idle) return;
  held_ = false;
  preparer_.run();
  if (!planner_.is_empty()) wake(now + after);
}

Planner::Added Executor::start_system_motion(Instant now, const PathLine& line, SystemMotion kind, Duration after) {
  advance_to(now);
  if (stage_ != Stage::Idle || planner_.plan_system_motion(line, cursor_.position()) == Planner::Added::Dropped) {
    return Planner::Added::Dropped;
  }
  system_kind_ = kind;
  const bool keeps_block = kind == SystemMotion::Parking;
  preparer_.begin_system_motion(keeps_block, !keeps_block && segment_count_ != 0);
  wake(now + after);
  return Planner::Added::Queued;
}

void Executor::wake(Instant now) {
  started_ = now;
  const std::uint64_t last_period =
      current_.counts_per_tick == 0 ? rules_.longest_tick_counts : current_.counts_per_tick;
  segment_end_ = static_cast<std::int64_t>(rules_.wake_waits_last_period ? last_period : rules_.wake_counts);
  segment_start_ = segment_end_;
  stage_ = Stage::Draining;
  if (rules_.restart_resets_bresenham) cursor_.leave();
  refill();
  refill_at_ = kNever;
  if (segment_end_ == 0) load_or_stop();
}

void Executor::begin_hold(Instant now) {
  advance_to(now);
  if (stage_ == Stage::Idle || preparer_.is_holding()) return;
  preparer_.begin_hold();
}

void Executor::begin_stop(Instant now) {
  advance_to(now);
  if (stage_ == Stage::Idle || preparer_.is_holding()) return;
  const auto slots = static_cast<std::size_t>(rules_.segment_slots);
  if (!rules_.cancel_drops_segments || stage_ == Stage::Locking || segment_count_ < slots) {
    preparer_.begin_hold();
    return;
  }
  // Keep the executing segment, one more if that is almost done, and those that slow down already.
  const bool between_segments = stage_ == Stage::Draining;
  const std::int64_t left = between_segments ? 0 : current_.ticks - ticks_until(counts_at(now));
  std::size_t kept = left < 3 || left < (current_.ticks >> 3) ? 2 : 1;
  const auto nth = [this](std::size_t n) -> const Segment& { return segments_[(first_segment_ + n) % kMostSegments]; };
  while (kept + 1 < segment_count_ && nth(kept).is_decelerating) ++kept;
  segment_count_ = std::min(kept + 1, segment_count_);
  preparer_.begin_hold_at(nth(segment_count_ - 1).end_speed);
}

void Executor::reset(Instant now) {
  advance_to(now);
  const std::int64_t ahead = progress_until(now);
  if (stage_ == Stage::Stepping) cursor_.advance(ahead);
  cursor_.leave();
  cursor_.freeze(0);
  preparer_.reset();
  first_segment_ = segment_count_ = 0;
  refill_at_ = kNever;
  stage_ = Stage::Idle;
  held_ = false;
  block_to_report_ = false;
  watches_.clear();
}

bool Executor::has_more_for_free_slots() const {
  return segment_count_ < static_cast<std::size_t>(rules_.segment_slots) && preparer_.has_work();
}

bool Executor::needs_refill() const {
  return (stage_ == Stage::Stepping || stage_ == Stage::Draining) && has_more_for_free_slots();
}

void Executor::refill() {
  constexpr int kMostEmptySegments = 100'000;
  int empty_segments = 0;
  while (has_more_for_free_slots()) {
    const auto segment = preparer_.next();
    if (!segment) return;
    // Lengths beyond 32 bits of steps give segments without a step, without end: the stepper then finds none.
    if (segment->ticks == 0 && ++empty_segments > kMostEmptySegments) return;
    if (segment->ticks == 0) continue;
    segments_[(first_segment_ + segment_count_) % kMostSegments] = *segment;
    ++segment_count_;
  }
}

std::int64_t Executor::next_count() const {
  std::int64_t next = kNotSeen;
  if (stage_ == Stage::Stepping) next = segment_end_ - static_cast<std::int64_t>(current_.counts_per_tick);
  if (stage_ == Stage::Draining) next = segment_end_;
  for (const Watch& watch : watches_) next = std::min(next, watch.seen_at);
  return next;
}

Instant Executor::pass_after(Instant at) const {
  const Duration pass = rules_.main_loop_pass;
  if (pass == Duration::zero()) return at;
  const auto passes = (at - Instant{} + pass - Duration{1}) / pass;
  // A pass obeys first and prepares then.
  return Instant{} + passes * pass + Duration{1};
}

Instant Executor::next_step() const {
  if (stage_ == Stage::Idle) return kNever;
  if (stage_ == Stage::Locking) return locked_until_;
  Instant next = instant_of(next_count());
  if (needs_refill()) next = std::min(next, refill_time());
  return std::max(now_, next);
}

Instant Executor::next_deadline() const {
  const bool only_steps = stage_ == Stage::Stepping && watches_.empty() && !needs_refill();
  if (!only_steps) return next_step();
  // The last interrupt of a segment matters to nobody before its place is filled or the next segment is loaded.
  const Instant last = instant_of(segment_end_ - static_cast<std::int64_t>(current_.counts_per_tick));
  return std::max(now_, std::min(pass_after(last), instant_of(segment_end_)));
}

void Executor::advance_to(Instant now) {
  if (now < now_) return;
  while (stage_ != Stage::Idle) {
    if (refill_at_ == kNever && needs_refill()) refill_at_ = pass_after(now_);
    const Instant at = next_step();
    if (at > now) break;
    now_ = at;
    if (needs_refill() && refill_at_ <= now_ && refill_at_ < instant_of(next_count())) {
      prepare();
    } else {
      run_next();
    }
  }
  now_ = now;
}

void Executor::prepare_at_rest() {
  if (stage_ != Stage::Idle || held_) return;
  preparer_.run();
  refill();
}

void Executor::prepare() {
  if (stage_ != Stage::Stepping && stage_ != Stage::Draining) return;
  refill();
  // Where nothing more can be prepared for now, the next interrupt comes first.
  refill_at_ = needs_refill() ? instant_of(next_count()) : kNever;
}

void Executor::run_next() {
  if (stage_ == Stage::Locking) {
    stop(locked_until_);
    return;
  }
  const std::int64_t count = next_count();
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    if (watches_[i].seen_at == count) {
      report_watch(i);
      return;
    }
  }
  if (stage_ == Stage::Stepping) {
    finish_segment();
  } else {
    load_or_stop();
  }
}

void Executor::finish_segment() {
  cursor_.advance(std::int64_t{current_.ticks} * StepCursor::progress_per_tick(current_.smoothing));
  block_to_report_ = current_.ends_block;
  first_segment_ = (first_segment_ + 1) % kMostSegments;
  --segment_count_;
  stage_ = Stage::Draining;
  refill_at_ = pass_after(now_);
}

void Executor::report_finished_block(Instant at) {
  if (!block_to_report_) return;
  block_to_report_ = false;
  const StepBlock& block = cursor_.block();
  events_.emplace_back(BlockFinished{.at = at,
                                     .block = block.id,
                                     .source_line = block.source_line,
                                     .length_mm = block.length_mm,
                                     .programmed_rate_mm_per_min = block.programmed_rate,
                                     .steps = cursor_.position()});
}

void Executor::load_or_stop() {
  const Instant at = instant_of(segment_end_);
  report_finished_block(at);
  if (segment_count_ == 0) {
    stopped_at_ = at;
    const bool homes = preparer_.in_system_motion() && system_kind_ == SystemMotion::Homing;
    const Duration wait = homes ? Duration::zero() : lock_delay();
    if (wait == Duration::zero()) {
      stop(at);
    } else {
      stage_ = Stage::Locking;
      locked_until_ = at + wait;
    }
    return;
  }
  current_ = segments_[first_segment_];
  if (!cursor_.is_in(current_.block_id)) {
    cursor_.enter(preparer_.block(current_.block_id));
    events_.emplace_back(
        BlockStarted{.at = at, .block = current_.block_id, .source_line = cursor_.block().source_line});
  }
  segment_start_ = segment_end_;
  segment_end_ += static_cast<std::int64_t>(current_.ticks) * static_cast<std::int64_t>(current_.counts_per_tick);
  stage_ = Stage::Stepping;
  place_watches();
}

void Executor::stop(Instant at) {
  stage_ = Stage::Idle;
  const bool was_holding = preparer_.is_holding();
  if (preparer_.in_system_motion()) {
    preparer_.end_system_motion();
    cursor_.leave();
    held_ = system_kind_ == SystemMotion::Parking;
    events_.emplace_back(MotionEnded{.at = at, .system_motion = true});
  } else if (was_holding) {
    preparer_.finish_hold();
    held_ = true;
    events_.emplace_back(HoldComplete{.at = at, .stopped_at = stopped_at_});
  } else {
    events_.emplace_back(MotionEnded{.at = at});
  }
}

ExecutorPhase Executor::phase() const {
  if (stage_ == Stage::Idle) return held_ ? ExecutorPhase::Held : ExecutorPhase::Resting;
  return preparer_.is_holding() ? ExecutorPhase::Decelerating : ExecutorPhase::Running;
}

AxisSteps Executor::steps_at(Instant at) const {
  return cursor_.position(progress_until(at));
}

AxisSteps Executor::motor_steps_at(Instant at) const {
  return cursor_.motors(progress_until(at));
}

AxisSteps Executor::pulsed_steps_at(Instant at) const {
  const std::int64_t per_tick = StepCursor::progress_per_tick(current_.smoothing);
  if (stage_ == Stage::Stepping) return cursor_.motors(progress_until(at) - per_tick);
  const bool has_stepped = stage_ == Stage::Draining && segment_start_ < segment_end_;
  return cursor_.motors(has_stepped ? -per_tick : 0);
}

void Executor::set_position(const AxisSteps& steps) {
  cursor_.set_position(steps);
}

void Executor::set_motor_position(const AxisSteps& steps) {
  cursor_.set_motors(steps);
  place_watches();
}

float Executor::speed_mm_per_min() const {
  return stage_ == Stage::Idle ? 0.0F : preparer_.speed();
}

std::optional<float> Executor::dynamic_rpm() const {
  if (executing() == nullptr || !cursor_.block().laser_dynamic) return std::nullopt;
  return current_.dynamic_rpm;
}

const StepBlock* Executor::executing() const {
  const bool steps = stage_ == Stage::Stepping || stage_ == Stage::Draining;
  return steps && cursor_.block().id != 0 ? &cursor_.block() : nullptr;
}

Duration Executor::lock_delay() const {
  constexpr std::uint8_t kMotorsStayOn = 255;
  const std::uint8_t delay_ms = planner_.settings().idle_delay_ms;
  const bool waits = rules_.idle_lock_blocks && delay_ms != kMotorsStayOn;
  return waits ? Duration{std::chrono::milliseconds{delay_ms}} : Duration::zero();
}

void Executor::watch(const StepThreshold& threshold) {
  watches_.push_back({.threshold = threshold});
  place(watches_.back());
}

void Executor::clear_watches() {
  watches_.clear();
}

void Executor::freeze_axes(AxisMask axes) {
  cursor_.freeze(axes, progress_until(now_));
  place_watches();
}

void Executor::place_watches() {
  for (Watch& watch : watches_) place(watch);
}

void Executor::place(Watch& watch) const {
  watch.seen_at = kNotSeen;
  if (stage_ != Stage::Stepping) return;
  const StepThreshold& threshold = watch.threshold;
  const std::int64_t progress = cursor_.progress_to(index_of(threshold.axis), threshold.steps, threshold.above);
  if (progress < 0) return;
  const std::int64_t per_tick = StepCursor::progress_per_tick(current_.smoothing);
  const std::int64_t ticks = (progress + per_tick - 1) / per_tick;
  const auto period = static_cast<std::int64_t>(current_.counts_per_tick);
  // The interrupt that decides tick n (from 1) runs n - 1 periods after the segment's start; the probe is read by the
  // next one.
  const std::int64_t periods = threshold.seen_by_step_interrupt ? ticks : std::max<std::int64_t>(ticks - 1, 0);
  if (periods > std::int64_t{current_.ticks} - 1) return;
  watch.seen_at = std::max(segment_start_ + periods * period, counts_at(now_));
}

void Executor::report_watch(std::size_t index) {
  const Watch watch = watches_[index];
  watches_.erase(watches_.begin() + static_cast<std::ptrdiff_t>(index));
  // A probe's interrupt reads the pin before it steps.
  const std::int64_t ticks = ticks_until(watch.seen_at) - (watch.threshold.seen_by_step_interrupt ? 1 : 0);
  const std::int64_t ahead = std::max<std::int64_t>(ticks, 0) * StepCursor::progress_per_tick(current_.smoothing);
  events_.emplace_back(ThresholdCrossed{
      .at = instant_of(watch.seen_at), .threshold = watch.threshold, .steps = cursor_.position(ahead)});
  if (watch.threshold.freezes_axis) {
    // The step that this interrupt decides goes out with the next one, unless this was the last switch: then the
    // steppers are stopped before.
    const bool goes_on = std::ranges::any_of(
        watches_, [&](const Watch& other) { return other.threshold.freezes_axis && other.seen_at != watch.seen_at; });
    const std::int64_t moved =
        goes_on ? ticks_until(watch.seen_at) * StepCursor::progress_per_tick(current_.smoothing) : ahead;
    cursor_.freeze(static_cast<AxisMask>(cursor_.frozen() | vocabulary::mask_of(watch.threshold.axis)), moved);
    place_watches();
  }
}

std::vector<ExecutorEvent> Executor::take_events() {
  return std::exchange(events_, {});
}

void Executor::take_events(std::vector<ExecutorEvent>& into) {
  into.clear();
  into.swap(events_);
}

}  // namespace kerf::motion
