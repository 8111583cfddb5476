#pragma once
// Everything that both ends of the wire must agree on about one firmware, as a value. What only the virtual controller
// needs stands in firmware/personality.

#include <cstdint>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/vocabulary/codes.hpp"
#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/realtime.hpp"
#include "common/vocabulary/settings.hpp"
#include "common/vocabulary/status_fields.hpp"

namespace kerf::vocabulary {

/// How CR and LF are answered (protocol.md 6.2).
enum class LineEnding : std::uint8_t {
  EachTerminatorAnswers,  ///< Grbl: CRLF is a line and an empty line, two answers
  CrLfIsOne,              ///< Rabbit 1.6: an LF after a CR is swallowed
  PairedEitherWay,        ///< grblHAL: CRLF and LFCR are one, unless the line was g-code that failed
};
BOOST_DESCRIBE_ENUM(LineEnding, EachTerminatorAnswers, CrLfIsOne, PairedEitherWay)

/// What counts towards `line_length` (protocol.md 6.1).
enum class LineLengthRule : std::uint8_t {
  AfterStripping,      ///< Grbl: without blanks, comments and `/`
  EveryCharacter,      ///< Rabbit
  AfterLeadingBlanks,  ///< grblHAL
};
BOOST_DESCRIBE_ENUM(LineLengthRule, AfterStripping, EveryCharacter, AfterLeadingBlanks)

/// What happens to a line that is too long (protocol.md 6.3).
enum class LongLineRule : std::uint8_t {
  SwallowedThenError,     ///< Grbl: the rest is swallowed, one error:11 at its end
  ErrorAtOnceRestIsLine,  ///< Rabbit: error:11 at once, the rest is a new line, which may execute
  RefusedAtEnd,           ///< grblHAL: error:11 at its end, nothing executed
};
BOOST_DESCRIBE_ENUM(LongLineRule, SwallowedThenError, ErrorAtOnceRestIsLine, RefusedAtEnd)

/// What becomes of `%`.
enum class PercentRule : std::uint8_t { Error, Ignored, ProgramToggle };
BOOST_DESCRIBE_ENUM(PercentRule, Error, Ignored, ProgramToggle)

/// What becomes of a leading `/`.
enum class BlockDeleteRule : std::uint8_t {
  SlashRemoved,  ///< Grbl: the block runs
  Error,         ///< Rabbit: error:1
  SkippedIfOn,   ///< grblHAL: skipped if block delete is on
};
BOOST_DESCRIBE_ENUM(BlockDeleteRule, SlashRemoved, Error, SkippedIfOn)

/// Who deals with `( )` and `;` comments.
enum class CommentRule : std::uint8_t {
  RemovedByReader,    ///< Grbl: before the line's length is counted
  RemovedByParser,    ///< Rabbit
  ParsedForMessages,  ///< grblHAL: `(MSG,...)` is printed
};
BOOST_DESCRIBE_ENUM(CommentRule, RemovedByReader, RemovedByParser, ParsedForMessages)

/// What becomes of 0x80-0xFF bytes that no realtime command claims (protocol.md 2).
enum class ExtendedAsciiRule : std::uint8_t {
  Dropped,            ///< Grbl, Rabbit
  KeptInSystemLines,  ///< grblHAL: 0xC0-0xFF stay in `$` and `[` lines and comments while realtime characters do
};
BOOST_DESCRIBE_ENUM(ExtendedAsciiRule, Dropped, KeptInSystemLines)

/// What becomes of M6 in builds without a tool changer.
enum class ToolChangeRule : std::uint8_t {
  Unknown,
  Refused,  ///< Grbl: error:20
  Ignored,  ///< Rabbit: accepted, nothing happens
  AsTold,   ///< grblHAL: `$341` and `[NEWOPT:]` say
};
BOOST_DESCRIBE_ENUM(ToolChangeRule, Unknown, Refused, Ignored, AsTold)

/// Size of a queue as `Bf:` reports it when empty, and as `[OPT:` prints it (0: not printed).
struct BufferSize {
  int usable{};
  int printed{};
  friend constexpr bool operator==(const BufferSize&, const BufferSize&) = default;
};
BOOST_DESCRIBE_STRUCT(BufferSize, (), (usable, printed))

/// How often a field comes back by itself: every n-th report (protocol.md 3.4).
struct RefreshCount {
  int busy{};
  int idle{};
  friend constexpr bool operator==(const RefreshCount&, const RefreshCount&) = default;
};
BOOST_DESCRIBE_STRUCT(RefreshCount, (), (busy, idle))

/// Where a machine with this firmware listens by default; 0 where it has no such thing.
struct DefaultPorts {
  int baud{};
  int telnet{};
  int websocket{};
  friend constexpr bool operator==(const DefaultPorts&, const DefaultPorts&) = default;
};
BOOST_DESCRIBE_STRUCT(DefaultPorts, (), (baud, telnet, websocket))

/// How numbers are printed (protocol.md 3.1, 4.2).
struct NumberStyle {
  int position_decimals_mm = 3;
  int position_decimals_inch = 4;
  int feed_decimals_mm = 0;
  int feed_decimals_inch = 1;
  bool speed_has_trailing_dot = false;  ///< grblHAL prints S in `[GC:]` as `S0.`
  friend constexpr bool operator==(const NumberStyle&, const NumberStyle&) = default;
};
BOOST_DESCRIBE_STRUCT(NumberStyle, (),
                      (position_decimals_mm, position_decimals_inch, feed_decimals_mm, feed_decimals_inch,
                       speed_has_trailing_dot))

/// One firmware, as its reference build behaves.
struct Dialect {
  Firmware firmware{};
  std::string_view name;                   ///< for people: "grblHAL"
  std::string_view key;                    ///< in URLs and options: "grblhal"
  std::string_view version;                ///< as `[VER:` prints it: "1.1f"
  std::string_view build;                  ///< as `[VER:` prints it: "20260817"
  std::string_view welcome;                ///< the line after a reset, complete, without line ends
  std::string_view welcome_start;          ///< what tells its welcome from another firmware's: "GrblHAL "
  std::string_view options;                ///< letters of `[OPT:` in the reference build
  std::string_view new_options;            ///< tokens of `[NEWOPT:` in the reference build
  std::string_view firmware_field;         ///< of `|FW:` and `[FIRMWARE:`; empty if it prints none
  BuildSet builds = {BuildOption::Usual};  ///< what this build has beyond the usual

