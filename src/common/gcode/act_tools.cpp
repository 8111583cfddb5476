// Tool lengths and grblHAL's tool table.

#include "common/gcode/acts.hpp"

namespace kerf::gcode {

void set_tool_length(const AxisValues& value, BlockContext& context) {
  if (context.offsets.tool_length == value) return;
  context.offsets.tool_length = value;
  context.out.push_back(WorkOffsetChange{});
}

// What L10 and L11 find out is lost, except for entry 0: every look at another entry reads the storage anew, and only
// L1 writes there (grblHAL gcode.c, settings.c settings_get_tool_data).
void write_tool_entry(const Block& block, BlockContext& context) {
  if (block.l != 1 && block.stored_index != 0) return;
  context.tools()[block.stored_index] = *block.tool_entry;
  if (block.stored_index != 0) context.out.push_back(ToolTableWrite{.tool = block.stored_index});
}

// Every axis may have a tool length; G43.1 changes those that it names, G43.2 adds to all.
ErrorCode act_tool_length_grblhal(Block& block, BlockContext& context) {
  if (!block.groups.has(Group::G8)) return ErrorCode::Ok;
  const ToolLengthMode mode = block.modal.tool_length;
  context.state.modal.tool_length = mode;
  context.state.arriving_length.reset();
  AxisValues length{};
  if (mode == ToolLengthMode::FromTable) {
    length = context.tools()[static_cast<std::size_t>(block.h)].length_mm;
  } else if (mode != ToolLengthMode::None) {
    length = context.offsets.tool_length;
  }
  for (std::size_t axis = 0; axis < context.axes(); ++axis) {
    if (mode == ToolLengthMode::Dynamic && block.has_axis(axis)) length[axis] = block.xyz[axis];
    if (mode == ToolLengthMode::Additional) {
      length[axis] += context.tools()[static_cast<std::size_t>(block.h)].length_mm[axis];
    }
  }
  set_tool_length(length, context);
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
