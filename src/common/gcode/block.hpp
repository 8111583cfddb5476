#pragma once
// One block between reading and execution: the words it has, the modal state it asks for, and what the checks computed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/gcode/flow.hpp"
#include "common/gcode/interpreter.hpp"
#include "common/gcode/parser_state.hpp"

namespace kerf::gcode {

using vocabulary::AxisMask;
using vocabulary::ErrorCode;

/// Modal groups of G and M words; two words of one group in a block answer error:21. `None` never clashes.
enum class Group : std::uint8_t {
  None,
  G0,   // non-modal: G4 G10 G28 G30 G53 G92
  G1,   // motion
  G2,   // plane
  G3,   // distance
  G4,   // arc distance
  G5,   // feed mode
  G6,   // units
  G7,   // cutter compensation
  G8,   // tool length
  G10,  // retract mode
  G11,  // scaling
  G12,  // work offset
  G13,  // path control
  G14,  // spindle speed mode (lathe)
  G15,  // diameter or radius (lathe)
  G16,  // macro call
  M4,   // program flow
  M6,   // tool change
  M7,   // spindle
  M8,   // coolant
  M9,   // overrides
  M10,  // pins (Rabbit)
};

enum class NonModal : std::uint8_t {
  None,
  Dwell,                   // G4
  SetData,                 // G10
  GoHome28,                // G28
  GoHome30,                // G30
  SetHome28,               // G28.1
  SetHome30,               // G30.1
  AbsoluteOverride,        // G53
  SetCoordinateOffset,     // G92
  ResetCoordinateOffset,   // G92.1
  ClearCoordinateOffset,   // G92.2
  RestoreCoordinateOffset  // G92.3
};

/// Who uses the axis words.
enum class AxisCommand : std::uint8_t { None, NonModal, Motion, ToolLength, Scaling };

enum class OverrideWord : std::uint8_t { None, Enable, Disable, Feed, Spindle, FeedHold, Parking };
enum class MacroCall : std::uint8_t { None, End, NonModal, Modal, ModalEachBlock, Subprogram };
enum class SavedState : std::uint8_t { None, Save, Invalidate, Restore };
enum class CoolantWord : std::uint8_t { None, Mist, Flood, Off };
/// Rabbit's M62 to M68.
enum class PinWord : std::uint8_t { None, Digital, Analog };

/// grblHAL's M62 to M68.
enum class PortWord : std::uint8_t {
  None,
  OnWithMotion,
  OffWithMotion,
  On,
  Off,
  Wait,
  AnalogWithMotion,
  Analog,
};

/// False if the machine has no port that this word is about.
[[nodiscard]] bool has_port_for(PortWord word, const PortCounts& ports);

/// Letters with a value, one bit a letter; `$` follows Z.
class WordSet {
 public:
  [[nodiscard]] bool has(char letter) const { return (bits_ & bit(letter)) != 0; }
  [[nodiscard]] bool has_any(std::string_view letters) const {
    for (const char letter : letters)
      if (has(letter)) return true;
    return false;
  }
  void add(char letter) { bits_ |= bit(letter); }
  void take(char letter) { bits_ &= ~bit(letter); }
  void take_all(std::string_view letters) {
    for (const char letter : letters) take(letter);
  }
  [[nodiscard]] bool is_empty() const { return bits_ == 0; }
  [[nodiscard]] bool is_only(char letter) const { return bits_ == bit(letter); }

 private:
  static constexpr std::uint32_t bit(char letter) { return 1U << (letter == '$' ? 26 : letter - 'A'); }
  std::uint32_t bits_ = 0;
};

class GroupSet {
 public:
  [[nodiscard]] bool has(Group group) const { return (bits_ & bit(group)) != 0; }
  void add(Group group) { bits_ |= bit(group); }
  void remove(Group group) { bits_ &= ~bit(group); }
  /// Something besides `others`.
  [[nodiscard]] bool has_more_than(std::initializer_list<Group> others) const {
    std::uint32_t rest = bits_;
    for (const Group group : others) rest &= ~bit(group);
    return rest != 0;
  }

 private:
  static constexpr std::uint32_t bit(Group group) {
    return group == Group::None ? 0U : 1U << static_cast<unsigned>(group);
  }
  std::uint32_t bits_ = 0;
};

struct Block {
  bool jog = false;
  ModalState modal;
  GroupSet groups;
  WordSet words;
  /// Nothing more to check or to do (G66).
  bool finished = false;
  AxisMask axis_words = 0;
  std::uint8_t ijk_words = 0;

