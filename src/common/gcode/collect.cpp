// Words of a line into a block: known commands, one a modal group, each value once.

#include <cmath>
#include <expected>
#include <limits>
#include <optional>
#include <utility>

#include "common/gcode/block.hpp"
#include "common/gcode/commands.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

/// A number split as the firmware splits it: the part that selects and the hundredths that remain.
struct CommandNumber {
  std::uint64_t whole = 0;
  std::uint64_t hundredths = 0;
};

CommandNumber split_number(const GcodeRules& rules, float value) {
  if (rules.byte_commands) {
    const std::uint8_t whole = to_uint8(std::trunc(value));
    const float rest = 100.0F * (value - static_cast<float>(whole));
    return {.whole = whole, .hundredths = to_uint16(std::round(rest))};
  }
  const std::uint32_t whole = to_uint32(std::trunc(value));
  const float rest = 100.0F * (value - static_cast<float>(whole));
  return {.whole = whole, .hundredths = to_uint64(std::round(rest))};
}

class Collector {
 public:
  Collector(const char* text, Block& block, BlockContext& context)
      : text_(text),
        block_(block),
        context_(context),
        rules_(context.rules),
        parameters_(context.values()),
        reader_(context.rules, parameters_, text),
        // A line number is read even where lines are passed over.
        skips_(context.flow.skips() && text[0] != 'N') {
    // What an unreadable first value leaves behind; the recorded build has no number there in jogs.
    if (block.jog) value_ = std::numeric_limits<float>::quiet_NaN();
  }

  ErrorCode collect() {
    const char* const text = text_;
    std::uint8_t at = 0;
    bool has_wrapped = false;
    while (text[at] != '\0') {
      // The 8-bit counter of a full line wraps: its first words come again. What none of them ends would be read for
      // ever.
      const std::uint8_t began_at = at;
      const char letter = text[at++];
      if (rules_.reads_expressions) {
        const auto done = read_flow(letter, at);
        if (!done) return done.error();
        if (block_.finished) return ErrorCode::Ok;
        if (*done) {
          if (at <= began_at) return ErrorCode::LineTooLong;
          continue;
        }
      }
      const bool is_letter = (letter >= 'A' && letter <= 'Z') || (letter == '$' && takes('$'));
      if (!is_letter) return ErrorCode::ExpectedCommandLetter;
      if (const ErrorCode error = read_value(letter, text, at); error != ErrorCode::Ok) return error;
      if (skips_ && letter != 'O') {
        block_.finished = true;
        return ErrorCode::Ok;
      }
      if (const ErrorCode error = add_word(letter); error != ErrorCode::Ok) return error;
      if (at != 0) continue;
      if (has_wrapped) return ErrorCode::LineTooLong;
      has_wrapped = true;
    }
    return ErrorCode::Ok;
  }

 private:
  CommandNumber& number() {
    if (unsplit_) split_ = split_number(rules_, *std::exchange(unsplit_, std::nullopt));
    return split_;
  }
  [[nodiscard]] bool takes(char letter) const { return rules_.value_letters.find(letter) != std::string_view::npos; }

  /// Assignments and O words. True if nothing is left of what `letter` begins; the block is finished if it was a
  /// statement, or if it is passed over.
  std::expected<bool, ErrorCode> read_flow(char letter, std::uint8_t& at) {
    if (letter == '#') {
      if (skips_) {
        block_.finished = true;
        return true;
      }
      const ErrorCode error = read_assignment(at);
      return error == ErrorCode::Ok ? std::expected<bool, ErrorCode>(true) : std::unexpected(error);
    }
    if (letter == 'O') {
      block_.words.take('N');
      const char next = text_[at];
      if (const ErrorCode error = read_label(at); error != ErrorCode::Ok) return std::unexpected(error);
      if (next == '<') return true;
    }
    if (!block_.words.is_only('O')) return false;
    FlowRequest request;
    const ErrorCode error = context_.flow.run(block_.label, reader_, static_cast<std::uint8_t>(at - 1),
                                              context_.parameters, place_in_file(), request);
    if (request.alarm) context_.out.push_back(AlarmRequest{.code = *request.alarm});
    if (error != ErrorCode::Ok) {
      if (context_.settings.prints_debug) context_.out.push_back(OperatorMessage{.text = text_});
      return std::unexpected(error);
    }
    block_.finished = true;
    return true;
  }

