#include <algorithm>
#include <numbers>

#include "common/gcode/acts.hpp"
#include "common/gcode/macros.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

constexpr std::size_t kToolLengthAxis = 2;

bool cuts(MotionMode motion) {
  return motion == MotionMode::Linear || motion == MotionMode::ClockwiseArc ||
         motion == MotionMode::CounterclockwiseArc || motion == MotionMode::CubicSpline ||
         motion == MotionMode::QuadraticSpline;
}

StoredOffset stored_work_offset(std::uint8_t index) {
  return static_cast<StoredOffset>(index);
}

void note_offset_change(BlockContext& context) {
  context.out.push_back(WorkOffsetChange{});
}

void store(BlockContext& context, StoredOffset which) {
  context.out.push_back(StoredOffsetWrite{.which = which});
}

/// G96: the speed for the place at which the motion begins; without a motion it stays (grblHAL gcode.c).
float speed_at_surface(const Block& block, const BlockContext& context) {
  const ParserState& state = context.state;
  if (block.modal.motion == MotionMode::None || block.modal.motion == MotionMode::Rapid) return state.spindle_rpm;
  const std::size_t across = axes_of(block.modal.plane).second;
  const float radius_mm = state.position_mm[across] - state.work_offset_mm[across] - context.offsets.g92[across] -
                          context.offsets.tool_length[across];
  if (radius_mm <= 0.0F) return state.surface_rpm_max;
  return std::min(state.surface_rpm_max, state.surface_mm_per_min / (radius_mm * 2.0F * std::numbers::pi_v<float>));
}

void move_home(Block& block, BlockContext& context) {
  Feed feed = feed_of(block, context);
  feed.rapid = true;
  if (block.axis_command != AxisCommand::None) context.out.push_back(LinearMove{.target_mm = block.xyz, .feed = feed});
  context.out.push_back(LinearMove{.target_mm = block.stored_mm, .feed = feed});
  context.state.position_mm = block.stored_mm;
  context.state.scale_factor.fill(1.0F);
  context.state.modal.scaling = false;
}

void write_work_offset(const Block& block, BlockContext& context) {
  context.offsets.work[block.stored_index] = block.stored_mm;
  store(context, stored_work_offset(block.stored_index));
  if (context.state.modal.work_offset == block.stored_index) {
    context.state.work_offset_mm = block.stored_mm;
    note_offset_change(context);
  }
}

void write_g92(const AxisValues& value, BlockContext& context, bool stores) {
  context.offsets.g92 = value;
  note_offset_change(context);
  if (stores && context.rules.stores_g92 && !context.settings.g92_volatile) {
    context.offsets.g92_stored = value;
    store(context, StoredOffset::G92);
  }
}

void end_program(BlockContext& context) {
  ParserState& state = context.state;
  ModalState& modal = state.modal;
  modal.motion = MotionMode::Linear;
  modal.plane = Plane::XY;
  modal.incremental = false;
  modal.feed_mode = FeedMode::UnitsPerMinute;
  modal.work_offset = 0;
  modal.spindle = SpindleDirection::Off;
  modal.surface_speed = false;
  modal.coolant = {};
  modal.overrides.feed = modal.overrides.spindle = true;
  if (!context.settings.check_mode) {
    state.work_offset_mm = context.offsets.work[0];
    const bool keeps_g92 = context.rules.stores_g92 && !context.settings.g92_volatile;
    if (keeps_g92 && context.offsets.g92_stored != context.offsets.g92) {
      context.offsets.g92_stored = context.offsets.g92;
      store(context, StoredOffset::G92);
    }
    note_offset_change(context);
  }
  if (context.rules.failure_drops_pending_work) {
    state.arriving_tool.reset();
    state.modal_macro.reset();
    state.saved.reset();
  }
  const bool restores = context.rules.program_end_restores_overrides || context.settings.restore_overrides_at_end;
  context.out.push_back(ProgramEnd{.restores_overrides = restores});
}

}  // namespace

