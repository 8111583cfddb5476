#include <algorithm>

#include "common/gcode/checks.hpp"
#include "common/gcode/macros.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

/// Words that have one meaning only and so are never left over.
constexpr std::string_view kSingleMeaning = "NFST";
constexpr std::string_view kJogWords = "NF";
constexpr std::int32_t kLineNumberMax = 10000000;
/// T numbers end where a signed 32-bit number ends (grblHAL config.h).
constexpr float kLargestTool = 2147483648.0F;

bool wants_feed(MotionMode motion) {
  return motion != MotionMode::None && motion != MotionMode::Rapid;
}

ErrorCode check_whole_not_negative(float value) {
  if (!is_whole(value)) return ErrorCode::CommandValueNotInteger;
  return value < 0.0F ? ErrorCode::NegativeValue : ErrorCode::Ok;
}

/// With a table only its tools exist.
bool is_known_tool(float number, const BlockContext& context) {
  return context.settings.tools > 0 ? context.knows_tool(number) : number <= kLargestTool;
}

}  // namespace

// G65, G66 and M98 need P; their other words are passed on as they are.
ErrorCode check_macro_words(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (!block.groups.has(Group::G16)) {
    block.words.take('M');
    return ErrorCode::Ok;
  }
  if (block.macro != MacroCall::None && block.macro != MacroCall::End && !state.modal_macro) {
    if (!block.words.has('P')) return ErrorCode::ValueWordMissing;
    if (block.p > 65535.0F) return ErrorCode::ValueOutOfRange;
    if (!block.words.has('L') || block.l == 0) block.l = 1;
  }
  block.words.take_all("LP");
  block.macro_request = {.id = to_int32(block.p), .repeats = block.l};
  const bool takes_arguments =
      block.macro == MacroCall::NonModal || block.macro == MacroCall::Modal || block.macro == MacroCall::ModalEachBlock;
  if (!takes_arguments) return ErrorCode::Ok;

  constexpr std::string_view kArguments = "ABCDEFHIJKMQRSTUVWXYZ";
  for (const char letter : kArguments)
    if (block.words.has(letter)) block.macro_request.words |= 1U << static_cast<unsigned>(letter - 'A');
  block.macro_request.values = block.written;
  block.axis_words = block.ijk_words = 0;
  block.groups = {};
  block.groups.add(Group::G16);
  block.words.take_all(kArguments);
  if (block.macro == MacroCall::ModalEachBlock) block.words.take('$');
  // The call of G65 begins here; a block that fails later leaves it open.
  if (block.macro == MacroCall::NonModal)
    return begin_macro(block.macro_request, context) ? ErrorCode::Ok : ErrorCode::FlowControlStackOverflow;
  state.modal_macro = block.macro_request;
  block.finished = block.macro == MacroCall::Modal;
  return ErrorCode::Ok;
}

ErrorCode check_implicit_motion(Block& block, BlockContext&) {
  if (block.axis_words != 0 && block.axis_command == AxisCommand::None) block.axis_command = AxisCommand::Motion;
  return ErrorCode::Ok;
}

ErrorCode check_tool_change_pending(Block& block, BlockContext& context) {
  const bool moves = block.axis_command == AxisCommand::Motion && !block.jog;
  return context.state.tool_change_pending && moves ? ErrorCode::ToolChangePending : ErrorCode::Ok;
}

ErrorCode check_line_number(Block& block, BlockContext&) {
  const bool too_large = block.words.has('N') && block.n > kLineNumberMax;
  return too_large ? ErrorCode::InvalidLineNumber : ErrorCode::Ok;
}

ErrorCode check_tool_and_length_numbers(Block& block, BlockContext& context) {
  if (block.words.has('T')) {
    if (const ErrorCode error = check_whole_not_negative(block.t); error != ErrorCode::Ok) return error;
    if (!is_known_tool(block.t, context)) return ErrorCode::IllegalToolNumber;
  }
  return block.words.has('H') ? check_whole_not_negative(block.h) : ErrorCode::Ok;
}

// G94 keeps F, G93 needs it in every block that moves; switching between them forgets it.
ErrorCode check_feed(Block& block, BlockContext& context) {
  const bool has_f = block.words.has('F');
  const FloatRule floats = context.rules.floats;
  if (block.jog) {
    if (!has_f) return ErrorCode::UndefinedFeedRate;
    if (block.modal.inches) block.f = inches_to_mm(floats, block.f);
    return ErrorCode::Ok;
  }
  if (block.modal.feed_mode == FeedMode::InverseTime) {
    const bool moves = block.axis_command == AxisCommand::Motion &&
                       (wants_feed(block.modal.motion) || context.rules.rapid_wants_inverse_feed);
    return moves && !has_f ? ErrorCode::UndefinedFeedRate : ErrorCode::Ok;
  }
  if (context.state.modal.feed_mode != FeedMode::UnitsPerMinute) return ErrorCode::Ok;
  if (!has_f) {
    block.f = context.state.feed_rate;
  } else if (block.modal.inches) {
    block.f = inches_to_mm(floats, block.f);
  }
  return ErrorCode::Ok;
}

