#pragma once
// grblHAL, core of August 2026 at compatibility level 0, built for its simulator: three axes, no expressions, no tool
// table (protocol.md; transcripts 01 to 10).

#include "common/vocabulary/alarm_table.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/error_table.hpp"
#include "common/vocabulary/firmware_rows.hpp"
#include "common/vocabulary/settings_tables.hpp"

namespace kerf::vocabulary::dialects {

inline constexpr Dialect kGrblHal{
    .firmware = Firmware::GrblHal,
    .name = "grblHAL",
    .key = "grblhal",
    .version = "1.1f",
    .build = "20260817",
    .welcome = "GrblHAL 1.1f ['$' or '$HELP' for help]",
    .welcome_start = "GrblHAL ",
    .options = "VNML+",
    .new_options = "ENUMS,RT+,TC,SED",
    .firmware_field = "grblHAL",
    .axes_default = 3,
    .axes_max = 8,
    .rx_bytes = {.usable = 1023, .printed = 1024},
    .planner_blocks = {.usable = 100, .printed = 100},
    .line_length = 256,
    .line_length_rule = LineLengthRule::AfterLeadingBlanks,
    .long_line_rule = LongLineRule::RefusedAtEnd,
    .stored_line_length = 68,  // 70 bytes, of which two stay free (system.c 639-758, transcript 43)
    .line_ending = LineEnding::PairedEitherWay,
    .percent_rule = PercentRule::ProgramToggle,
    .block_delete_rule = BlockDeleteRule::SkippedIfOn,
    .comment_rule = CommentRule::ParsedForMessages,
    .extended_ascii_rule = ExtendedAsciiRule::KeptInSystemLines,
    .uppercases_lines = false,
    .removes_blanks_in_lines = false,
    .error_latch = true,
    .jog_cancel_flushes_rx = true,
    .feed_hold_cancels_jog = false,
    .critical_alarm_answers_lines = true,
    .failed_line_answers_across_reset = false,
    .answers_full_status = true,
    .can_enumerate_settings = true,
    .can_enumerate_codes = true,
    .reads_single_settings = true,
    .homing_phase_setting = 44,
    .homing_phase_count = 6,
    .tool_change = ToolChangeRule::AsTold,
    .welcome_on_connect = true,
    .opening_port_resets = false,
    .keeps_tool_over_reset = true,
    .keeps_g92_over_reset = true,
    .reports_homed = true,
    .report_mask_default = 511,
    .report_mask_max = 16383,
    .override_refresh = {.busy = 20, .idle = 10},
    .work_offset_refresh = {.busy = 30, .idle = 10},
    .alarm_delay = std::chrono::milliseconds{100},
    .override_min_percent = 10,
    .override_max_percent = 200,
    .numbers = {.feed_decimals_inch = 0, .speed_has_trailing_dot = true},
    .tool_length_offset_per_axis = true,
    // Control bytes vanish in the receive interrupt, but for backspace, CR, LF and 0x14, which needs an ESC before it
    // (protocol.c 822-1028).
    .realtime = RealtimeSet{}
                    .add_range(0x00, 0x07)
                    .add(std::uint8_t{0x09})
                    .add_range(0x0B, 0x0C)
                    .add_range(0x0E, 0x13)
                    .add_range(0x15, 0x1F)
                    .add(Realtime::FeedHold)
                    .add(Realtime::StatusQuery)
                    .add(Realtime::CycleStart)
                    .add_range(0x80, 0xFF),
    .field_order = kGrblHalFieldOrder,
    .errors = tables::kRowsOf<tables::kErrorRows, Firmware::GrblHal>,
    .alarms = tables::kRowsOf<tables::kAlarmRows, Firmware::GrblHal>,
    .settings = tables::kAllGrblHalSettings,
    .ports = {.baud = 115200, .telnet = 23, .websocket = 81},
};

/// The same core built with NGC_EXPRESSIONS_ENABLE.
inline constexpr Dialect kGrblHalExpressions = [] {
  Dialect dialect = kGrblHal;
  dialect.key = "grblhal-expr";
  dialect.new_options = "ENUMS,RT+,EXPR,TC,SED";
  dialect.builds = {BuildOption::Usual, BuildOption::Expressions};
  return dialect;
}();

}  // namespace kerf::vocabulary::dialects
