#pragma once
// What one firmware's G-code reader and interpreter do differently from another's, as values and named policies.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/gcode/print_number.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/errors.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::gcode {

struct Block;
struct BlockContext;
class CommandTable;

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

/// Which [GC:] words a firmware prints (protocol.md 4.2).
enum class ReportedGroups : std::uint8_t {
  Grbl,
  Rabbit,  // the same; G38.2 to G38.5 appear as G38.1 to G38.4
  All,     // grblHAL: with G92, G40, G49, G98, G50, overrides; S has a trailing dot
};

/// One step of checking a block. The order of the steps decides which of several errors is answered.
using CheckStep = vocabulary::ErrorCode (*)(Block&, BlockContext&);
/// One step of carrying out a block that passed all checks; a few of them can still fail.
using ActStep = vocabulary::ErrorCode (*)(Block&, BlockContext&);

struct GcodeRules {
  vocabulary::Firmware firmware = vocabulary::Firmware::Unknown;
  LineRules line{};
  BlockText block_text = BlockText::AsRead;

  FloatRule floats = FloatRule::Single;
  /// Digits of a number that count; further ones only shift it.
  int digits_max = 8;
  bool counts_leading_zeros = true;
  /// Command numbers are cut to 8 bits, apart from their fraction: G257 is G1 with a fraction of 256.
  bool byte_commands = true;

  /// G and M words that exist.
  const CommandTable* commands = nullptr;
  /// Letters besides G, M and the machine's axes that carry values. An axis letter among them is taken, and then unused
  /// (error:36), on a machine that lacks the axis.
  std::string_view value_letters;
  /// Letters that may not be negative, asked as soon as they are read.
  std::string_view non_negative_letters;
  /// Tool number above which T is refused when it is read (Grbl, Rabbit); 0: asked later, by a check.
  float tool_max_at_once = 255.0F;
  std::uint8_t work_offsets = 6;

  std::span<const CheckStep> checks;
  std::span<const ActStep> acts;

  /// Rabbit: T changes the tool while the line is read, even if the line is rejected later.
  bool tool_word_acts_at_once = false;
  /// Rabbit: a line of nothing but comment is a block without words; it ends N, and F in inverse time.
  bool runs_empty_blocks = false;
  /// Rabbit: with G93 even G0 wants F.
  bool rapid_wants_inverse_feed = false;
  /// Rabbit: G10 looks at L before P.
  bool g10_checks_l_first = false;
  /// Rabbit: M7, M8, M9 act even if nothing changes, and M9 does not wait for the motion.
  bool coolant_word_always_acts = false;
  /// grblHAL: a failed line drops the tool that M6 was to bring, and G66.
  bool failure_drops_pending_work = false;
  /// Program end puts overrides back to 100 % (grblHAL: `$60`).
  bool program_end_restores_overrides = true;

  /// grblHAL built with NGC_EXPRESSIONS_ENABLE: expressions, assignments and O words.
  bool reads_expressions = false;

  /// grblHAL: G92 is kept in storage as well.
  bool stores_g92 = false;

  ReportedGroups report = ReportedGroups::Grbl;
  NumberPrinter printer = NumberPrinter::ScaleThenCut;

  /// What a reset wipes (protocol.md 1.2).
  bool reset_clears_tool = true;
  bool reset_clears_g92 = true;
  bool reset_clears_tool_length = true;
};

/// The rules of a firmware; an unknown one is read as Grbl 1.1h.
[[nodiscard]] const GcodeRules& rules_for(vocabulary::Firmware firmware);
/// The rules of one build of a firmware.
[[nodiscard]] const GcodeRules& rules_for(const vocabulary::Dialect& dialect);

}  // namespace kerf::gcode
