#pragma once
// Rabbit GRBL 1.6.0, three axes (protocol.md; Config.h and Defaults.h of the newest public source).

#include "common/vocabulary/alarm_table.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/error_table.hpp"
#include "common/vocabulary/firmware_rows.hpp"
#include "common/vocabulary/settings_tables.hpp"

namespace kerf::vocabulary::dialects {

inline constexpr Dialect kRabbit{
    .firmware = Firmware::Rabbit,
    .name = "Rabbit GRBL",
    .key = "rabbit",
    .version = "1.1h",
    .build = "20260315",
    .welcome = "Rabbit GRBL v1.6.0 Build 20260315  ",
    .welcome_start = "Rabbit GRBL v",
    .options = "PH",
    .new_options = "",
    .firmware_field = "",
    .axes_default = 3,
    .axes_max = 6,
    .rx_bytes = {.usable = 255, .printed = 0},
    .planner_blocks = {.usable = 15, .printed = 0},
    .line_length = 255,
    .line_length_rule = LineLengthRule::EveryCharacter,
    .long_line_rule = LongLineRule::ErrorAtOnceRestIsLine,
    .stored_line_length = 255,
    .line_ending = LineEnding::CrLfIsOne,
    .percent_rule = PercentRule::Ignored,
    .block_delete_rule = BlockDeleteRule::Error,
    .comment_rule = CommentRule::RemovedByParser,
    .extended_ascii_rule = ExtendedAsciiRule::Dropped,
    .uppercases_lines = false,
    .removes_blanks_in_lines = false,
    .error_latch = false,
    .jog_cancel_flushes_rx = false,
    .feed_hold_cancels_jog = true,
    .critical_alarm_answers_lines = false,
    .failed_line_answers_across_reset = true,
    .answers_full_status = false,
    .can_enumerate_settings = false,
    .can_enumerate_codes = true,
    .reads_single_settings = true,
    .named_settings_query = "$+",
    .homing_phase_setting = 50,
    .homing_phase_count = 6,
    .tool_change = ToolChangeRule::Ignored,
    .welcome_on_connect = false,
    .opening_port_resets = false,
    .keeps_tool_over_reset = false,
    .keeps_g92_over_reset = false,
    .reports_homed = false,
    .report_mask_default = 1,
    .report_mask_max = 3,
    // Meant to be 20 and 30 when busy; a missing break always loads the idle value (protocol.md 3.1).
    .override_refresh = {.busy = 10, .idle = 10},
    .work_offset_refresh = {.busy = 10, .idle = 10},
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
    .errors = tables::kRowsOf<tables::kErrorRows, Firmware::Rabbit>,
    .alarms = tables::kRowsOf<tables::kAlarmRows, Firmware::Rabbit>,
    .settings = tables::kRabbitSettings,
    .ports = {.baud = 115200, .telnet = 5001, .websocket = 0},
};

}  // namespace kerf::vocabulary::dialects
