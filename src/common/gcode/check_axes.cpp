#include <cmath>

#include "common/gcode/checks.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

constexpr std::size_t kToolLengthAxis = 2;
constexpr std::uint8_t kFirstLockable = 6;  // G59.1

bool uses_offsets(const Block& block) {
  return block.non_modal != NonModal::AbsoluteOverride;
}

/// L and P of G10 in the order of the firmware; `index` becomes the work offset that is meant.
ErrorCode check_g10_words(const Block& block, const GcodeRules& rules) {
  if (block.axis_words == 0) return ErrorCode::NoAxisWords;
  if (!block.words.has_any("PL")) return ErrorCode::ValueWordMissing;
  const bool l_is_known = block.l == 20 || (block.l == 2 && !block.words.has('R'));
  const std::uint8_t index = to_uint8(std::trunc(block.p));
  const bool p_is_known = index <= rules.work_offsets;
  if (rules.g10_checks_l_first && !l_is_known) return ErrorCode::UnsupportedCommand;
  if (!p_is_known) return ErrorCode::UnsupportedCoordinateSystem;
  return l_is_known ? ErrorCode::Ok : ErrorCode::UnsupportedCommand;
}

/// P1 is G54; P0 the offset that this block selects.
std::uint8_t meant_offset(const Block& block) {
  const std::uint8_t index = to_uint8(std::trunc(block.p));
  return index > 0 ? static_cast<std::uint8_t>(index - 1) : block.modal.work_offset;
}

ErrorCode check_g10(Block& block, BlockContext& context) {
  if (const ErrorCode error = check_g10_words(block, context.rules); error != ErrorCode::Ok) return error;
  block.words.take_all("LP");
  block.stored_index = meant_offset(block);
  block.stored_mm = context.offsets.work[block.stored_index];
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    if (!block.has_axis(axis)) continue;
    float value = block.xyz[axis];
    if (block.l == 20) {
      value = context.state.position_mm[axis] - context.offsets.g92[axis] - value;
      if (axis == kToolLengthAxis) value -= context.offsets.tool_length[axis];
    }
    block.stored_mm[axis] = value;
  }
  return ErrorCode::Ok;
}

/// L1 writes the entry, L10 and L11 take it from where the machine or G59.3 is.
ErrorCode check_tool_entry(Block& block, BlockContext& context, std::uint8_t index) {
  if (!context.knows_tool(static_cast<float>(index))) return ErrorCode::IllegalToolNumber;
  block.stored_index = index;
  Tool entry = context.tools()[index];
  if (block.words.has('R')) {
    entry.radius_mm = block.modal.inches ? inches_to_mm(context.rules.floats, block.r) : block.r;
    block.words.take('R');
  }
  // Orientation and angles of a lathe tool: taken, without use on a mill.
  if (block.words.has('Q') && (!is_whole(block.q) || block.q < 0.0F || block.q > 9.0F)) {
    return ErrorCode::ValueOutOfRange;
  }
  block.words.take_all("IJQ");
  constexpr std::size_t kToolSetter = 8;
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    float& length = entry.length_mm[axis];
    if (!block.has_axis(axis)) {
      if (block.l != 1) length = context.offsets.tool_length[axis];
    } else if (block.l == 1) {
      length = block.xyz[axis];
    } else if (block.l == 10) {
      length = context.state.position_mm[axis] - context.state.work_offset_mm[axis] - context.offsets.g92[axis] -
               block.xyz[axis];
    } else {
      length = context.offsets.work[kToolSetter][axis] - block.xyz[axis];
    }
  }
  block.tool_entry = entry;
  block.words.take_all("LP");
  return ErrorCode::Ok;
}