// As above; the old F is forgotten at once, even if the block fails later, and F is in inches after a change of mode
// too.
ErrorCode check_feed_grblhal(Block& block, BlockContext& context) {
  const bool has_f = block.words.has('F');
  if (block.jog) {
    if (!has_f) return ErrorCode::UndefinedFeedRate;
  } else {
    if (block.modal.feed_mode != context.state.modal.feed_mode) context.state.feed_rate = 0.0F;
    if (block.modal.feed_mode == FeedMode::InverseTime) {
      const bool synchronized =
          block.modal.motion == MotionMode::SpindleSynchronized || block.modal.motion == MotionMode::RigidTap;
      const bool moves = block.axis_command == AxisCommand::Motion && wants_feed(block.modal.motion) && !synchronized;
      if (moves && !has_f) return ErrorCode::UndefinedFeedRate;
    } else if (!has_f) {
      block.f = context.state.feed_rate;
    }
  }
  if (!has_f) return ErrorCode::Ok;
  if (block.f < 0.0F) return ErrorCode::NegativeValue;
  if (block.modal.feed_mode != FeedMode::InverseTime && block.modal.inches)
    block.f = inches_to_mm(context.rules.floats, block.f);
  return ErrorCode::Ok;
}

ErrorCode check_spindle_speed(Block& block, BlockContext& context) {
  if (!block.words.has('S')) block.s = context.state.spindle_rpm;
  return ErrorCode::Ok;
}

// One spindle: `$` may only be 0; without an encoder G95 and spindle-synchronised motion do not exist.
ErrorCode check_spindle_grblhal(Block& block, BlockContext& context) {
  if (block.modal.motion == MotionMode::SpindleSynchronized || block.modal.motion == MotionMode::RigidTap) {
    block.k_pitch = 0.0F;
    if (block.words.has('K')) {
      block.words.take('K');
      if (block.modal.inches) block.ijk[2] = inches_to_mm(context.rules.floats, block.ijk[2]);
      block.k_pitch = block.ijk[2];
    }
    if (block.modal.motion == MotionMode::RigidTap) block.words.take('I');
  }
  if (block.words.has('$')) {
    const bool synchronized = block.groups.has(Group::G1) &&
                              (block.modal.motion == MotionMode::SpindleSynchronized ||
                               block.modal.motion == MotionMode::RigidTap || block.modal.motion == MotionMode::Thread);
    const bool single = block.words.has('S') || synchronized ||
                        (block.groups.has(Group::G5) && block.modal.feed_mode == FeedMode::UnitsPerRevolution) ||
                        (block.groups.has(Group::M9) && block.override_word == OverrideWord::Spindle);
    if (block.groups.has(Group::M7) || single) {
      if (block.spindle_id < (single ? 0 : -1)) return single ? ErrorCode::NegativeValue : ErrorCode::ValueOutOfRange;
      if (block.spindle_id > 0) return ErrorCode::ValueOutOfRange;
      block.words.take('$');
    }
  }
  if (block.modal.feed_mode == FeedMode::UnitsPerRevolution && !context.settings.spindle_encoder)
    return ErrorCode::UnsupportedCommand;
  if (const ErrorCode error = check_surface_speed_mode(block, context); error != ErrorCode::Ok) return error;
  if (block.words.has('S') && block.s < 0.0F) return ErrorCode::NegativeValue;
  if (context.state.modal.surface_speed) {
    set_surface_speed(block, context);
    return ErrorCode::Ok;
  }
  return check_spindle_speed(block, context);
}

// G96 and G97 act while the block is still being checked (grblHAL gcode.c).
ErrorCode check_surface_speed_mode(Block& block, BlockContext& context) {
  ParserState& state = context.state;
  if (!block.groups.has(Group::G14)) {
    block.modal.surface_speed = state.modal.surface_speed;
    return ErrorCode::Ok;
  }
  const float limit = context.settings.spindle_rpm_max;
  if (block.modal.surface_speed) {
    if (!block.words.has('S')) return ErrorCode::ValueWordMissing;
    if (block.words.has('D') && block.d < 0.0F) return ErrorCode::NegativeValue;
    state.surface_rpm_max = block.words.has('D') ? std::min(block.d, limit) : limit;
    block.words.take('D');
  } else if (state.modal.surface_speed) {
    state.spindle_rpm = state.commanded_rpm;
  }
  state.modal.surface_speed = block.modal.surface_speed;
  return ErrorCode::Ok;
}

