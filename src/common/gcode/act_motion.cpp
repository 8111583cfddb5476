#include "common/gcode/acts.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

void move_line(const Block& block, BlockContext& context, Feed feed, bool rapid) {
  feed.rapid = rapid;
  context.out.push_back(LinearMove{.target_mm = block.xyz, .feed = feed});
}

void move_arc(const Block& block, BlockContext& context, const Feed& feed) {
  context.out.push_back(ArcMove{.target_mm = block.xyz,
                                .center_offset_mm = {block.ijk[block.plane.first], block.ijk[block.plane.second]},
                                .radius_mm = block.r,
                                .plane = block.modal.plane,
                                .clockwise = block.clockwise,
                                .turns = block.turns,
                                .feed = feed});
}

/// A straight move of a lathe across the face does not look at the spindle (gcode.c); arcs do `always`.
Feed per_revolution(const Block& block, const BlockContext& context, Feed feed, bool always) {
  constexpr std::size_t kZ = 2;
  feed.per_revolution = block.modal.feed_mode == FeedMode::UnitsPerRevolution;
  feed.synchronized =
      feed.per_revolution && (always || !context.settings.lathe_mode || block.xyz[kZ] != context.state.position_mm[kZ]);
  return feed;
}

/// G33: one turn of the spindle for each pitch.
void move_synchronized(const Block& block, BlockContext& context, Feed feed) {
  feed.rate_mm_per_min = block.k_pitch;
  feed.inverse_time = false;
  feed.no_override = feed.synchronized = true;
  move_line(block, context, feed, false);
}

void probe(const Block& block, BlockContext& context, Feed feed) {
  const MotionMode motion = block.modal.motion;
  feed.no_override = true;
  context.out.push_back(
      ProbeMove{.target_mm = block.xyz,
                .start_mm = context.state.position_mm,
                .feed = feed,
                .away = motion == MotionMode::ProbeAway || motion == MotionMode::ProbeAwayNoError,
                .no_error = motion == MotionMode::ProbeTowardNoError || motion == MotionMode::ProbeAwayNoError});
}

void curve(const Block& block, BlockContext& context, const Feed& feed) {
  const AxisValues& from = context.state.position_mm;
  std::array<float, 2> first{};
  std::array<float, 2> second{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (block.modal.motion == MotionMode::CubicSpline) {
      first[axis] = from[axis] + block.ijk[axis];
      second[axis] = block.xyz[axis] + (axis == 0 ? block.p : block.q);
    } else {
      first[axis] = from[axis] + (block.ijk[axis] * 2.0F) / 3.0F;
      second[axis] = block.xyz[axis] + ((from[axis] + block.ijk[axis] - block.xyz[axis]) * 2.0F) / 3.0F;
    }
  }
  act_cubic_spline(block, context, feed, first, second);
}

void move(Block& block, BlockContext& context) {
  const Feed feed = feed_of(block, context);
  switch (block.modal.motion) {
    case MotionMode::Rapid: move_line(block, context, feed, true); break;
    case MotionMode::Linear: move_line(block, context, per_revolution(block, context, feed, false), false); break;
    case MotionMode::ClockwiseArc:
    case MotionMode::CounterclockwiseArc: move_arc(block, context, per_revolution(block, context, feed, true)); break;
    case MotionMode::SpindleSynchronized: move_synchronized(block, context, feed); break;
    case MotionMode::Thread: act_thread(context, feed); break;
    case MotionMode::ProbeToward:
    case MotionMode::ProbeTowardNoError:
    case MotionMode::ProbeAway:
    case MotionMode::ProbeAwayNoError: probe(block, context, feed); break;
    case MotionMode::CubicSpline:
    case MotionMode::QuadraticSpline: curve(block, context, feed); break;
    case MotionMode::DrillChipBreak:
    case MotionMode::Drill:
    case MotionMode::DrillDwell:
    case MotionMode::DrillPeck: act_canned_cycle(block, context, feed); break;
    // grblHAL accepts G85, G86 and G89 and moves nothing; its parser believes to be at the bottom (gcode.c).
    default: break;
  }
}

}  // namespace

Feed feed_of(const Block& block, const BlockContext& context) {
  const ParserState& state = context.state;
  return {.rate_mm_per_min = state.feed_rate,
          .inverse_time = state.modal.feed_mode == FeedMode::InverseTime,
          .no_override = !state.modal.overrides.feed,
          .spindle_rpm = block.laser_disable ? 0.0F : state.spindle_rpm,
          .spindle = state.modal.spindle,
          .laser_dynamic = context.settings.laser_mode && state.modal.spindle == SpindleDirection::Counterclockwise,
          .line_number = state.line_number};
}

ErrorCode act_motion(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  state.modal.motion = block.modal.motion;
  state.modal.canned_cycle = block.modal.canned_cycle;
  if (block.modal.motion == MotionMode::None || block.axis_command != AxisCommand::Motion) return ErrorCode::Ok;
  move(block, context);
  state.position_mm = block.xyz;
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
