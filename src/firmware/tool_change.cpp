#include "firmware/tool_change.hpp"

#include <algorithm>

namespace kerf::firmware {

using vocabulary::FeedbackText;
using Phase = ToolChangePhase;

namespace {

constexpr unsigned kRestorePosition = 0;
constexpr unsigned kChangeAtG30 = 1;
constexpr unsigned kFastPullOff = 2;
constexpr AxisMask kXyz = 0b111;
constexpr std::size_t kXyzAxes = 3;
constexpr std::size_t kToolSetter = 8;  // G59.3
constexpr float kRetractMm = 2.0F;

Say saying(const Board& board, FeedbackText text) {
  return {.message =
              protocol::Feedback{.text = std::string{vocabulary::feedback_text(board.personality.firmware, text)}}};
}

}  // namespace

ToolChange::Mode ToolChange::mode() const {
  return static_cast<Mode>(board_.settings.mask(setting::kToolChangeMode));
}

bool ToolChange::option(unsigned bit) const {
  return board_.settings.flag(setting::kToolChangeOptions, bit);
}

void ToolChange::rapid_to(Steps& steps, const AxisValues& target_mm) {
  steps.emplace_back(PlanMove{.move = {.target_mm = target_mm, .feed = {.rapid = true}}});
}

void ToolChange::feed_to(Steps& steps, const AxisValues& target_mm, float rate_mm_per_min) {
  steps.emplace_back(PlanMove{.move = {.target_mm = target_mm, .feed = {.rate_mm_per_min = rate_mm_per_min}}});
}

void ToolChange::probe_to(Steps& steps, float rate_mm_per_min, bool away, bool no_error) {
  steps.insert(steps.end(), {Synchronize{}, Probe{.move = {.target_mm = target_mm_,
                                                           .start_mm = board_.position_mm(),
                                                           .feed = {.rate_mm_per_min = rate_mm_per_min},
                                                           .away = away,
                                                           .no_error = no_error}}});
}

void ToolChange::raise(Steps& steps) {
  target_mm_ = board_.position_mm();
  if (target_mm_.at(axes_.linear) == home_of_linear_axis()) return;
  target_mm_.at(axes_.linear) = home_of_linear_axis();
  rapid_to(steps, target_mm_);
}

void ToolChange::go_to_tool_setter(Steps& steps) {
  const AxisValues& setter = board_.interpreter.offsets().work.at(kToolSetter);
  std::copy_n(setter.begin(), kXyzAxes, target_mm_.begin());
  const float depth = target_mm_.at(axes_.linear);
  target_mm_.at(axes_.linear) = home_of_linear_axis();
  rapid_to(steps, target_mm_);
  target_mm_.at(axes_.linear) = depth;
  rapid_to(steps, target_mm_);
}

Steps ToolChange::begin() {
  if (!moves()) return {EnterToolChange{}};
  awaits_touch_off_ = mode() != Mode::Automatic;
  is_under_way_ = false;
  axes_ = gcode::axes_of(board_.interpreter.state().modal.plane);
  board_.set_accessories({});
  previous_mm_ = board_.position_mm();
  previous_mm_.at(axes_.linear) -= board_.interpreter.work_coordinate_offset().at(axes_.linear);
  at_g30_ = option(kChangeAtG30) && (board_.homed & kXyz) == kXyz;

  Steps steps;
  raise(steps);
  if (at_g30_) {
    const AxisValues& place = board_.interpreter.offsets().g30;
    AxisValues above = target_mm_;
    above.at(axes_.first) = place.at(axes_.first);
    above.at(axes_.second) = place.at(axes_.second);
    if (above != target_mm_) rapid_to(steps, above);
    target_mm_ = above;
    if (target_mm_.at(axes_.linear) != place.at(axes_.linear)) {
      target_mm_.at(axes_.linear) = place.at(axes_.linear);
      rapid_to(steps, target_mm_);
    }
  } else if (mode() == Mode::AtToolSetter) {
    go_to_tool_setter(steps);
  }
  steps.insert(steps.end(), {Synchronize{}, ContinueToolChange{Phase::AtPlace}});
  return steps;
}

Steps ToolChange::on_cycle_start() {
  if (is_under_way_) return {};
  if (awaits_touch_off_ && !at_g30_) {
    Say warning = saying(board_, FeedbackText::ProbeToolFirst);
    auto& text = std::get<protocol::Feedback>(warning.message).text;
    text.insert(0, "Warning: ");
    return {std::move(warning)};
  }
  is_under_way_ = true;
  if (awaits_touch_off_) return leave_g30();
  return mode() == Mode::Automatic ? touch_off() : way_back();
}

Steps ToolChange::leave_g30() {
  Steps steps;
  raise(steps);
  if (mode() == Mode::AtToolSetter) {
    go_to_tool_setter(steps);
  } else {
    target_mm_.at(axes_.first) = previous_mm_.at(axes_.first);
    target_mm_.at(axes_.second) = previous_mm_.at(axes_.second);
    rapid_to(steps, target_mm_);
  }
  steps.insert(steps.end(), {Synchronize{}, ContinueToolChange{Phase::LeftG30}});
  return steps;
}

// The probe goes down from the tool setter, but never out of the travel of a homed axis.
void ToolChange::aim_below(float distance_mm) {
  float& depth = target_mm_.at(axes_.linear);
  depth = board_.within_travel(static_cast<int>(axes_.linear), depth - distance_mm);
}

Steps ToolChange::touch_off() {
  Steps steps;
  const AxisValues& setter = board_.interpreter.offsets().work.at(kToolSetter);
  if (at_g30_) raise(steps);
  target_mm_.at(axes_.first) = setter.at(axes_.first);
  target_mm_.at(axes_.second) = setter.at(axes_.second);
  rapid_to(steps, target_mm_);
  target_mm_.at(axes_.linear) = setter.at(axes_.linear);
  rapid_to(steps, target_mm_);
  aim_below(number(setting::kToolProbeDistance));
  probe_to(steps, number(setting::kToolProbeSeek), false, false);
  steps.emplace_back(ContinueToolChange{Phase::SetterFound});
  return steps;
}

// Slowly off the plate, or a little up and slowly down again.
Steps ToolChange::after_first_contact(Phase next, bool no_error) {
  Steps steps;
  target_mm_ = board_.interpreter.offsets().probe;
  target_mm_.at(axes_.linear) += kRetractMm;
  const bool away = option(kFastPullOff);
  if (!away) {
    feed_to(steps, target_mm_, number(setting::kToolProbePullOff));
    target_mm_.at(axes_.linear) -= kRetractMm + 2.0F;
  }
  probe_to(steps, number(setting::kToolProbeFeed), away, no_error);
  steps.emplace_back(ContinueToolChange{next});
  return steps;
}

void ToolChange::take_length() {
  const float length = board_.interpreter.offsets().probe.at(axes_.linear) - board_.tool_reference_mm.at(axes_.linear);
  const bool changes = board_.interpreter.offsets().tool_length.at(axes_.linear) != length;
  board_.interpreter.set_tool_length(axes_.linear, length);
  if (!changes) return;
  board_.owe_work_offset();
  board_.report.tool_offset = true;
}

Steps ToolChange::after_second_contact() {
  const auto bit = static_cast<AxisMask>(1U << axes_.linear);
  if ((board_.tool_reference_axes & bit) == 0) {
    board_.tool_reference_mm.at(axes_.linear) = board_.interpreter.offsets().probe.at(axes_.linear);
    board_.tool_reference_axes = static_cast<AxisMask>(board_.tool_reference_axes | bit);
    board_.report.tool_reference = true;
    board_.say(FeedbackText::ReferenceToolEstablished);
  } else {
    take_length();
  }
  return way_back();
}

Steps ToolChange::way_back() {
  Steps steps;
  target_mm_ = board_.position_mm();
  target_mm_.at(axes_.linear) = home_of_linear_axis();
  rapid_to(steps, target_mm_);
  const bool elsewhere = target_mm_.at(axes_.first) != previous_mm_.at(axes_.first) ||
                         target_mm_.at(axes_.second) != previous_mm_.at(axes_.second);
  if (option(kRestorePosition) && elsewhere) {
    target_mm_ = previous_mm_;
    target_mm_.at(axes_.linear) = home_of_linear_axis();
    rapid_to(steps, target_mm_);
  }
  steps.insert(steps.end(), {Synchronize{}, ContinueToolChange{Phase::AboveWork}});
  return steps;
}

Steps ToolChange::restart_outputs() {
  board_.sync_position();
  Steps steps;
  const gcode::ParserState& state = board_.interpreter.state();
  const gcode::Coolant& coolant = state.modal.coolant;
  if (coolant.flood || coolant.mist) {
    steps.emplace_back(Perform{.action = gcode::CoolantChange{.flood = coolant.flood, .mist = coolant.mist}});
    steps.emplace_back(board_.delay_step(setting::kCoolantOnDelay));
  }
  // A remembered speed counts as something to bring back, even with the spindle off.
  if (state.modal.spindle != gcode::SpindleDirection::Off || state.spindle_rpm != 0.0F) {
    steps.emplace_back(
        Perform{.action = gcode::SpindleChange{.direction = state.modal.spindle, .rpm = state.spindle_rpm}});
    steps.emplace_back(board_.delay_step(setting::kSpindleOnDelay));
  }
  if (option(kRestorePosition)) {
    previous_mm_.at(axes_.linear) += board_.interpreter.work_coordinate_offset().at(axes_.linear);
    rapid_to(steps, previous_mm_);
  }
  steps.insert(steps.end(), {Synchronize{}, ContinueToolChange{Phase::Back}});
  return steps;
}

std::expected<Steps, ErrorCode> ToolChange::probe_plate() {
  const bool by_hand = mode() == Mode::ManualTouchOff || mode() == Mode::AtToolSetter;
  if (!by_hand || !board_.changes_tool || !board_.tool_acknowledged) {
    return std::unexpected(ErrorCode::InvalidStatement);
  }
  if (at_g30_) return Steps{saying(board_, FeedbackText::PositionForTouchOff), Answer{}};
  target_mm_ = board_.position_mm();
  aim_below(number(setting::kToolProbeDistance));
  Steps steps;
  probe_to(steps, number(setting::kToolProbeSeek), false, true);
  steps.emplace_back(ContinueToolChange{Phase::PlateFound});
  return steps;
}

Steps ToolChange::plate_failed() {
  board_.say(FeedbackText::ProbeFailed);
  board_.interpreter.sync_position(parser_place_mm_);
  return {Answer{.code = ErrorCode::ToolUnknown}};
}

Steps ToolChange::after_plate() {
  Steps steps;
  target_mm_ = board_.interpreter.offsets().probe;
  float& height = target_mm_.at(axes_.linear);
  height = std::min(height + kRetractMm * 2.0F, home_of_linear_axis());
  feed_to(steps, target_mm_, number(setting::kToolProbeSeek));
  steps.insert(steps.end(), {Synchronize{}, ContinueToolChange{Phase::PlateDone}});
  return steps;
}

Steps ToolChange::go_on(Phase phase) {
  const bool found = board_.interpreter.offsets().probe_succeeded;
  const auto measured = static_cast<AxisMask>(board_.tool_reference_axes & (1U << axes_.linear));
  switch (phase) {
    case Phase::AtPlace:
      board_.sync_position();
      parser_place_mm_ = board_.position_mm();
      board_.report.tool = true;
      return {EnterToolChange{}};
    case Phase::LeftG30:
      board_.sync_position();
      at_g30_ = is_under_way_ = false;
      return {};
    case Phase::SetterFound:
      if (found) return after_first_contact(Phase::SetterMeasured, false);
      fail();
      return {};
    case Phase::SetterMeasured:
      if (found) return after_second_contact();
      fail();
      return {};
    case Phase::AboveWork: return restart_outputs();
    case Phase::Back:
      board_.sync_position();
      if (mode() == Mode::Automatic) return {FinishToolChange{}};
      return {Say{.message = protocol::Feedback{}}, FinishToolChange{}};
    case Phase::PlateFound:
      if (!found) return plate_failed();
      if (measured != 0) take_length();
      return after_first_contact(Phase::PlateMeasured, true);
    case Phase::PlateMeasured:
      if (!found) return plate_failed();
      if (measured != 0) take_length();
      return after_plate();
    case Phase::PlateDone:
      board_.sync_position();
      awaits_touch_off_ = false;
      board_.say(mode() == Mode::AtToolSetter ? FeedbackText::PressCycleStart : FeedbackText::RemoveTouchPlate);
      return {Answer{}};
  }
  return {};
}

// The parser goes on as if the machine were still at the place of the change.
void ToolChange::fail() {
  board_.interpreter.sync_position(parser_place_mm_);
  abandon();
}

void ToolChange::abandon() {
  board_.interpreter.abort_tool_change();
  board_.changes_tool = false;
  is_under_way_ = false;
}

}  // namespace kerf::firmware
