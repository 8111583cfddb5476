// Sizes, policies and motion rules: one row a figure, one column a firmware.

#include <functional>

#include <boost/describe.hpp>

#include "common/base/text.hpp"
#include "common/motion/rules.hpp"
#include "firmware/personality.hpp"
#include "markdown.hpp"

namespace kerf::tools {

using firmware::Personality;
using vocabulary::Dialect;

namespace {

std::string count(auto value) {
  return std::to_string(value);
}

std::string milliseconds(Duration duration) {
  constexpr double kPerSecond = 1000.0;
  return base::to_fixed(base::to_seconds(duration) * kPerSecond, 0) + " ms";
}

std::string nth(vocabulary::RefreshCount refresh) {
  return count(refresh.busy) + " / " + count(refresh.idle);
}

/// The enumerator's name with blanks: "CrLfIsOne" is "cr lf is one".
template <typename Enum>
std::string words_of(Enum value) {
  std::string text;
  for (const char letter : std::string_view{boost::describe::enum_to_string(value, "")}) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    if (is_capital && !text.empty()) text += ' ';
    text += is_capital ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return text;
}

/// Rows for the three firmwares.
template <typename Of>
class Figures {
 public:
  explicit Figures(std::function<const Of&(const Personality&)> pick)
      : pick_(std::move(pick)), table_({"", "Grbl", "Rabbit", "grblHAL"}) {}

  Figures& row(std::string_view label, const std::function<std::string(const Of&)>& cell) {
    std::vector<std::string> cells = {std::string{label}};
    for (const auto* const personality : firmware::all_personalities()) cells.push_back(cell(pick_(*personality)));
    table_.row(cells);
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return table_.text(); }

