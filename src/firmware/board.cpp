#include "firmware/board.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/vocabulary/travel.hpp"

namespace kerf::firmware {

using gcode::StoredOffset;
using vocabulary::FeedbackText;

namespace {

constexpr std::array<std::string_view, 12> kOffsetNames = {"G54",   "G55",   "G56",   "G57", "G58", "G59",
                                                           "G59.1", "G59.2", "G59.3", "G28", "G30", "G92"};

std::size_t index_of(StoredOffset which) {
  return static_cast<std::size_t>(which);
}

AxisValues& offset_of(gcode::Offsets& offsets, StoredOffset which) {
  switch (which) {
    case StoredOffset::G28: return offsets.g28;
    case StoredOffset::G30: return offsets.g30;
    case StoredOffset::G92: return offsets.g92;
    default: return offsets.work.at(index_of(which));
  }
}

/// More than any planner holds (grblHAL $398 goes to 1000).
constexpr std::size_t kMostBlocks = 1024;

vocabulary::Travel travel_of(const Board& board, int axis) {
  const auto& settings = board.settings;
  const bool has_hard_limits = settings.flag(setting::kHardLimits);
  return vocabulary::travel_of(
      vocabulary::travel_rule_of(board.personality.dialect().firmware),
      {.length_mm = static_cast<float>(settings.number(setting::kMaxTravel, axis)),
       .homes_to_minus = settings.flag(setting::kHomingDirection, static_cast<unsigned>(axis)),
       .switch_at_mm = board.switch_position_mm(axis),
       .pull_off_mm = has_hard_limits ? static_cast<float>(settings.number(setting::kHomingPullOff)) : 0.0F,
       .zero_at_switch = settings.flag(setting::kHoming, homing_bit::kOriginZero)});
}

bool is_guarded(const Board& board, int axis) {
  if (board.settings.number(setting::kMaxTravel, axis) <= 0) return false;
  return !board.personality.homing.tracks_axes || ((board.homed >> static_cast<unsigned>(axis)) & 1U) != 0;
}

}  // namespace

std::string_view name_of(StoredOffset which) {
  return kOffsetNames.at(index_of(which));
}

Board::Board(const Personality& owner, StoredState remembered, Equipment fitted)
    : personality(owner),
      stored(std::move(remembered)),
      settings(owner, axes_of(owner, stored)),
      rejected_settings(settings.load(stored)),
      outbox(protocol::style_of(owner.dialect())),
      interpreter(gcode::rules_for(owner.dialect())),
      planner(motion::rules_of(owner.firmware), settings.motion()),
      executor(planner, motion::rules_of(owner.firmware)),
      equipment(std::move(fitted)),
      slot{.card = equipment.card},
      memory(owner.hardware.slow_memory ? owner.memory_byte_time : Duration::zero()),
      block_targets_mm(kMostBlocks) {
  if (equipment.pendant) outbox.fit_pendant();
  interpreter.watch(facts);
  apply_settings();
  load_offsets();
}

void Board::plan(const AxisValues& target_mm, const gcode::Feed& feed) {
  ++blocks_planned;
  be_busy(personality.loop.for_block);
  block_targets_mm.at(blocks_planned % kMostBlocks) = target_mm;
  plan_line({.target_mm = target_mm, .feed = feed, .source_line = blocks_planned});
}

void Board::plan_line(const motion::PathLine& line) {
  executor.prepare();
  const auto added = planner.plan(line);
  if (motion_log && added == motion::Planner::Added::Queued) {
    motion_log->planned(lines_read, planner.at(planner.block_count() - 1));
  }
  // Without a block the message does not wait.
  const bool waits_for_it = !motion_messages.empty() && motion_messages.back().block == blocks_planned;
  if (added == motion::Planner::Added::Dropped && waits_for_it) {
    say(protocol::Feedback{.text = motion_messages.back().text});
    motion_messages.pop_back();
  }
}

Duration Board::until_pass(int passes) const {
  const Duration pass = personality.loop.pass;
  const Instant free_at = std::max(busy_until, now);
  const auto seen = (free_at - Instant{} + pass - Duration{1}) / pass;
  return Instant{} + (seen + passes) * pass - now;
}

std::optional<AxisValues> Board::note_turn(const AxisValues& target_mm) {
  if (!personality.takes_up_backlash) return std::nullopt;
  return backlash.turn_to(target_mm, settings.axis_values(setting::kBacklash));
}

void Board::plan_take_up(const AxisValues& target_mm, const gcode::Feed& feed) {
  gcode::Feed fast = feed;
  fast.rapid = fast.inverse_time = fast.no_override = false;
  fast.rate_mm_per_min = Backlash::kFeedMmPerMin;
  plan_line({.target_mm = target_mm, .feed = fast, .source_line = blocks_planned, .is_backlash = true});
}

void Board::say(const protocol::Message& message) {
  // Rabbit tells nothing in brackets below level 3, "Info" (SourceRabbit/RabbitGRBL Report.cpp).
  constexpr double kTellingLevel = 3.0;
  const bool may_be_quiet = personality.names_settings && std::holds_alternative<protocol::Feedback>(message);
  if (may_be_quiet && settings.number("Message/Level") < kTellingLevel) return;
  outbox.say(message);
}

Duration Board::switching_pause(const Accessories& wanted, bool coolant_word) const {
  if (!personality.waits_after_switching) return {};
  double seconds = 0;
  // SourceRabbit/RabbitGRBL PWMSpindle.cpp: every change of direction, off being one; a laser never waits.
  if (wanted.spindle != accessories.spindle && !settings.motion().laser_mode) {
    const bool off = wanted.spindle == gcode::SpindleDirection::Off;
    seconds += settings.number(off ? setting::kSpindleDownDelay : setting::kSpindleUpDelay);
  }
  // Coolant.cpp: M7 and M8 wait although it is on.
  if (coolant_word && wanted.flood && (!accessories.flood || !wanted.mist || accessories.mist)) {
    seconds += settings.number(setting::kFloodDelay);
  } else if (coolant_word && wanted.mist) {
    seconds += settings.number(setting::kMistDelay);
  }
  return base::from_seconds(seconds);
}

void Board::say(FeedbackText text) {
  say(protocol::Feedback{.text = std::string{vocabulary::feedback_text(personality.firmware, text)}});
}

bool Board::raise_alarm(vocabulary::AlarmCode code) {
  const bool known = state == MachineState::Alarm && alarm == vocabulary::number_of(code);
  alarm = vocabulary::number_of(code);
  state = MachineState::Alarm;
  if (known && personality.start.same_alarm_is_silent) return false;
  say(protocol::AlarmRaised{.code = alarm});
  return true;
}

bool Board::reports(vocabulary::ReportBit bit) const {
  return vocabulary::has(settings.mask(setting::kReportMask), bit);
}

AxisSteps Board::to_steps(const AxisValues& mm) const {
  AxisSteps steps{};
  const AxisValues& steps_per_mm = planner.settings().steps_per_mm;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings.axes()); ++axis) {
    steps.at(axis) = static_cast<std::int32_t>(std::lround(mm.at(axis) * steps_per_mm.at(axis)));
  }
  return steps;
}