// Without rotation: L2 and L20, with a tool table also L1, L10 and L11, and P is looked at before L.
ErrorCode check_g10_grblhal(Block& block, BlockContext& context) {
  std::uint8_t index = 0;
  if (block.l > 0) {
    if (block.axis_words == 0 && (block.l == 20 || !block.words.has('R'))) return ErrorCode::NoAxisWords;
    if (!block.words.has_any("PL")) return ErrorCode::ValueWordMissing;
    if (block.p < 0.0F) return ErrorCode::NegativeValue;
    index = static_cast<std::uint8_t>(to_int32(std::trunc(block.p)));
  }
  const bool of_tool = block.l == 1 || block.l == 10 || block.l == 11;
  if (of_tool && context.settings.tools > 0) return check_tool_entry(block, context, index);
  const bool known = block.l == 20 || (block.l == 2 && !block.words.has('R'));
  if (!known) return ErrorCode::UnsupportedCommand;
  if (index > context.rules.work_offsets) return ErrorCode::UnsupportedCoordinateSystem;

  block.stored_index = meant_offset(block);
  block.stored_mm = context.offsets.work[block.stored_index];
  if (block.stored_index >= kFirstLockable &&
      (context.settings.locked_work_offsets >> (block.stored_index - kFirstLockable) & 1U) != 0)
    return ErrorCode::CoordinateSystemLocked;

  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    if (!block.has_axis(axis)) continue;
    const float value = block.xyz[axis];
    block.stored_mm[axis] = block.l == 20 ? context.state.position_mm[axis] - value - context.offsets.g92[axis] -
                                                context.offsets.tool_length[axis]
                                          : value;
  }
  block.words.take_all("LP");
  return ErrorCode::Ok;
}

ErrorCode check_g92(Block& block, BlockContext& context) {
  if (block.axis_words == 0) return ErrorCode::NoAxisWords;
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    if (!block.has_axis(axis)) {
      block.xyz[axis] = context.offsets.g92[axis];
      continue;
    }
    float value = context.state.position_mm[axis] - block.work_offset_mm[axis] - block.xyz[axis];
    // Zero on the axes that have no tool length: x - 0 is x.
    value -= context.offsets.tool_length[axis];
    block.xyz[axis] = value;
  }
  return ErrorCode::Ok;
}

/// Grbl and Rabbit add the tool length last, grblHAL adds all three offsets first: the roundings differ.
void find_target(Block& block, const BlockContext& context, bool sums_offsets_first) {
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    float& value = block.xyz[axis];
    if (!block.has_axis(axis)) {
      value = context.state.position_mm[axis];
    } else if (!uses_offsets(block)) {
      continue;
    } else if (block.modal.incremental) {
      value += context.state.position_mm[axis];
    } else if (sums_offsets_first) {
      value += block_offset(block, context, axis);
    } else {
      value += block.work_offset_mm[axis] + context.offsets.g92[axis];
      if (axis == kToolLengthAxis) value += context.offsets.tool_length[axis];
    }
  }
}

/// G28 and G30 move the named axes on to the stored place; G53 needs G0 or G1.
ErrorCode check_other_non_modal(Block& block, BlockContext& context) {
  if (block.non_modal == NonModal::GoHome28 || block.non_modal == NonModal::GoHome30) {
    block.stored_mm = block.non_modal == NonModal::GoHome28 ? context.offsets.g28 : context.offsets.g30;
    if (block.axis_words == 0) {
      block.axis_command = AxisCommand::None;
      return ErrorCode::Ok;
    }
    for (std::size_t axis = 0; axis < context.axes(); ++axis)
      if (!block.has_axis(axis)) block.stored_mm[axis] = context.state.position_mm[axis];
  }
  if (block.non_modal == NonModal::AbsoluteOverride && block.modal.motion != MotionMode::Rapid &&
      block.modal.motion != MotionMode::Linear)
    return ErrorCode::G53InvalidMotionMode;
  return ErrorCode::Ok;
}

void reset_scaling(ParserState& state) {
  state.scale_factor.fill(1.0F);
  state.modal.scaling = false;
}

/// G51 as Mach3 has it: the axis words are the factors, the centre is zero. Scaling counts as active even with G51 X1.
ErrorCode start_scaling(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (block.axis_words == 0) return ErrorCode::NoAxisWords;
  for (std::size_t axis = 0; axis < context.axes(); ++axis)
    if (block.has_axis(axis)) state.scale_factor[axis] = block.xyz[axis];
  block.axis_words = 0;
  block.words.take_all(vocabulary::kAxisLetters.substr(0, context.axes()));
  state.modal.scaling = true;
  return ErrorCode::Ok;
}

}  // namespace

float block_offset(const Block& block, const BlockContext& context, std::size_t axis) {
  return block.work_offset_mm[axis] + context.offsets.g92[axis] + context.offsets.tool_length[axis];
}

