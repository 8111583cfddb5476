#include "firmware/homing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace kerf::firmware {

namespace {

bool has(AxisMask mask, int axis) {
  return ((mask >> static_cast<unsigned>(axis)) & 1U) != 0;
}

}  // namespace

void Homing::begin(AxisMask axes) {
  const HomingRules& rules = board_.personality.homing;
  axes_ = axes;
  approaching_ = true;
  const int passes = rules.passes_setting == 0 ? 1 : static_cast<int>(board_.settings.number(rules.passes_setting));
  moves_left_ = 2 * passes + 2;
  distance_mm_ = 0;
  for (int axis = 0; axis < board_.settings.axes(); ++axis) {
    if (!has(axes, axis)) continue;
    const auto travel = static_cast<float>(board_.settings.number(setting::kMaxTravel, axis));
    distance_mm_ = std::max(distance_mm_, rules.search_scalar * travel);
    if (distance_mm_ == 0.0F) distance_mm_ = rules.endless_search_mm;
  }
  rate_mm_per_min_ = static_cast<float>(board_.settings.number(setting::kHomingSeek));
  begin_move();
}

void Homing::begin_move() {
  // The reported position of these axes counts from 0 in every move (gnea/grbl limits.c).
  AxisSteps position = board_.steps();
  AxisValues target = board_.to_mm(position);
  int axes = 0;
  for (int axis = 0; axis < board_.settings.axes(); ++axis) {
    if (!has(axes_, axis)) continue;
    ++axes;
    const auto at = static_cast<std::size_t>(axis);
    const bool to_minus = board_.settings.flag(setting::kHomingDirection, static_cast<unsigned>(axis)) == approaching_;
    position.at(at) = 0;
    target.at(at) = to_minus ? -distance_mm_ : distance_mm_;
  }
  board_.executor.set_position(position);
  board_.planner.sync_position(position);
  board_.executor.clear_watches();
  // Queued motion may come first: of that, too, only these axes step.
  board_.executor.freeze_axes(static_cast<AxisMask>(board_.all_axes() & ~axes_));
  unlocked_ = axes_;
  moving_ = true;

  const Workcell::Geometry geometry = board_.geometry();
  for (int axis = 0; approaching_ && axis < board_.settings.axes(); ++axis) {
    const auto step = board_.workcell.homing_switch_step(static_cast<std::size_t>(axis), geometry);
    if (!has(axes_, axis) || !step) continue;
    board_.executor.watch({.axis = static_cast<vocabulary::Axis>(axis),
                           .steps = *step,
                           .above = !has(geometry.homing_negative, axis),
                           .seen_by_step_interrupt = board_.personality.homing.switch_sees_pulses,
                           .freezes_axis = true});
  }
  const float rate = rate_mm_per_min_ * std::sqrt(static_cast<float>(axes));
  static_cast<void>(cycle_.take_motion_ended());
  static_cast<void>(cycle_.take_contacts());
  const motion::PathLine line = {.target_mm = target, .feed = {.rate_mm_per_min = rate, .no_override = true}};
  const int passes = board_.personality.loop.homing_to_start;
  const Duration after = passes == 0 ? Duration::zero() : board_.until_pass(passes);
  const auto added = board_.executor.start_system_motion(board_.now, line, motion::SystemMotion::Homing, after);
  if (board_.motion_log && added == motion::Planner::Added::Queued) {
    board_.motion_log->planned(board_.lines_read, board_.planner.system_motion());
  }
  if (added == motion::Planner::Added::Dropped) {
    end_move();
  } else {
    look_at_switches();
  }
}

void Homing::look_at_switches() {
  if (moving_ && approaching_) lock(board_.limits());
}

void Homing::lock(AxisMask axes) {
  const auto left = static_cast<AxisMask>(unlocked_ & ~axes);
  if (left == unlocked_) return;
  unlocked_ = left;
  board_.executor.freeze_axes(static_cast<AxisMask>(board_.all_axes() & ~unlocked_));
  if (unlocked_ == 0) end_move_after(board_.personality.loop.switch_to_stop);
}