  int axes_default = 3;
  int axes_max = 3;
  BufferSize rx_bytes;
  BufferSize planner_blocks;
  int line_length{};  ///< most characters of a line that are accepted
  LineLengthRule line_length_rule{};
  LongLineRule long_line_rule{};
  int stored_line_length{};  ///< most characters of a startup line or of the text of `$I=`

  LineEnding line_ending{};
  PercentRule percent_rule{};
  BlockDeleteRule block_delete_rule{};
  CommentRule comment_rule{};
  ExtendedAsciiRule extended_ascii_rule{};
  bool uppercases_lines = false;         ///< Grbl: every line, also texts of `$I=`
  bool removes_blanks_in_lines = false;  ///< Grbl: also inside texts
  bool error_latch = false;              ///< an error makes later g-code lines fail unexecuted (protocol.md 6.4)
  bool jog_cancel_flushes_rx = false;    ///< unread lines vanish unanswered at 0x85
  bool feed_hold_cancels_jog = false;
  bool critical_alarm_answers_lines = false;
  bool failed_line_answers_across_reset =
      false;                         ///< the line that a reset interrupts is still answered (protocol.md 4.4)
  bool answers_full_status = false;  ///< to 0x87
  bool can_enumerate_settings = false;
  bool can_enumerate_codes = false;         ///< `$EA` and `$EE`
  bool reads_single_settings = false;       ///< `$110`
  std::string_view named_settings_query{};  ///< lists settings that have a name only; empty where there are none
  std::string_view homing_phases{};         ///< where the build fixes them: "Z,XY"
  int homing_phase_setting = 0;             ///< the first phase's axis mask, where settings hold them
  int homing_phase_count = 0;
  ToolChangeRule tool_change = ToolChangeRule::Unknown;
  bool welcome_on_connect = false;   ///< a new network client is greeted
  bool opening_port_resets = false;  ///< DTR on an Uno-class board
  bool keeps_tool_over_reset = false;
  bool keeps_g92_over_reset = false;
  bool reports_homed = false;

  std::uint32_t report_mask_default{};  ///< `$10`
  std::uint32_t report_mask_max{};
  RefreshCount override_refresh;
  RefreshCount work_offset_refresh;
  Duration alarm_delay{};  ///< output stands still after `ALARM:`
  int override_min_percent = 10;
  int override_max_percent = 200;
  NumberStyle numbers;
  bool tool_length_offset_per_axis = false;  ///< `[TLO:` has one value an axis, not one in all

  RealtimeSet realtime;  ///< bytes that never become part of a line: acted on or dropped
  std::span<const StatusField> field_order;
  std::span<const CodeRow> errors;
  std::span<const CodeRow> alarms;
  std::span<const SettingRow> settings;
  DefaultPorts ports;
};

/// The dialect of `firmware`; an unknown firmware has one that is safe with all three (Grbl's limits, no latch, no
/// extras).
[[nodiscard]] const Dialect& dialect_of(Firmware firmware);

/// Grbl, Rabbit, grblHAL: those that have a virtual controller.
[[nodiscard]] std::span<const Dialect* const> all_dialects();

/// The dialect whose `key` is `key`; other builds of a firmware ("grblhal-expr") have keys too.
[[nodiscard]] const Dialect* find_dialect(std::string_view key);

/// True if `byte` never becomes part of a line that goes to `dialect`'s controller.
[[nodiscard]] constexpr bool is_realtime(const Dialect& dialect, std::uint8_t byte) {
  return dialect.realtime.contains(byte);
}

}  // namespace kerf::vocabulary