 private:
  std::function<const Of&(const Personality&)> pick_;
  Table table_;
};

using D = const Dialect&;

std::string identity_table() {
  Figures<Dialect> figures([](const Personality& personality) -> D { return personality.dialect(); });
  return figures.row("welcome", [](D d) { return code(d.welcome); })
      .row("`[VER:`",
           [](D d) { return code(std::string{d.version} + (d.build.empty() ? "" : "." + std::string{d.build})); })
      .row("`[OPT:` letters", [](D d) { return code(d.options); })
      .row("`[NEWOPT:`", [](D d) { return code(d.new_options); })
      .row("`FW:`", [](D d) { return code(d.firmware_field); })
      .row("axes, most", [](D d) { return count(d.axes_default) + ", " + count(d.axes_max); })
      .row("serial rate", [](D d) { return count(d.ports.baud); })
      .row("telnet port", [](D d) { return d.ports.telnet == 0 ? "–" : count(d.ports.telnet); })
      .row("websocket port", [](D d) { return d.ports.websocket == 0 ? "–" : count(d.ports.websocket); })
      .row("a network client is greeted", [](D d) { return tick(d.welcome_on_connect); })
      .row("opening the port resets", [](D d) { return tick(d.opening_port_resets); })
      .text();
}

std::string lines_table() {
  Figures<Dialect> figures([](const Personality& personality) -> D { return personality.dialect(); });
  return figures.row("receive buffer, usable bytes", [](D d) { return count(d.rx_bytes.usable); })
      .row("receive buffer as `[OPT:` prints it",
           [](D d) { return d.rx_bytes.printed == 0 ? "–" : count(d.rx_bytes.printed); })
      .row("planner blocks, usable", [](D d) { return count(d.planner_blocks.usable); })
      .row("planner blocks as `[OPT:` prints it",
           [](D d) { return d.planner_blocks.printed == 0 ? "–" : count(d.planner_blocks.printed); })
      .row("longest line", [](D d) { return count(d.line_length); })
      .row("what counts", [](D d) { return words_of(d.line_length_rule); })
      .row("too long a line", [](D d) { return words_of(d.long_line_rule); })
      .row("longest startup line", [](D d) { return count(d.stored_line_length); })
      .row("CR and LF", [](D d) { return words_of(d.line_ending); })
      .row("`%`", [](D d) { return words_of(d.percent_rule); })
      .row("leading `/`", [](D d) { return words_of(d.block_delete_rule); })
      .row("comments", [](D d) { return words_of(d.comment_rule); })
      .row("bytes from 0x80 without meaning", [](D d) { return words_of(d.extended_ascii_rule); })
      .row("an error latches", [](D d) { return tick(d.error_latch); })
      .row("0x85 empties the receive buffer", [](D d) { return tick(d.jog_cancel_flushes_rx); })
      .row("`!` cancels a jog", [](D d) { return tick(d.feed_hold_cancels_jog); })
      .row("lines are answered in a critical alarm", [](D d) { return tick(d.critical_alarm_answers_lines); })
      .row("a line that a reset interrupts is answered", [](D d) { return tick(d.failed_line_answers_across_reset); })
      .row("silence after `ALARM:`", [](D d) { return milliseconds(d.alarm_delay); })
      .text();
}

std::string report_table() {
  Figures<Dialect> figures([](const Personality& personality) -> D { return personality.dialect(); });
  return figures
      .row("`$10` by default, highest",
           [](D d) { return count(d.report_mask_default) + ", " + count(d.report_mask_max); })
      .row("`Ov:` every n-th report, busy / idle", [](D d) { return nth(d.override_refresh); })
      .row("`WCO:` every n-th report, busy / idle", [](D d) { return nth(d.work_offset_refresh); })
      .row("0x87 is answered", [](D d) { return tick(d.answers_full_status); })
      .row("decimals of positions, mm / inch",
           [](D d) { return count(d.numbers.position_decimals_mm) + " / " + count(d.numbers.position_decimals_inch); })
      .row("decimals of feeds, mm / inch",
           [](D d) { return count(d.numbers.feed_decimals_mm) + " / " + count(d.numbers.feed_decimals_inch); })
      .row("override range, %",
           [](D d) { return count(d.override_min_percent) + " to " + count(d.override_max_percent); })
      .row("`$EA`, `$EE`", [](D d) { return tick(d.can_enumerate_codes); })
      .row("`$ES`, `$EG`", [](D d) { return tick(d.can_enumerate_settings); })
      .row("`$110` reads one setting", [](D d) { return tick(d.reads_single_settings); })
      .row("tool survives a reset", [](D d) { return tick(d.keeps_tool_over_reset); })
      .row("G92 survives a reset", [](D d) { return tick(d.keeps_g92_over_reset); })
      .row("`H:` tells whether it is homed", [](D d) { return tick(d.reports_homed); })
      .text();
}

using R = const motion::MotionRules&;

std::string motion_table() {
  Figures<motion::MotionRules> figures(
      [](const Personality& personality) -> R { return motion::rules_of(personality.firmware); });
  return figures
      .row("arithmetic",
           [](R r) {
             return std::string{r.float_rule == motion::FloatRule::Single ? "32 bits throughout"
                                                                          : "32 bits, literals and functions 64"};
           })
      .row("planner blocks", [](R r) { return count(r.planner_blocks); })
      .row("prepared segments", [](R r) { return count(r.segment_slots); })
      .row("segments per second", [](R r) { return count(r.segments_per_s); })
      .row("step timer, Hz", [](R r) { return count(r.step_timer_hz); })
      .row("timer counts added to a period", [](R r) { return count(r.extra_counts_per_tick); })
      .row("longest period, counts", [](R r) { return count(r.longest_tick_counts); })
      .row("first step after, counts",
           [](R r) { return r.wake_waits_last_period ? std::string{"the period before"} : count(r.wake_counts); })
      .row("step smoothing below, Hz",
           [](R r) {
             return count(r.smoothing_below_hz[0]) + ", " + count(r.smoothing_below_hz[1]) + ", " +
                    count(r.smoothing_below_hz[2]);
           })
      .row("slowest nominal speed, mm/min", [](R r) { return base::to_fixed(r.minimum_rate_mm_per_min, 1); })
      .row("sums run from the last axis", [](R r) { return tick(r.sums_from_last_axis); })
      .row("feed is capped before the override too", [](R r) { return tick(r.override_caps_first); })
      .row("accelerations are converted last", [](R r) { return tick(r.acceleration_converted_last); })
      .row("step counters begin anew after a stop", [](R r) { return tick(r.restart_resets_bresenham); })
      .row("a hold ends at the block's end within, mm", [](R r) { return base::to_fixed(r.hold_snap_mm, 4); })
      .row("a stop waits for `$1`", [](R r) { return tick(r.idle_lock_blocks); })
      .row("0x19 drops prepared segments", [](R r) { return tick(r.cancel_drops_segments); })
      .row("arcs move all other axes along", [](R r) { return tick(r.arc_moves_all_axes); })
      .row("dwell counts in", [](R r) { return milliseconds(r.dwell_step); })
      .row("a dwell is rounded", [](R r) { return std::string{r.dwell_rounds_down ? "down" : "up"}; })
      .text();
}

using P = const Personality&;

std::string behaviour_table() {
  Figures<Personality> figures([](const Personality& personality) -> P { return personality; });
  return figures.row("blank memory: `error:7` before the welcome", [](P p) { return tick(p.start.blank_memory_error); })
      .row("`$22` on: power-up ends in Alarm", [](P p) { return tick(p.start.homing_locks); })
      .row("`ALARM:11` exists", [](P p) { return tick(p.start.has_homing_alarm); })
      .row("`|` separates startup blocks", [](P p) { return tick(p.start.startup_blocks_split); })
      .row("homing search, times the travel", [](P p) { return base::to_fixed(p.homing.search_scalar, 1); })
      .row("homing locate, times the pull-off", [](P p) { return base::to_fixed(p.homing.locate_scalar, 1); })
      .row("`$HX`", [](P p) { return tick(p.homing.homes_single_axes); })
      .row("remembers which axes are homed", [](P p) { return tick(p.homing.tracks_axes); })
      .row("`?` is answered whatever the main loop does", [](P p) { return tick(p.status.at_once); })
      .row("`?` is answered in a critical alarm", [](P p) { return tick(p.status.when_critical); })
      .row("first of the two counted fields", [](P p) { return code(p.status.first_is_overrides ? "Ov:" : "WCO:"); })
      .row("fields come when something changed", [](P p) { return tick(p.status.counts_changes); })
      .row("a full buffer loses realtime bytes", [](P p) { return tick(p.full_buffer_drops_realtime); })
      .row("equal override bytes in one pass count once", [](P p) { return tick(p.realtime.same_instant_collapses); })
      .row("Door substate while resuming", [](P p) { return count(p.realtime.door_resuming_substate); })
      .row("lines are read in Sleep", [](P p) { return tick(p.reads_lines_in_sleep); })
      .row("`$RST=` ends in a reset", [](P p) { return tick(p.restore_resets); })
      .row("offset writes wait for the motion", [](P p) { return tick(p.stored_writes_synchronise); })
      .row("soft limits act in Check", [](P p) { return tick(p.soft_limits_in_check); })
      .row("`G4P0` does not wait for the motion", [](P p) { return tick(p.skips_empty_dwell); })
      .row("laser mode in the reference build", [](P p) { return tick(p.has_laser_spindle); })
      .text();
}

}  // namespace

std::vector<Page> figure_pages() {
  return {{.name = "figures.md",
           .text = page_head("Figures and policies", "Of the reference builds; what a controller says wins.") +
                   "## Who it is\n\n" + identity_table() + "\n## Lines\n\n" + lines_table() +
                   "\n## Reports and settings\n\n" + report_table() + "\n## Behaviour\n\n" + behaviour_table() +
                   "\n## Motion\n\n" + motion_table()}};
}

}  // namespace kerf::tools