  [[nodiscard]] std::optional<FilePlace> place_in_file() const {
    const InterpreterSettings& settings = context_.settings;
    if (!settings.file_position) return std::nullopt;
    return FilePlace{.position = *settings.file_position, .line = block_.n != 0 ? block_.n : settings.file_line};
  }

  /// `O[1+2]` and `O<name>`; a plain number is read as the word's value.
  ErrorCode read_label(std::uint8_t& at) {
    if (text_[at] == '[') {
      std::int32_t number = 0;
      if (const ErrorCode error = reader_.read_whole_value(at, number); error != ErrorCode::Ok) return error;
      block_.words.add('O');
      block_.label = {.number = static_cast<std::uint32_t>(number), .name = {}};
      ++at;
    } else if (text_[at] == '<') {
      std::string name;
      if (const ErrorCode error = reader_.read_name(at, name); error != ErrorCode::Ok) return error;
      block_.words.add('O');
      if (name.empty()) return ErrorCode::FlowControlOutOfMemory;
      block_.label = {.number = 0, .name = std::move(name)};
    }
    return ErrorCode::Ok;
  }

  /// `#<name>=5` takes effect at once, `#1=5` at the end of the block.
  ErrorCode read_assignment(std::uint8_t& at) {
    constexpr std::size_t kMostAssignments = 10;
    const bool is_named = text_[at] == '<';
    std::string name;
    float number = 0.0F;
    const ErrorCode target = is_named ? reader_.read_name(at, name) : reader_.read_value(at, number);
    if (target != ErrorCode::Ok) return target;
    const std::uint16_t id = to_uint16(number);
    if (!is_named && !Parameters::is_writable(id)) return ErrorCode::ValueOutOfRange;
    if (text_[at++] != '=') return ErrorCode::BadNumberFormat;
    if (const ErrorCode error = reader_.read_value(at, value_); error != ErrorCode::Ok) return error;
    if (is_named) return parameters_.set(name, value_) ? ErrorCode::Ok : ErrorCode::BadNumberFormat;
    if (block_.assignments.size() == kMostAssignments) return ErrorCode::BadNumberFormat;
    block_.assignments.push_back({.parameter = id, .value = value_});
    return ErrorCode::Ok;
  }

  ErrorCode read_value(char letter, const char* text, std::uint8_t& at) {
    if (rules_.reads_expressions) {
      if (const ErrorCode error = reader_.read_value(at, value_); error != ErrorCode::Ok) return error;
      unsplit_ = value_;
      return ErrorCode::Ok;
    }
    if (letter == 'O' && takes('O')) {
      // The hundredths of the word before stay in force: grblHAL forgets them for O.
      value_ = std::numeric_limits<float>::quiet_NaN();
      std::uint32_t whole = 0;
      return read_whole(text, at, whole);
    }
    if (!read_float(rules_, text, at, value_)) return ErrorCode::BadNumberFormat;
    unsplit_ = value_;
    return ErrorCode::Ok;
  }

  ErrorCode add_word(char letter) {
    if (letter == 'G') return add_command(rules_.commands->g(number().whole));
    if (letter == 'M') return add_m();
    return add_value(letter);
  }

  ErrorCode add_m() {
    const bool is_argument = block_.macro == MacroCall::NonModal || block_.macro == MacroCall::Modal ||
                             block_.macro == MacroCall::ModalEachBlock;
    if (is_argument) {
      if (block_.words.has('M')) return ErrorCode::WordRepeated;
      block_.words.add('M');
      block_.written['M' - 'A'] = value_;
      return ErrorCode::Ok;
    }
    if (number().hundredths > 0 && (rules_.byte_commands || number().whole <= 99))
      return ErrorCode::CommandValueNotInteger;
    return add_command(rules_.commands->m(number().whole));
  }