void set_surface_speed(Block& block, BlockContext& context) {
  constexpr float kMmPerFoot = 25.4F * 12.0F;
  constexpr float kMmPerMetre = 1000.0F;
  ParserState& state = context.state;
  if (block.words.has('S')) {
    block.s *= block.modal.inches ? kMmPerFoot : kMmPerMetre;
    state.surface_mm_per_min = block.s;
  } else {
    block.s = state.surface_rpm_max;
  }
}

ErrorCode check_tool_set(Block& block, BlockContext& context) {
  if (block.tool_set) {
    if (!block.words.has('Q')) return ErrorCode::ValueWordMissing;
    if (!is_whole(block.q)) return ErrorCode::CommandValueNotInteger;
    if (!is_known_tool(block.q, context)) return ErrorCode::IllegalToolNumber;
    block.t = block.q;
    block.groups.remove(Group::M6);
    block.words.take('Q');
  } else if (!block.words.has('T')) {
    block.t = static_cast<float>(static_cast<std::int32_t>(context.state.tool_pending));
  }
  if (block.tool_change && static_cast<std::uint32_t>(to_int32(block.t)) == context.state.tool) {
    block.tool_change = false;
    block.groups.remove(Group::M6);
  }
  return ErrorCode::Ok;
}

// What changes nothing counts as not there; a jog may have it.
ErrorCode forget_unchanged_modes(Block& block, BlockContext& context) {
  const ModalState& now = context.state.modal;
  if (block.modal.diameter == now.diameter) block.groups.remove(Group::G15);
  if (block.modal.coolant == now.coolant) block.groups.remove(Group::M8);
  if (block.modal.work_offset == now.work_offset) block.groups.remove(Group::G12);
  if (block.modal.overrides == now.overrides) block.groups.remove(Group::M9);
  return ErrorCode::Ok;
}

ErrorCode check_overrides(Block& block, BlockContext&) {
  if (!block.groups.has(Group::M9)) return ErrorCode::Ok;
  // Without P it is P1, for G10 of the same block too.
  if (!block.words.has('P')) block.p = 1.0F;
  if (block.p < 0.0F) return ErrorCode::NegativeValue;
  block.words.take('P');
  OverridePermissions& permissions = block.modal.overrides;
  const bool on = block.p != 0.0F;
  switch (block.override_word) {
    case OverrideWord::None: break;
    case OverrideWord::Enable: permissions.feed = permissions.spindle = true; break;
    case OverrideWord::Disable: permissions.feed = permissions.spindle = false; break;
    case OverrideWord::Feed: permissions.feed = on; break;
    case OverrideWord::Spindle: permissions.spindle = on; break;
    case OverrideWord::FeedHold: permissions.feed_hold = on; break;
    case OverrideWord::Parking: permissions.parking = on; break;
  }
  return ErrorCode::Ok;
}

ErrorCode check_dwell(Block& block, BlockContext&) {
  if (block.non_modal != NonModal::Dwell) return ErrorCode::Ok;
  if (!block.words.has('P')) return ErrorCode::ValueWordMissing;
  if (block.p < 0.0F) return ErrorCode::NegativeValue;
  block.words.take('P');
  return ErrorCode::Ok;
}

// Rabbit's M62 to M65 need P, M67 and M68 need E and Q.
ErrorCode check_pins(Block& block, BlockContext&) {
  if (block.pin_word == PinWord::Digital) {
    if (!block.words.has('P')) return ErrorCode::ValueWordMissing;
    block.words.take('P');
  }
  if (block.pin_word == PinWord::Analog) {
    if (!block.words.has('E') || !block.words.has('Q')) return ErrorCode::ValueWordMissing;
    block.words.take_all("EQ");
  }
  return ErrorCode::Ok;
}

ErrorCode check_unused_words(Block& block, BlockContext& context) {
  block.words.take_all(block.jog ? kJogWords : kSingleMeaning);
  if (block.axis_command != AxisCommand::None) {
    const std::string_view axes = vocabulary::kAxisLetters.substr(0, context.axes());
    block.words.take_all(axes);
  }
  return block.words.is_empty() ? ErrorCode::Ok : ErrorCode::UnusedWords;
}

ErrorCode check_jog_words(Block& block, BlockContext&) {
  if (!block.jog) return ErrorCode::Ok;
  const bool allowed = !block.groups.has_more_than({Group::G0, Group::G3, Group::G6}) &&
                       (block.non_modal == NonModal::None || block.non_modal == NonModal::AbsoluteOverride);
  return allowed ? ErrorCode::Ok : ErrorCode::InvalidJogCommand;
}

}  // namespace kerf::gcode