AxisValues Board::to_mm(const AxisSteps& steps) const {
  AxisValues mm{};
  const AxisValues& steps_per_mm = planner.settings().steps_per_mm;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(settings.axes()); ++axis) {
    mm.at(axis) = static_cast<float>(steps.at(axis)) / steps_per_mm.at(axis);
  }
  return mm;
}

AxisValues Board::position_mm() const {
  return to_mm(steps());
}

AxisMask Board::limits() const {
  const AxisSteps motors =
      personality.homing.switch_sees_pulses ? executor.pulsed_steps_at(now) : executor.motor_steps_at(now);
  return workcell.limits_at(motors, geometry());
}

bool Board::probe_triggered() const {
  return workcell.probe_at(executor.motor_steps_at(now), geometry());
}

std::vector<AxisMask> Board::homing_cycles() const {
  std::vector<AxisMask> cycles;
  const HomingRules& rules = personality.homing;
  if (rules.cycle_setting == 0) {
    std::ranges::copy_if(rules.fixed_cycles, std::back_inserter(cycles), [](auto mask) { return mask != 0; });
    return cycles;
  }
  for (int index = 0; index < rules.cycle_settings; ++index) {
    const auto mask = static_cast<AxisMask>(settings.mask(rules.cycle_setting + index) & all_axes());
    if (mask != 0) cycles.push_back(mask);
  }
  return cycles;
}