// G65 runs before anything else of its block acts, and nothing else does.
ErrorCode act_macro(Block& block, BlockContext& context) {
  if (!block.groups.has(Group::G16)) return ErrorCode::Ok;
  if (block.macro == MacroCall::ModalEachBlock) {
    // The other words of the block were arguments: of the modes only the motion stays.
    ModalState kept = context.state.modal;
    kept.motion = block.modal.motion;
    kept.canned_cycle = block.modal.canned_cycle;
    block.modal = kept;
  }
  if (block.macro != MacroCall::NonModal) return ErrorCode::Ok;
  block.finished = true;
  return finish_macro(block.macro_request, context);
}

// In laser mode only G1, G2 and G3 burn, and S takes effect with the motion instead of stopping it.
ErrorCode act_laser(Block& block, BlockContext& context) {
  if (!context.settings.laser_mode) return ErrorCode::Ok;
  block.laser_disable = !cuts(block.modal.motion);
  if (block.axis_words != 0 && block.axis_command == AxisCommand::Motion) {
    block.laser_is_motion = true;
  } else if (context.state.modal.spindle == SpindleDirection::Clockwise) {
    block.spindle_force_sync = cuts(context.state.modal.motion) == block.laser_disable;
  }
  return ErrorCode::Ok;
}

ErrorCode act_feed(Block& block, BlockContext& context) {
  context.state.line_number = block.n != 0 ? block.n : context.settings.file_line;
  context.state.modal.feed_mode = block.modal.feed_mode;
  context.state.feed_rate = block.f;
  return ErrorCode::Ok;
}

ErrorCode act_spindle_speed(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (state.modal.surface_speed) block.s = speed_at_surface(block, context);
  if (state.spindle_rpm == block.s && !block.spindle_force_sync) return ErrorCode::Ok;
  if (state.modal.spindle != SpindleDirection::Off && !block.laser_is_motion) {
    state.commanded_rpm = block.s;
    context.out.push_back(SpindleSpeedChange{.rpm = block.laser_disable ? 0.0F : block.s});
  }
  state.spindle_rpm = block.s;
  return ErrorCode::Ok;
}

// Grbl only remembers the number, 0 again in every block without T.
ErrorCode act_tool_number(Block& block, BlockContext& context) {
  const auto tool = static_cast<std::uint32_t>(block.t);
  if (block.has_tool_word) context.out.push_back(ToolSelect{.tool = static_cast<int>(tool)});
  context.state.tool = tool;
  return ErrorCode::Ok;
}

ErrorCode act_tool_select(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  const auto tool = static_cast<std::uint32_t>(to_int32(block.t));
  if (state.tool_pending == tool) return ErrorCode::Ok;
  state.tool_pending = tool;
  if (context.settings.check_mode) return ErrorCode::Ok;
  if (block.tool_set || context.settings.ignore_tool_change) {
    state.tool = tool;
    state.arriving_tool.reset();
  }
  context.out.push_back(ToolSelect{.tool = static_cast<int>(tool)});
  return ErrorCode::Ok;
}

ErrorCode act_tool_change(Block& block, BlockContext& context) {
  if (!block.tool_change || context.settings.check_mode) return ErrorCode::Ok;
  ParserState& state = context.state;
  if (!block.message.empty()) {
    context.out.push_back(OperatorMessage{.text = block.message});
    block.message.clear();
  }
  if (state.tool_pending == state.tool) return ErrorCode::Ok;
  state.arriving_tool = state.tool_pending;
  if (block.groups.has(Group::G8) && block.modal.tool_length == ToolLengthMode::FromTable) {
    // The length comes with the tool, when the change is done.
    block.groups.remove(Group::G8);
    block.modal.tool_length = state.modal.tool_length;
    state.arriving_length = block.h > 0.0F ? static_cast<std::uint32_t>(block.h) : state.tool_pending;
    static_cast<void>(context.tools());
  }
  state.tool_change_pending = true;
  context.out.push_back(ToolChange{.tool = static_cast<int>(state.tool_pending)});
  return ErrorCode::Ok;
}

