#pragma once
// Carrying out a block that passed its checks, one step each; rules.cpp puts them into each firmware's order. Steps
// change the parser state and append actions.

#include "common/gcode/block.hpp"

namespace kerf::gcode {

/// Puts a tool length in force; a status report owes the change.
void set_tool_length(const AxisValues& value, BlockContext& context);
/// Carries out G10 L1, L10 or L11.
void write_tool_entry(const Block& block, BlockContext& context);

// act_modes.cpp: modes, spindle, tools, offsets, program flow.
ErrorCode act_macro(Block& block, BlockContext& context);
ErrorCode act_laser(Block& block, BlockContext& context);
ErrorCode act_feed(Block& block, BlockContext& context);
ErrorCode act_spindle_speed(Block& block, BlockContext& context);
ErrorCode act_tool_number(Block& block, BlockContext& context);
ErrorCode act_tool_select(Block& block, BlockContext& context);
ErrorCode act_tool_change(Block& block, BlockContext& context);
ErrorCode act_spindle(Block& block, BlockContext& context);
ErrorCode act_saved_state(Block& block, BlockContext& context);
ErrorCode act_coolant(Block& block, BlockContext& context);
ErrorCode act_ports(Block& block, BlockContext& context);
ErrorCode act_pins(Block& block, BlockContext& context);
ErrorCode act_overrides(Block& block, BlockContext& context);
ErrorCode act_dwell(Block& block, BlockContext& context);
ErrorCode act_modes(Block& block, BlockContext& context);
ErrorCode act_tool_length(Block& block, BlockContext& context);
ErrorCode act_tool_length_grblhal(Block& block, BlockContext& context);
ErrorCode act_work_offset(Block& block, BlockContext& context);
ErrorCode act_non_modal(Block& block, BlockContext& context);
ErrorCode act_message(Block& block, BlockContext& context);
ErrorCode act_modal_macro(Block& block, BlockContext& context);
ErrorCode act_program_flow(Block& block, BlockContext& context);

// act_motion.cpp.
ErrorCode act_motion(Block& block, BlockContext& context);

/// How the block's motions run.
[[nodiscard]] Feed feed_of(const Block& block, const BlockContext& context);

// act_cycle.cpp, act_spline.cpp and act_thread.cpp: motions that become several lines.
void act_canned_cycle(Block& block, BlockContext& context, Feed feed);
void act_thread(BlockContext& context, Feed feed);
void act_cubic_spline(const Block& block, BlockContext& context, const Feed& feed,
                      const std::array<float, 2>& first_control, const std::array<float, 2>& second_control);

}  // namespace kerf::gcode