AxisMask Board::homing_axes() const {
  AxisMask axes = 0;
  for (const AxisMask cycle : homing_cycles()) axes = static_cast<AxisMask>(axes | cycle);
  return axes;
}

float Board::switch_position_mm(int axis) const {
  if (!personality.names_settings) return 0.0F;
  const std::string name = std::string(1, vocabulary::kAxisLetters[static_cast<std::size_t>(axis)]) + "/Home/Mpos";
  return static_cast<float>(settings.number(name));
}

bool Board::is_within_travel(const AxisValues& target_mm) const {
  for (int axis = 0; axis < settings.axes(); ++axis) {
    if (!is_guarded(*this, axis)) continue;
    const vocabulary::Travel travel = travel_of(*this, axis);
    const float target = target_mm.at(static_cast<std::size_t>(axis));
    if (target < travel.min_mm || target > travel.max_mm) return false;
  }
  return true;
}

AxisValues Board::clipped_to_travel(const AxisValues& target_mm) const {
  const AxisValues& from = interpreter.state().position_mm;
  // The whole vector is shortened, so that the jog keeps its direction (grblHAL clip_3d_target).
  float part = 1.0F;
  for (int axis = 0; axis < settings.axes(); ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const float distance = target_mm.at(at) - from.at(at);
    if (!is_guarded(*this, axis) || distance == 0.0F) continue;
    const vocabulary::Travel travel = travel_of(*this, axis);
    const float end = std::clamp(target_mm.at(at), travel.min_mm, travel.max_mm);
    part = std::min(part, std::max(0.0F, (end - from.at(at)) / distance));
  }
  AxisValues clipped = target_mm;
  if (part >= 1.0F) return clipped;
  for (std::size_t axis = 0; axis < clipped.size(); ++axis) {
    clipped.at(axis) = from.at(axis) + (target_mm.at(axis) - from.at(axis)) * part;
  }
  return clipped;
}

float Board::within_travel(int axis, float mm) const {
  if (((homed >> static_cast<unsigned>(axis)) & 1U) == 0 || settings.number(setting::kMaxTravel, axis) <= 0) return mm;
  const vocabulary::Travel travel = travel_of(*this, axis);
  return std::clamp(mm, travel.min_mm, travel.max_mm);
}

Dwell Board::delay_step(int delay_setting) const {
  return {.left = motion::dwell_duration(planner.rules(), static_cast<float>(settings.number(delay_setting)))};
}

float Board::spindle_rpm() const {
  if (accessories.spindle == gcode::SpindleDirection::Off) return 0;
  float rpm = accessories.programmed_rpm;
  if (const auto dynamic = executor.dynamic_rpm()) {
    rpm = *dynamic;
  } else if (planner.settings().laser_mode && planner.current() != nullptr) {
    rpm = planner.current()->feed.spindle_rpm;
  }
  if (overrides.spindle_acts) rpm *= static_cast<float>(overrides.spindle) / 100.0F;
  if (rpm <= 0) return 0;
  return std::clamp(rpm, static_cast<float>(settings.number(setting::kSpindleMin)),
                    std::max(static_cast<float>(settings.number(setting::kSpindleMin)),
                             static_cast<float>(settings.number(setting::kSpindleMax))));
}

void Board::follow_spindle() {
  if (!settings.has_spindle_encoder()) return;
  const double turning = static_cast<double>(spindle_rpm()) * workcell.spindle_share();
  const double rpm = workcell.is_encoder_plugged() ? turning : 0.0;
  if (rpm == encoder.rpm()) return;
  encoder.turn(now, rpm);
  planner.set_spindle_rpm(static_cast<float>(rpm));
}

bool Board::is_spindle_at_speed() const {
  constexpr double kPercent = 0.01;
  const double wanted = static_cast<double>(spindle_rpm());
  const double tolerance = settings.number(setting::kSpindleAtSpeedTolerance) * kPercent;
  return encoder.rpm() >= wanted * (1 - tolerance) && encoder.rpm() <= wanted * (1 + tolerance);
}

void Board::sync_position() {
  planner.sync_position(steps());
  interpreter.sync_position(position_mm());
}

void Board::flush_motion() {
  if (motion_log && executor.executing() != nullptr) motion_log->ended(now, steps());
  planner.clear();
  executor.reset(now);
  motion_messages.clear();
  sync_position();
}

