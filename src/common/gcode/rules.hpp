#pragma once
// What one firmware's G-code reader and interpreter do differently from another's, as values and named policies.

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string_view>

#include "common/vocabulary/errors.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::gcode {

struct Block;
struct BlockContext;
struct CommandRow;

/// How text becomes lines (protocol.md 6.2, 6.3).
struct LineRules {
  enum class Filter : std::uint8_t {
    StripWhileReading,  // Grbl: blanks, control characters, comments and `/` never reach the line; letters become upper
                        // case
    KeepRaw,            // Rabbit: every byte is kept until the interpreter collapses the line
    TrimLeading,        // grblHAL: leading blanks and all control characters go, the rest is kept
  };
  enum class Pairing : std::uint8_t {
    None,          // CR and LF each end a line
    LineFeedLast,  // the LF of CR LF is swallowed
    Either,        // the second half of CR LF or LF CR is swallowed, except after a failed block
  };
  Filter filter = Filter::StripWhileReading;
  Pairing pairing = Pairing::None;
  /// Longest line that is taken, counted after filtering.
  std::size_t length_max = 79;
  /// Rabbit answers error:11 at the byte that does not fit, and the rest becomes a new line.
  bool overlong_at_once = false;
  /// Backspace takes the last character back.
  bool edits = false;
  /// DEL does so too.
  bool delete_edits = false;
};

/// Where the firmware's C code computes in double and where in float.
enum class FloatRule : std::uint8_t {
  Single,            // Grbl on AVR: double is float; grblHAL: float literals and float functions
  PromotedLiterals,  // Rabbit: double literals promote the expression
};

/// How a block's text is made ready for its words.
enum class BlockText : std::uint8_t {
  AsRead,        // Grbl: the reader has done it
  Collapsed,     // Rabbit: blanks, comments, `%` go, upper case
  WithMessages,  // grblHAL: the same, `/` is block delete, `(MSG,...)` is a message, `%` alone demarcates
};

/// One step of checking a block; the order of the steps decides which of several errors is answered.
using CheckStep = std::expected<void, vocabulary::ErrorCode> (*)(Block&, BlockContext&);
/// One step of carrying out a block that passed all checks.
using ActStep = void (*)(Block&, BlockContext&);

struct GcodeRules {
  vocabulary::Firmware firmware = vocabulary::Firmware::Unknown;
  LineRules line;
  BlockText block_text = BlockText::AsRead;
  FloatRule floats = FloatRule::Single;

  /// Bits that the integer part of a command number is cut to: G257 is G1 on Grbl and Rabbit, apart from its fraction.
  int command_bits = 8;
  /// O and `$` are words.
  bool has_spindle_words = false;
  /// G and M words that exist, sorted by letter and number.
  std::span<const CommandRow> commands;
  /// Letters that carry values, and the letters among them that may not be negative or fractional when they are read.
  std::string_view value_letters;
  std::string_view non_negative_letters;
  std::string_view integer_letters;
  std::int32_t line_number_max = 10000000;
  std::uint32_t tool_max = 255;
  int work_offsets = 6;

  std::span<const CheckStep> checks;
  std::span<const ActStep> acts;

  /// Rabbit: T changes the tool while the line is read, even if the line is rejected later.
  bool tool_word_acts_at_once = false;
  /// What a reset wipes (protocol.md 1.2).
  bool reset_clears_tool = true;
  bool reset_clears_g92 = true;
  bool reset_clears_tool_length = true;

  /// [GC:] lists (protocol.md 4.2).
  bool reports_all_groups = false;
  /// Rabbit prints G38.2 to G38.5 as G38.1 to G38.4.
  int probe_report_shift = 0;
  /// grblHAL prints whole speeds with a trailing dot.
  bool rpm_with_dot = false;
};

/// The rules of a firmware; an unknown one is read as Grbl 1.1h.
[[nodiscard]] const GcodeRules& rules_for(vocabulary::Firmware firmware);

}  // namespace kerf::gcode
