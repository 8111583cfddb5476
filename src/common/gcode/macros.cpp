#include "common/gcode/macros.hpp"

#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

/// A macro's words in the order of its parameters; a dot where no word can be.
constexpr std::string_view kParameterLetters = "ABCIJKDEF.H.M...QRSTUVWXYZ";

std::uint16_t parameter_of(char letter) {
  return static_cast<std::uint16_t>(kParameterLetters.find(letter) + 1);
}

float argument(BlockContext& context, char letter) {
  return context.parameters.get(parameter_of(letter));
}

void give_back(BlockContext& context, float value) {
  context.parameters.set("_value", value);
  context.parameters.set("_value_returned", 1.0F);
}

/// P1: a setting in Q, and its new value in S.
ErrorCode read_or_write_setting(const MacroRequest& macro, BlockContext& context) {
  if (!macro.has('Q')) return ErrorCode::ValueWordMissing;
  const int id = static_cast<int>(to_uint16(argument(context, 'Q')));
  if (context.machine == nullptr) return ErrorCode::ValueOutOfRange;
  auto setting = context.machine->setting(id);
  if (!setting) return ErrorCode::ValueOutOfRange;
  if (setting->kind == SettingNumber::Kind::NotNumber) return ErrorCode::Ok;
  if (macro.has('S')) {
    const ErrorCode error = context.machine->write_setting(id, argument(context, 'S'));
    if (error != ErrorCode::Ok) return error;
    setting = context.machine->setting(id);
  }
  if (setting) give_back(context, setting->value);
  return ErrorCode::Ok;
}

/// P2: the length of tool Q along axis R.
ErrorCode read_tool_offset(const MacroRequest& macro, BlockContext& context) {
  if (!macro.has('Q') || !macro.has('R')) return ErrorCode::ValueWordMissing;
  const float tool = argument(context, 'Q');
  const std::size_t axis = to_uint8(argument(context, 'R'));
  const bool is_known = context.settings.tools > 0 && tool >= 0.0F && context.knows_tool(tool);
  if (!is_known || axis >= context.axes()) return ErrorCode::IllegalToolNumber;
  give_back(context, context.tools().at(static_cast<std::size_t>(tool)).length_mm.at(axis));
  return ErrorCode::Ok;
}

/// P3: parameter I gets the value Q, or goes to parameter S, or comes back.
ErrorCode read_or_write_parameter(const MacroRequest& macro, BlockContext& context) {
  if (!macro.has('I')) return ErrorCode::ValueWordMissing;
  const auto write = [&](char letter, float value) {
    const std::uint16_t id = to_uint16(argument(context, letter));
    if (!Parameters::is_writable(id)) return ErrorCode::ValueOutOfRange;
    context.parameters.set(id, value);
    return ErrorCode::Ok;
  };
  if (macro.has('Q')) return write('I', argument(context, 'Q'));
  const auto value = context.values().get(to_uint16(argument(context, 'I')));
  if (!value) return ErrorCode::ValueOutOfRange;
  if (macro.has('S')) return write('S', *value);
  give_back(context, *value);
  return ErrorCode::Ok;
}

ErrorCode select_probe(const MacroRequest& macro, BlockContext& context) {
  if (!macro.has('Q')) return ErrorCode::ValueWordMissing;
  return argument(context, 'Q') == 0.0F ? ErrorCode::Ok : ErrorCode::ValueOutOfRange;
}

ErrorCode run(const MacroRequest& macro, BlockContext& context) {
  constexpr int kLast = 7;
  if (macro.id >= 1 && macro.id <= kLast && macro.repeats > 1) return ErrorCode::ValueOutOfRange;
  switch (macro.id) {
    case 1: return read_or_write_setting(macro, context);
    case 2: return read_tool_offset(macro, context);
    case 3: return read_or_write_parameter(macro, context);
    case 4:
      give_back(context, context.machine != nullptr ? static_cast<float>(context.machine->state_number()) : 0.0F);
      return ErrorCode::Ok;
    case 5: return select_probe(macro, context);
    case 6: return ErrorCode::Ok;                  // no spindle delay
    case 7: return ErrorCode::UnsupportedCommand;  // Modbus
    default: return ErrorCode::ValueOutOfRange;
  }
}

}  // namespace

bool begin_macro(const MacroRequest& macro, BlockContext& context) {
  if (!context.parameters.begin_call(1 + static_cast<int>(context.parameters.call_level()))) return false;
  for (char letter = 'A'; letter <= 'Z'; ++letter)
    if (macro.has(letter))
      context.parameters.set(parameter_of(letter), macro.values.at(static_cast<std::size_t>(letter - 'A')));
  return true;
}

ErrorCode finish_macro(const MacroRequest& macro, BlockContext& context) {
  context.parameters.set("_value", 0.0F);
  context.parameters.set("_value_returned", 0.0F);
  const ErrorCode error = run(macro, context);
  context.parameters.end_call();
  return error;
}

ErrorCode call_macro(const MacroRequest& macro, BlockContext& context) {
  if (!begin_macro(macro, context)) return ErrorCode::FlowControlStackOverflow;
  return finish_macro(macro, context);
}

}  // namespace kerf::gcode