  ErrorCode add_command(std::span<const CommandRow> rows) {
    if (rows.empty()) return ErrorCode::UnsupportedCommand;
    const CommandRow* row = nullptr;
    for (const CommandRow& candidate : rows)
      if (candidate.hundredths == number().hundredths) row = &candidate;

    const CommandRow& first = rows.front();
    const bool is_lathe_word = first.meaning == Meaning::Diameter || first.meaning == Meaning::SurfaceSpeed;
    if (is_lathe_word && !context_.settings.lathe_mode) return ErrorCode::UnsupportedCommand;
    if (row == nullptr) {
      if (first.claims_before_fraction && first.claim == Claim::IfFree && is_claimed())
        return ErrorCode::AxisCommandConflict;
      if (first.bad_fraction != ErrorCode::Ok) return first.bad_fraction;
      row = &first;
    }
    if (row->claim == Claim::IfFree && is_claimed()) return ErrorCode::AxisCommandConflict;
    if (row->claim != Claim::No) block_.axis_command = row->claims_as;

    number().hundredths = 0;
    const auto group = apply(*row);
    if (!group) return ErrorCode::UnsupportedCommand;
    if (block_.groups.has(*group)) return ErrorCode::ModalGroupViolation;
    block_.groups.add(*group);
    return ErrorCode::Ok;
  }

  [[nodiscard]] bool is_claimed() const { return block_.axis_command != AxisCommand::None; }

  /// Puts a command into the block; the modal group that it occupies, nothing if this machine refuses it.
  std::optional<Group> apply(const CommandRow& row) {
    ModalState& modal = block_.modal;
    switch (row.meaning) {
      case Meaning::Nothing: break;
      case Meaning::Motion:
        modal.motion = static_cast<MotionMode>(row.argument);
        modal.canned_cycle = is_canned_cycle(modal.motion);
        block_.cycle_changes = modal.canned_cycle && modal.motion != context_.state.modal.motion;
        break;
      case Meaning::NonModal: block_.non_modal = static_cast<NonModal>(row.argument); break;
      case Meaning::Plane: modal.plane = static_cast<Plane>(row.argument); break;
      case Meaning::Distance: modal.incremental = row.argument != 0; break;
      case Meaning::FeedMode: modal.feed_mode = static_cast<FeedMode>(row.argument); break;
      case Meaning::Units: modal.inches = row.argument != 0; break;
      case Meaning::TableToolLength:
        if (context_.settings.tools == 0) return std::nullopt;
        modal.tool_length = static_cast<ToolLengthMode>(row.argument);
        break;
      case Meaning::ToolLength: modal.tool_length = static_cast<ToolLengthMode>(row.argument); break;
      case Meaning::WorkOffset: modal.work_offset = row.argument; break;
      case Meaning::Retract: modal.retract = static_cast<RetractMode>(row.argument); break;
      case Meaning::Scaling: block_.scaling_word = row.argument != 0; break;
      case Meaning::Macro: return apply_macro(row);
      case Meaning::ProgramFlow: block_.flow = static_cast<ProgramFlow>(row.argument); break;
      case Meaning::OptionalStop:
        if (!context_.settings.optional_stop_disabled) block_.flow = ProgramFlow::OptionalStop;
        break;
      case Meaning::Spindle: modal.spindle = static_cast<SpindleDirection>(row.argument); break;
      case Meaning::ToolChange:
        if (context_.settings.ignore_tool_change) return Group::None;
        block_.tool_change = true;
        break;
      case Meaning::ToolSet: block_.tool_set = true; break;
      case Meaning::Coolant: apply_coolant(static_cast<CoolantWord>(row.argument)); break;
      case Meaning::Override: block_.override_word = static_cast<OverrideWord>(row.argument); break;
      case Meaning::ParkingOverride:
        if (!context_.settings.parking_override_control) return std::nullopt;
        block_.override_word = OverrideWord::Parking;
        break;
      case Meaning::SavedState: block_.saved_state = static_cast<SavedState>(row.argument); break;
      case Meaning::Diameter: modal.diameter = row.argument != 0; break;
      case Meaning::SurfaceSpeed: modal.surface_speed = row.argument != 0; break;
      case Meaning::Port:
        if (!has_port_for(static_cast<PortWord>(row.argument), context_.settings.ports)) return std::nullopt;
        block_.port_word = static_cast<PortWord>(row.argument);
        break;
      case Meaning::Pin: block_.pin_word = static_cast<PinWord>(row.argument); break;
    }
    return row.group;
  }

  /// grblHAL: M words before G65 or G66 are arguments of the macro, not commands.
  Group apply_macro(const CommandRow& row) {
    const auto call = static_cast<MacroCall>(row.argument);
    if (call == MacroCall::NonModal || call == MacroCall::Modal || call == MacroCall::ModalEachBlock) {
      constexpr Group kMGroups[] = {Group::M4, Group::M6, Group::M7, Group::M8, Group::M9, Group::M10};
      for (const Group group : kMGroups) {
        if (block_.groups.has(group)) block_.words.add('M');
        block_.groups.remove(group);
      }
    }
    block_.macro = call;
    const bool ends_running_macro =
        call == MacroCall::End && block_.groups.has(Group::G16) && context_.state.modal_macro.has_value();
    return ends_running_macro ? Group::None : row.group;
  }