ErrorCode convert_units(Block& block, BlockContext& context) {
  block.plane = axes_of(block.modal.plane);
  // Both halvings and inches are exact or rounded once, so their order does not matter.
  if (block.modal.diameter && block.has_axis(0)) block.xyz[0] *= 0.5F;
  if (!block.modal.inches) return ErrorCode::Ok;
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    const bool turns = (context.settings.rotary_axes >> axis & 1U) != 0;
    if (block.has_axis(axis) && !turns) block.xyz[axis] = inches_to_mm(context.rules.floats, block.xyz[axis]);
  }
  return ErrorCode::Ok;
}

// G50 and G51 act while the block is still being checked (grblHAL gcode.c).
ErrorCode check_scaling(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (block.axis_command == AxisCommand::Scaling) {
    if (!block.scaling_word) {
      reset_scaling(state);
    } else if (const ErrorCode error = start_scaling(block, context); error != ErrorCode::Ok) {
      return error;
    }
  }
  block.modal.scaling = state.modal.scaling;
  if (!state.modal.scaling) return ErrorCode::Ok;
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    if (block.has_axis(axis)) block.xyz[axis] *= state.scale_factor[axis];
  }
  return ErrorCode::Ok;
}

ErrorCode check_tool_length(Block& block, BlockContext&) {
  const bool asks = block.axis_command == AxisCommand::ToolLength && block.modal.tool_length == ToolLengthMode::Dynamic;
  return asks && block.axis_words != 1U << kToolLengthAxis ? ErrorCode::G43DynamicAxisError : ErrorCode::Ok;
}

// G43 without H, or with H0, takes the length of the tool itself.
ErrorCode check_tool_length_grblhal(Block& block, BlockContext& context) {
  const ToolLengthMode mode = block.modal.tool_length;
  if (block.groups.has(Group::G8) && mode == ToolLengthMode::FromTable) {
    if (block.words.has('H')) {
      if (block.h == 0.0F) block.h = block.t;
      if (!context.knows_tool(block.h)) return ErrorCode::IllegalToolNumber;
      block.words.take('H');
    } else if (!block.groups.has(Group::M6)) {
      block.h = block.words.has('T') ? block.t : static_cast<float>(context.state.tool);
    }
  }
  if (block.groups.has(Group::G8) && mode == ToolLengthMode::Additional) {
    if (!block.words.has('H')) return ErrorCode::ValueWordMissing;
    if (block.h == 0.0F || !context.knows_tool(block.h)) return ErrorCode::IllegalToolNumber;
    block.words.take('H');
  }
  const bool asks = block.groups.has(Group::G8) && block.modal.tool_length == ToolLengthMode::Dynamic;
  return asks && block.axis_words == 0 ? ErrorCode::G43DynamicAxisError : ErrorCode::Ok;
}

ErrorCode select_work_offset(Block& block, BlockContext& context) {
  const bool changes = block.groups.has(Group::G12) && block.modal.work_offset != context.state.modal.work_offset;
  block.work_offset_mm = changes ? context.offsets.work[block.modal.work_offset] : context.state.work_offset_mm;
  return ErrorCode::Ok;
}

ErrorCode check_targets(Block& block, BlockContext& context) {
  if (block.non_modal == NonModal::SetData) return check_g10(block, context);
  if (block.non_modal == NonModal::SetCoordinateOffset) return check_g92(block, context);
  if (block.axis_words != 0 && block.axis_command != AxisCommand::ToolLength) find_target(block, context, false);
  return check_other_non_modal(block, context);
}

ErrorCode check_targets_grblhal(Block& block, BlockContext& context) {
  if (block.non_modal == NonModal::SetData) return check_g10_grblhal(block, context);
  if (block.non_modal == NonModal::SetCoordinateOffset) return check_g92(block, context);
  const bool is_arc =
      block.modal.motion == MotionMode::ClockwiseArc || block.modal.motion == MotionMode::CounterclockwiseArc;
  if ((block.axis_words != 0 || is_arc) && block.axis_command != AxisCommand::ToolLength)
    find_target(block, context, true);
  return check_other_non_modal(block, context);
}

}  // namespace kerf::gcode
