// Drilling cycles of grblHAL: G73, G81 to G86, G89.

#include "common/gcode/checks.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

/// The first block of a cycle must say where to retract to and how deep to go.
ErrorCode begin_cycle(const Block& block, BlockContext& context) {
  CannedCycle& cycle = context.state.canned;
  if (context.state.modal.feed_mode == FeedMode::InverseTime) return ErrorCode::InvalidStatement;
  if (!block.words.has('R')) return ErrorCode::ValueWordMissing;
  if (!block.has_axis(block.plane.linear)) return ErrorCode::ValueWordMissing;
  cycle.dwell_s = 0.0F;
  cycle.target_mm[block.plane.first] = cycle.target_mm[block.plane.second] = 0.0F;
  cycle.rapid_retract = true;
  cycle.spindle_off = false;
  return ErrorCode::Ok;
}

void note_positions(const Block& block, BlockContext& context) {
  const ParserState& state = context.state;
  CannedCycle& cycle = context.state.canned;
  const std::size_t linear = block.plane.linear;
  if (block.words.has('R')) {
    const float r = block.modal.inches ? inches_to_mm(context.rules.floats, block.r) : block.r;
    cycle.retract_position_mm =
        r + (block.modal.incremental ? state.position_mm[linear] : block_offset(block, context, linear));
  }
  for (std::size_t axis = context.axes(); axis-- > 0;) {
    if (!block.has_axis(axis)) continue;
    float& target = cycle.target_mm[axis];
    target = block.xyz[axis];
    if (axis != linear) {
      target -= state.position_mm[axis];
    } else if (block.modal.incremental) {
      target = cycle.retract_position_mm + (target - state.position_mm[axis]);
    }
  }
}

ErrorCode note_dwell(Block& block, CannedCycle& cycle) {
  if (!block.words.has('P')) return block.cycle_changes ? ErrorCode::ValueWordMissing : ErrorCode::Ok;
  if (block.p < 0.0F) return ErrorCode::NegativeValue;
  cycle.dwell_s = block.p;
  block.words.take('P');
  return ErrorCode::Ok;
}

ErrorCode note_peck(Block& block, BlockContext& context) {
  CannedCycle& cycle = context.state.canned;
  if (block.words.has('Q')) {
    if (block.q <= 0.0F) return ErrorCode::NegativeValue;
    cycle.delta_mm = block.modal.inches ? inches_to_mm(context.rules.floats, block.q) : block.q;
    block.words.take('Q');
  } else if (block.cycle_changes) {
    return ErrorCode::ValueWordMissing;
  }
  cycle.dwell_s = 0.25F;
  return ErrorCode::Ok;
}

}  // namespace

ErrorCode check_canned_cycle(Block& block, BlockContext& context) {
  CannedCycle& cycle = context.state.canned;
  const std::size_t linear = block.plane.linear;
  if (block.cycle_changes) {
    if (const ErrorCode error = begin_cycle(block, context); error != ErrorCode::Ok) return error;
  }
  if ((block.axis_words & context.settings.rotary_axes) != 0) return ErrorCode::AxisCommandConflict;
  if (!block.words.has('L')) {
    block.l = 1;
  } else if (block.l == 0) {
    return ErrorCode::NonPositiveValue;
  }
  note_positions(block, context);
  if (cycle.retract_position_mm < cycle.target_mm[linear]) return ErrorCode::InvalidRetractPosition;
  block.words.take_all("RL");

  const MotionMode motion = block.modal.motion;
  switch (motion) {
    case MotionMode::DrillChipBreak:
    case MotionMode::DrillPeck: return note_peck(block, context);
    case MotionMode::Tap: return ErrorCode::UnsupportedCommand;  // needs a spindle that reports its speed
    case MotionMode::BoreSpindleStop:
    case MotionMode::BoreDwell:
      cycle.spindle_off = cycle.rapid_retract = motion == MotionMode::BoreSpindleStop;
      [[fallthrough]];
    case MotionMode::DrillDwell:
      if (const ErrorCode error = note_dwell(block, cycle); error != ErrorCode::Ok) return error;
      [[fallthrough]];
    case MotionMode::BoreFeedOut:
    case MotionMode::Drill:
      cycle.delta_mm = -cycle.target_mm[linear] + cycle.retract_position_mm;
      if (motion == MotionMode::BoreFeedOut) cycle.rapid_retract = false;
      return ErrorCode::Ok;
    default: return ErrorCode::Ok;
  }
}

}  // namespace kerf::gcode
