#pragma once
// The checks of a block, one step each; rules.cpp puts them into each firmware's order. Steps compute what execution
// needs (targets in machine coordinates, arc centres) on the way. Where grblHAL changes its own state while it still
// checks, so do the steps.

#include "common/gcode/block.hpp"

namespace kerf::gcode {

// check_words.cpp: everything that is not geometry.
ErrorCode check_macro_words(Block& block, BlockContext& context);
ErrorCode check_implicit_motion(Block& block, BlockContext& context);
ErrorCode check_tool_change_pending(Block& block, BlockContext& context);
ErrorCode check_line_number(Block& block, BlockContext& context);
ErrorCode check_tool_and_length_numbers(Block& block, BlockContext& context);
ErrorCode check_feed(Block& block, BlockContext& context);
ErrorCode check_feed_grblhal(Block& block, BlockContext& context);
ErrorCode check_spindle_speed(Block& block, BlockContext& context);
ErrorCode check_spindle_grblhal(Block& block, BlockContext& context);
ErrorCode check_tool_set(Block& block, BlockContext& context);
ErrorCode check_overrides(Block& block, BlockContext& context);
/// G96 and G97, and what S means with them (lathe).
ErrorCode check_surface_speed_mode(Block& block, BlockContext& context);
void set_surface_speed(Block& block, BlockContext& context);
ErrorCode forget_unchanged_modes(Block& block, BlockContext& context);
ErrorCode check_dwell(Block& block, BlockContext& context);
ErrorCode check_ports(Block& block, BlockContext& context);
ErrorCode check_pins(Block& block, BlockContext& context);
ErrorCode check_unused_words(Block& block, BlockContext& context);
ErrorCode check_jog_words(Block& block, BlockContext& context);

// check_thread.cpp: motions that follow the spindle, where it has an encoder.
ErrorCode check_thread(Block& block, BlockContext& context);

// check_axes.cpp: units, scaling, offsets, targets.
ErrorCode convert_units(Block& block, BlockContext& context);
ErrorCode check_scaling(Block& block, BlockContext& context);
ErrorCode check_tool_length(Block& block, BlockContext& context);
ErrorCode check_tool_length_grblhal(Block& block, BlockContext& context);
ErrorCode select_work_offset(Block& block, BlockContext& context);
ErrorCode check_targets(Block& block, BlockContext& context);
ErrorCode check_targets_grblhal(Block& block, BlockContext& context);

// check_motion.cpp and check_cycle.cpp: motion modes.
ErrorCode check_motion(Block& block, BlockContext& context);
ErrorCode check_motion_grblhal(Block& block, BlockContext& context);
ErrorCode check_canned_cycle(Block& block, BlockContext& context);

/// Work offset, G92 and tool length on one axis, with the block's own work offset.
[[nodiscard]] float block_offset(const Block& block, const BlockContext& context, std::size_t axis);

}  // namespace kerf::gcode