  void apply_coolant(CoolantWord word) {
    block_.coolant_word = word;
    Coolant& coolant = block_.modal.coolant;
    if (word == CoolantWord::Mist) coolant.mist = true;
    if (word == CoolantWord::Flood) coolant.flood = true;
    if (word == CoolantWord::Off) coolant = {};
  }

  ErrorCode add_value(char letter) {
    if (const ErrorCode error = store_value(letter); error != ErrorCode::Ok) return error;
    if (block_.words.has(letter)) return ErrorCode::WordRepeated;
    if (value_ < 0.0F && rules_.non_negative_letters.find(letter) != std::string_view::npos)
      return ErrorCode::NegativeValue;
    block_.words.add(letter);
    if (letter != '$') block_.written[static_cast<std::size_t>(letter - 'A')] = value_;
    return ErrorCode::Ok;
  }

  ErrorCode store_value(char letter) {
    if (const auto axis = vocabulary::axis_of(letter)) return store_axis(vocabulary::index_of(*axis), letter);
    if (!takes(letter)) return ErrorCode::UnsupportedCommand;
    switch (letter) {
      case 'I':
      case 'J':
      case 'K': {
        const auto at = static_cast<std::size_t>(letter - 'I');
        block_.ijk[at] = value_;
        block_.ijk_words = static_cast<std::uint8_t>(block_.ijk_words | 1U << at);
        break;
      }
      case 'D': block_.d = value_; break;
      case 'E': block_.e = static_cast<std::uint8_t>(number().whole); break;
      case 'F': block_.f = value_; break;
      case 'H': block_.h = value_; break;
      case 'L': return store_l();
      case 'N':
        block_.n = to_int32(std::trunc(value_));
        skips_ = context_.flow.skips();
        break;
      case 'O':
        if (number().hundredths != 0) return ErrorCode::CommandValueNotInteger;
        block_.label = {.number = static_cast<std::uint32_t>(number().whole), .name = {}};
        break;
      case 'P': block_.p = value_; break;
      case 'Q': block_.q = value_; break;
      case 'R': block_.r = value_; break;
      case 'S': block_.s = value_; break;
      case 'T': return store_tool();
      case '$':
        if (number().hundredths > 0) return ErrorCode::CommandValueNotInteger;
        block_.spindle_id = to_int32(value_);
        break;
      default: break;
    }
    return ErrorCode::Ok;
  }

  ErrorCode store_axis(std::size_t axis, char letter) {
    if (axis < context_.axes()) {
      block_.xyz[axis] = value_;
      block_.axis_words = static_cast<AxisMask>(block_.axis_words | 1U << axis);
      return ErrorCode::Ok;
    }
    return takes(letter) ? ErrorCode::Ok : ErrorCode::UnsupportedCommand;
  }

  /// grblHAL asks for a whole number here; Grbl and Rabbit cut it.
  ErrorCode store_l() {
    if (!rules_.byte_commands && number().hundredths > 0) return ErrorCode::CommandValueNotInteger;
    block_.l = static_cast<std::uint8_t>(number().whole);
    return ErrorCode::Ok;
  }

  ErrorCode store_tool() {
    if (rules_.tool_max_at_once > 0.0F && value_ > rules_.tool_max_at_once) return ErrorCode::IllegalToolNumber;
    block_.has_tool_word = true;
    block_.t = rules_.byte_commands ? static_cast<float>(number().whole) : value_;
    if (rules_.tool_word_acts_at_once) context_.state.tool = static_cast<std::uint32_t>(number().whole);
    return ErrorCode::Ok;
  }

  const char* text_;
  Block& block_;
  BlockContext& context_;
  const GcodeRules& rules_;
  ParameterValues parameters_;
  ExpressionReader reader_;
  bool skips_;
  float value_ = 0.0F;
  /// The number read last, split when somebody asks: coordinates never are.
  std::optional<float> unsplit_;
  CommandNumber split_;
};

}  // namespace

ErrorCode collect_words(const char* text, Block& block, BlockContext& context) {
  return Collector(text, block, context).collect();
}

}  // namespace kerf::gcode