void Homing::end_move_after(int passes) {
  if (board_.personality.loop.switch_to_stop == 0) {
    end_move();
  } else if (ends_at_ == kNever) {
    ends_at_ = board_.now + board_.until_pass(passes);
    if (ends_at_ == board_.now) end_move();
  }
}

void Homing::end_move() {
  ends_at_ = kNever;
  moving_ = false;
  if (board_.motion_log) board_.motion_log->ended(board_.now, board_.steps());
  // What was queued before `$H` stays queued, and runs when homing is over.
  board_.executor.reset(board_.now);
  const auto debounce =
      std::chrono::milliseconds{static_cast<std::int64_t>(board_.settings.number(setting::kHomingDebounce))};
  const motion::MotionRules& rules = board_.planner.rules();
  const Duration pause = approaching_ ? Duration::zero() : board_.personality.homing.end_pause;
  settled_at_ = motion::delay_end(rules, motion::delay_end(rules, board_.now, pause), debounce);
}

Homing::Outcome Homing::advance() {
  AxisMask touched = 0;
  for (const auto& contact : cycle_.take_contacts()) {
    touched = static_cast<AxisMask>(touched | vocabulary::mask_of(contact.threshold.axis));
  }
  if (moving_ && approaching_ && touched != 0) lock(touched);
  if (cycle_.take_motion_ended() && moving_ && ends_at_ == kNever) {
    const bool stuck = !approaching_ && (board_.limits() & axes_) != 0;
    if (approaching_ || stuck) {
      failure_ = stuck ? Outcome::SwitchStuck : Outcome::SwitchNotFound;
      settled_at_ = motion::delay_end(board_.planner.rules(), board_.now, board_.personality.homing.end_pause);
    } else {
      end_move_after(0);
    }
  }
  if (failure_ != Outcome::Moving) return board_.now < settled_at_ ? Outcome::Moving : failure_;
  if (ends_at_ <= board_.now) end_move();
  if (moving_ || board_.now < settled_at_) return Outcome::Moving;

  settled_at_ = kNever;
  if (--moves_left_ <= 0) {
    set_position();
    return Outcome::Done;
  }
  approaching_ = !approaching_;
  const auto pull_off = static_cast<float>(board_.settings.number(setting::kHomingPullOff));
  distance_mm_ = approaching_ ? pull_off * board_.personality.homing.locate_scalar : pull_off;
  rate_mm_per_min_ =
      static_cast<float>(board_.settings.number(approaching_ ? setting::kHomingFeed : setting::kHomingSeek));
  begin_move();
  return Outcome::Moving;
}

void Homing::set_position() {
  const auto pull_off = static_cast<float>(board_.settings.number(setting::kHomingPullOff));
  AxisSteps position = board_.steps();
  for (int axis = 0; axis < board_.settings.axes(); ++axis) {
    if (!has(axes_, axis)) continue;
    const auto at = static_cast<std::size_t>(axis);
    const auto travel = static_cast<float>(board_.settings.number(setting::kMaxTravel, axis));
    const bool to_minus = board_.settings.flag(setting::kHomingDirection, static_cast<unsigned>(axis));
    float mm = to_minus ? -travel + pull_off : -pull_off;
    // Rabbit's space is mirrored on axes that home towards minus (motion.md 1.6).
    if (board_.personality.homing.travel == TravelRule::MirroredByDirection) {
      mm = board_.switch_position_mm(axis) + (to_minus ? pull_off : -pull_off);
    }
    if (board_.personality.homing.tracks_axes && board_.settings.flag(setting::kHoming, homing_bit::kOriginZero)) {
      mm = 0;
    }
    board_.home_position_mm.at(at) = mm;
    const float steps = mm * board_.planner.settings().steps_per_mm.at(at);
    position.at(at) =
        static_cast<std::int32_t>(board_.personality.homing.cuts_position ? std::trunc(steps) : std::round(steps));
  }
  board_.executor.set_position(position);
  board_.planner.sync_position(position);
  board_.homed = static_cast<AxisMask>(board_.homed | axes_);
}

}  // namespace kerf::firmware
