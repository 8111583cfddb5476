#pragma once
// Grbl 1.1h on an Uno-class board, default build (gnea/grbl bfb67f0, config.h and defaults.h generic).

#include "common/vocabulary/alarm_table.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/error_table.hpp"
#include "common/vocabulary/firmware_rows.hpp"
#include "common/vocabulary/settings_tables.hpp"

namespace kerf::vocabulary::dialects {

inline constexpr Dialect kGrbl{
    .firmware = Firmware::Grbl,
    .name = "Grbl",
    .key = "grbl",
    .version = "1.1h",
    .build = "20190830",
    .welcome = "Grbl 1.1h ['$' for help]",
    .welcome_start = "Grbl ",
    .options = "V",
    .new_options = "",
    .firmware_field = "",
    .axes_default = 3,
    .axes_max = 3,
    .rx_bytes = {.usable = 128, .printed = 128},
    .planner_blocks = {.usable = 15, .printed = 15},
    .line_length = 79,
    .line_length_rule = LineLengthRule::AfterStripping,
    .long_line_rule = LongLineRule::SwallowedThenError,
    .stored_line_length = 79,
    .line_ending = LineEnding::EachTerminatorAnswers,
    .percent_rule = PercentRule::Error,
    .block_delete_rule = BlockDeleteRule::SlashRemoved,
    .comment_rule = CommentRule::RemovedByReader,
    .extended_ascii_rule = ExtendedAsciiRule::Dropped,
    .uppercases_lines = true,
    .removes_blanks_in_lines = true,
    .error_latch = false,
    .jog_cancel_flushes_rx = false,
    .feed_hold_cancels_jog = true,
    .critical_alarm_answers_lines = false,
    .failed_line_answers_across_reset = true,
    .answers_full_status = false,
    .can_enumerate_settings = false,
    .can_enumerate_codes = false,
    .reads_single_settings = false,
    .homing_phases = "Z,XY",
    .tool_change = ToolChangeRule::Refused,
    .welcome_on_connect = false,
    .opening_port_resets = true,
    .keeps_tool_over_reset = false,
    .keeps_g92_over_reset = false,
    .reports_homed = false,
    .report_mask_default = 1,
    .report_mask_max = 255,
    .override_refresh = {.busy = 20, .idle = 10},
    .work_offset_refresh = {.busy = 30, .idle = 10},
    .alarm_delay = std::chrono::milliseconds{500},
    .override_min_percent = 10,
    .override_max_percent = 200,
    .numbers = {.feed_decimals_inch = 1, .speed_has_trailing_dot = false},
    .tool_length_offset_per_axis = false,
    .realtime = RealtimeSet{}
                    .add(Realtime::SoftReset)
                    .add(Realtime::FeedHold)
                    .add(Realtime::StatusQuery)
                    .add(Realtime::CycleStart)
                    .add_range(0x80, 0xFF),
    .field_order = kGrblFieldOrder,
    .errors = tables::kRowsOf<tables::kErrorRows, Firmware::Grbl>,
    .alarms = tables::kRowsOf<tables::kAlarmRows, Firmware::Grbl>,
    .settings = tables::kGrblSettings,
    .ports = {.baud = 115200, .telnet = 0, .websocket = 0},
};

}  // namespace kerf::vocabulary::dialects