void Board::apply_settings() {
  const motion::MotionSettings motion = settings.motion();
  const bool rescaled = motion.steps_per_mm != planner.settings().steps_per_mm;
  planner.set_settings(motion);
  settings.configure(interpreter.settings());
  interpreter.settings().block_delete = switches.block_delete;
  interpreter.settings().optional_stop_disabled = switches.optional_stop_disabled;
  outbox.set_style(protocol::style_of(personality.dialect(), settings.flag(setting::kReportInches)));
  geometry_ = {.axes = static_cast<std::size_t>(settings.axes()),
               .steps_per_mm = motion.steps_per_mm,
               .travel_mm = settings.axis_values(setting::kMaxTravel),
               .homing_negative = static_cast<AxisMask>(settings.mask(setting::kHomingDirection))};
  guards_hard_limits_ = settings.flag(setting::kHardLimits);
  guards_soft_limits_ = settings.flag(setting::kSoftLimits);
  if (rescaled) sync_position();
}

void Board::apply_overrides() {
  planner.set_overrides(overrides.feed_acts ? overrides.feed : 100, overrides.feed_acts ? overrides.rapid : 100);
  follow_spindle();
}

void Board::set_accessories(const Accessories& wanted) {
  if (wanted == accessories) return;
  accessories = wanted;
  owe_accessories();
  follow_spindle();
}

void Board::owe_work_offset() {
  report.work_offset = true;
  if (!personality.status.counts_changes) report.work_offset_counter = 0;
}

void Board::owe_overrides() {
  report.overrides = true;
  if (!personality.status.counts_changes) report.override_counter = 0;
}

void Board::owe_accessories() {
  report.accessories = true;
  if (!personality.status.counts_changes) report.override_counter = 0;
}

void Board::store_settings(int bytes) {
  memory.write(now, bytes);
  settings.save(stored);
  stored.initialised = true;
  ++stored_revision;
}

void Board::store_offset(StoredOffset which) {
  const AxisValues& values = offset_of(interpreter.offsets(), which);
  const auto axes = static_cast<std::ptrdiff_t>(settings.axes());
  // The bytes of three floats and a check sum, of which half change as a rule.
  memory.write(now, 7);
  stored.offsets.insert_or_assign(std::string{name_of(which)},
                                  std::vector<double>(values.begin(), values.begin() + axes));
  ++stored_revision;
}

void Board::store_tool(int tool) {
  const gcode::Tool& entry = interpreter.offsets().tools.at(static_cast<std::size_t>(tool));
  const auto axes = static_cast<std::ptrdiff_t>(settings.axes());
  StoredTool kept{.length_mm = {entry.length_mm.begin(), entry.length_mm.begin() + axes},
                  .radius_mm = static_cast<double>(entry.radius_mm)};
  stored.tools.insert_or_assign(tool, std::move(kept));
  ++stored_revision;
}

void Board::load_offsets() {
  interpreter.offsets() = gcode::Offsets{};
  interpreter.offsets().tools.resize(static_cast<std::size_t>(personality.hardware.tools) + 1);
  for (const auto& [number, kept] : stored.tools) {
    if (number < 1 || number > personality.hardware.tools) continue;
    gcode::Tool& entry = interpreter.offsets().tools.at(static_cast<std::size_t>(number));
    entry.radius_mm = static_cast<float>(kept.radius_mm);
    const std::size_t count = std::min(entry.length_mm.size(), kept.length_mm.size());
    for (std::size_t axis = 0; axis < count; ++axis)
      entry.length_mm.at(axis) = static_cast<float>(kept.length_mm.at(axis));
  }
  for (std::size_t index = 0; index < kOffsetNames.size(); ++index) {
    const auto found = stored.offsets.find(kOffsetNames.at(index));
    if (found == stored.offsets.end()) continue;
    const auto which = static_cast<StoredOffset>(index);
    if (which == StoredOffset::G92 && settings.flag(setting::kG92Volatile)) continue;
    AxisValues& values = offset_of(interpreter.offsets(), which);
    const std::size_t count = std::min(values.size(), found->second.size());
    for (std::size_t axis = 0; axis < count; ++axis) values.at(axis) = static_cast<float>(found->second.at(axis));
  }
  interpreter.reload_offsets();
}

}  // namespace kerf::firmware