ErrorCode act_spindle(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (state.modal.spindle == block.modal.spindle) return ErrorCode::Ok;
  state.modal.spindle = block.modal.spindle;
  state.commanded_rpm = state.spindle_rpm;
  context.out.push_back(
      SpindleChange{.direction = block.modal.spindle, .rpm = block.laser_disable ? 0.0F : state.spindle_rpm});
  return ErrorCode::Ok;
}

// M70 and M73 keep the modes, M72 brings them back, M71 forgets them (grblHAL).
ErrorCode act_saved_state(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  switch (block.saved_state) {
    case SavedState::None: break;
    case SavedState::Save:
      state.saved = SavedModalState{.modal = state.modal,
                                    .feed_rate = state.feed_rate,
                                    .spindle_rpm = state.spindle_rpm,
                                    .tool_length_mm = context.offsets.tool_length};
      break;
    case SavedState::Invalidate: state.saved.reset(); break;
    case SavedState::Restore: {
      if (!state.saved) break;
      const SavedModalState& saved = *state.saved;
      state.feed_rate = saved.feed_rate;
      state.modal.feed_mode = saved.modal.feed_mode;
      state.modal.tool_length = saved.modal.tool_length;
      set_tool_length(saved.tool_length_mm, context);
      if (saved.modal.coolant != state.modal.coolant)
        context.out.push_back(CoolantChange{.flood = saved.modal.coolant.flood, .mist = saved.modal.coolant.mist});
      if (saved.modal.spindle != state.modal.spindle || saved.spindle_rpm != state.spindle_rpm)
        context.out.push_back(SpindleChange{.direction = saved.modal.spindle, .rpm = saved.spindle_rpm});
      state.spindle_rpm = saved.spindle_rpm;
      state.modal.spindle = saved.modal.spindle;
      state.modal.coolant = saved.modal.coolant;
      // The rest acts as if the block had the words.
      block.modal.plane = saved.modal.plane;
      block.modal.incremental = saved.modal.incremental;
      block.modal.inches = saved.modal.inches;
      block.modal.overrides = saved.modal.overrides;
      block.modal.retract = saved.modal.retract;
      block.groups.add(Group::G10);
      if (saved.modal.work_offset != block.modal.work_offset) {
        block.modal.work_offset = saved.modal.work_offset;
        block.work_offset_mm = context.offsets.work[saved.modal.work_offset];
      }
      break;
    }
  }
  return ErrorCode::Ok;
}

ErrorCode act_coolant(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (block.coolant_word == CoolantWord::None) return ErrorCode::Ok;
  const bool always = context.rules.coolant_word_always_acts;
  if (!always && state.modal.coolant == block.modal.coolant) return ErrorCode::Ok;
  state.modal.coolant = block.modal.coolant;
  context.out.push_back(CoolantChange{.flood = block.modal.coolant.flood,
                                      .mist = block.modal.coolant.mist,
                                      .waits = !(always && block.coolant_word == CoolantWord::Off)});
  return ErrorCode::Ok;
}

// Rabbit's board: outputs 0 to 3 for M62 to M65, of which one leads nowhere, and none for M67 and M68.
ErrorCode act_pins(Block& block, BlockContext&) {
  constexpr float kDigitalPins = 4;
  if (block.pin_word == PinWord::None) return ErrorCode::Ok;
  const bool exists = block.pin_word == PinWord::Digital && block.p < kDigitalPins;
  return exists ? ErrorCode::Ok : ErrorCode::ParameterPTooLarge;
}

ErrorCode act_overrides(Block& block, BlockContext& context) {
  OverridePermissions& permissions = context.state.modal.overrides;
  if (permissions == block.modal.overrides) return ErrorCode::Ok;
  permissions = block.modal.overrides;
  context.out.push_back(OverrideControl{.feed_enabled = permissions.feed,
                                        .spindle_enabled = permissions.spindle,
                                        .feed_hold_enabled = permissions.feed_hold,
                                        .parking_enabled = permissions.parking});
  return ErrorCode::Ok;
}

ErrorCode act_dwell(Block& block, BlockContext& context) {
  if (block.non_modal == NonModal::Dwell) context.out.push_back(Dwell{.dwell_s = block.p});
  return ErrorCode::Ok;
}