  NonModal non_modal = NonModal::None;
  AxisCommand axis_command = AxisCommand::None;
  OverrideWord override_word = OverrideWord::None;
  MacroCall macro = MacroCall::None;
  SavedState saved_state = SavedState::None;
  CoolantWord coolant_word = CoolantWord::None;
  PinWord pin_word = PinWord::None;
  PortWord port_word = PortWord::None;
  bool port_is_analog = false;
  ProgramFlow flow = ProgramFlow::Running;
  bool tool_change = false;
  bool tool_set = false;
  bool has_tool_word = false;
  bool scaling_word = false;

  /// Axis words, later the target in machine coordinates, mm.
  AxisValues xyz{};
  std::array<float, 3> ijk{};
  float d = 0.0F;
  float f = 0.0F;
  float h = 0.0F;
  float k_pitch = 0.0F;
  float p = 0.0F;
  float q = 0.0F;
  float r = 0.0F;
  float s = 0.0F;
  float t = 0.0F;
  std::int32_t n = 0;
  std::int32_t spindle_id = 0;
  std::uint8_t e = 0;
  std::uint8_t l = 0;

  PlaneAxes plane{.first = 0, .second = 1, .linear = 2};
  /// Work offset in force in this block.
  AxisValues work_offset_mm{};
  /// G10: the offset to write and its value; G28, G30: where to go.
  std::uint8_t stored_index = 0;
  AxisValues stored_mm{};
  bool clockwise = false;
  int turns = 1;
  bool cycle_changes = false;

  bool laser_disable = false;
  bool laser_is_motion = false;
  bool spindle_force_sync = false;

  /// G10 L1, L10, L11: what becomes of the table entry `stored_index`.
  std::optional<Tool> tool_entry;

  MacroRequest macro_request;
  /// Values of all words as they were written, A to Z (grblHAL).
  std::array<float, 26> written{};
  FlowLabel label;
  /// `#1=5`: done when the block is.
  struct Assignment {
    std::uint16_t parameter = 0;
    float value = 0.0F;
  };
  std::vector<Assignment> assignments;
  std::string message;

  [[nodiscard]] bool has_axis(std::size_t axis) const { return (axis_words >> axis & 1U) != 0; }
  [[nodiscard]] bool has_ijk(std::size_t axis) const { return (ijk_words >> axis & 1U) != 0; }
};

/// What the steps work on besides the block.
struct BlockContext {
  const GcodeRules& rules;
  const InterpreterSettings& settings;
  ParserState& state;
  Offsets& offsets;
  std::vector<Action>& out;
  Parameters& parameters;
  FlowControl& flow;
  MachineFacts* machine = nullptr;

  [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(settings.axes); }
  /// Is there such an entry in the tool table? (grblHAL)
  [[nodiscard]] bool knows_tool(float number) const { return number <= static_cast<float>(settings.tools); }
  [[nodiscard]] ParameterValues values() const {
    return {.written = parameters, .state = state, .offsets = offsets, .settings = settings, .machine = machine};
  }
  /// The table; made when it is first asked for.
  [[nodiscard]] std::vector<Tool>& tools() const {
    offsets.tools.resize(static_cast<std::size_t>(settings.tools) + 1);
    return offsets.tools;
  }
};

/// Text of a block, ready for its words, and NUL-terminated for the 8-bit counters of the firmwares.
struct BlockBuffer {
  static constexpr std::size_t kCapacity = 257;
  std::array<char, kCapacity> text;
  std::size_t length = 0;

  void append(char c) {
    if (length + 1 < kCapacity) text[length++] = c;
  }
};

/// Strips a line as the firmware's interpreter does; `(MSG,...)` and `%` become what the block says besides its words.
struct PreparedText {
  std::string message;
  bool has_message = false;
  bool demarcates = false;
  /// `(abort,...)`.
  ErrorCode error = ErrorCode::Ok;
};
/// In a jog `/` has no meaning: it does not begin the line.
PreparedText prepare_text(std::string_view line, bool jog, BlockContext& context, BlockBuffer& buffer);

/// Reads the words of a NUL-terminated text into the block.
[[nodiscard]] ErrorCode collect_words(const char* text, Block& block, BlockContext& context);

}  // namespace kerf::gcode