ErrorCode act_modes(Block& block, BlockContext& context) {
  ModalState& modal = context.state.modal;
  modal.plane = block.modal.plane;
  modal.inches = block.modal.inches;
  modal.diameter = block.modal.diameter;
  modal.incremental = block.modal.incremental;
  if (block.groups.has(Group::G10)) modal.retract = block.modal.retract;
  return ErrorCode::Ok;
}

ErrorCode act_tool_length(Block& block, BlockContext& context) {
  if (block.axis_command != AxisCommand::ToolLength) return ErrorCode::Ok;
  context.state.modal.tool_length = block.modal.tool_length;
  AxisValues length = context.offsets.tool_length;
  length[kToolLengthAxis] = block.modal.tool_length == ToolLengthMode::None ? 0.0F : block.xyz[kToolLengthAxis];
  set_tool_length(length, context);
  return ErrorCode::Ok;
}

ErrorCode act_work_offset(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (state.modal.work_offset == block.modal.work_offset) return ErrorCode::Ok;
  state.modal.work_offset = block.modal.work_offset;
  state.work_offset_mm = block.work_offset_mm;
  note_offset_change(context);
  return ErrorCode::Ok;
}

ErrorCode act_non_modal(Block& block, BlockContext& context) {
  switch (block.non_modal) {
    case NonModal::None:
    case NonModal::Dwell:
    case NonModal::AbsoluteOverride: break;
    case NonModal::SetData:
      if (block.tool_entry) {
        write_tool_entry(block, context);
      } else {
        write_work_offset(block, context);
      }
      break;
    case NonModal::GoHome28:
    case NonModal::GoHome30: move_home(block, context); break;
    case NonModal::SetHome28:
      context.offsets.g28 = context.state.position_mm;
      store(context, StoredOffset::G28);
      break;
    case NonModal::SetHome30:
      context.offsets.g30 = context.state.position_mm;
      store(context, StoredOffset::G30);
      break;
    case NonModal::SetCoordinateOffset: write_g92(block.xyz, context, true); break;
    case NonModal::ResetCoordinateOffset: write_g92({}, context, true); break;
    case NonModal::ClearCoordinateOffset: write_g92({}, context, false); break;
    case NonModal::RestoreCoordinateOffset: write_g92(context.offsets.g92_stored, context, false); break;
  }
  return ErrorCode::Ok;
}

ErrorCode act_message(Block& block, BlockContext& context) {
  if (!block.message.empty() && !context.settings.check_mode)
    context.out.push_back(OperatorMessage{.text = block.message});
  return ErrorCode::Ok;
}

// M98, and G66 after G0 or G1: the motion is done, then the macro is not found. A motion hides the M98 of its block.
ErrorCode act_modal_macro(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  const bool moved = block.axis_command == AxisCommand::Motion &&
                     (block.modal.motion == MotionMode::Rapid || block.modal.motion == MotionMode::Linear);
  if (moved) return state.modal_macro ? call_macro(*state.modal_macro, context) : ErrorCode::Ok;
  if (!block.groups.has(Group::G16)) return ErrorCode::Ok;
  if (block.macro == MacroCall::End) state.modal_macro.reset();
  if (block.macro == MacroCall::ModalEachBlock) return call_macro(block.macro_request, context);
  if (block.macro == MacroCall::Subprogram && !context.settings.check_mode)
    return finish_macro({.id = to_int32(block.p), .repeats = block.l}, context);
  return ErrorCode::Ok;
}

ErrorCode act_program_flow(Block& block, BlockContext& context) {
  switch (block.flow) {
    case ProgramFlow::Running: break;
    case ProgramFlow::Paused:
    case ProgramFlow::CompletedM60: context.out.push_back(ProgramPause{.optional = false}); break;
    case ProgramFlow::OptionalStop: context.out.push_back(ProgramPause{.optional = true}); break;
    case ProgramFlow::CompletedM2:
    case ProgramFlow::CompletedM30: end_program(context); break;
  }
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
