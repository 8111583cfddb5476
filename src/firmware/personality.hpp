#pragma once
// What one firmware does differently from another, as rows and named policies: everything the virtual controller asks
// about itself. What both ends of the wire must know stands in vocabulary::Dialect.

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/time.hpp"
#include "common/gcode/interpreter.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/errors.hpp"
#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "common/vocabulary/travel.hpp"
#include "firmware/hardware.hpp"

namespace kerf::firmware {

using vocabulary::ErrorCode;
using vocabulary::MachineState;
using vocabulary::TravelRule;

/// Set of machine states, for "allowed in" columns.
class StateSet {
 public:
  constexpr StateSet() = default;
  constexpr StateSet(std::initializer_list<MachineState> states) {
    for (const MachineState state : states) bits_ |= 1U << static_cast<unsigned>(state);
  }
  [[nodiscard]] constexpr bool contains(MachineState state) const {
    return ((bits_ >> static_cast<unsigned>(state)) & 1U) != 0;
  }
  [[nodiscard]] static constexpr StateSet any() {
    StateSet all;
    all.bits_ = ~0U;
    return all;
  }

 private:
  unsigned bits_ = 0;
};

/// What a `$` line asks for.
enum class Command : std::uint8_t {
  Help,
  ListSettings,
  DescribeSetting,
  ReadSetting,
  WriteSetting,
  ParserState,
  Parameters,
  CheckMode,
  Unlock,
  Home,
  Jog,
  BuildInformation,
  ExtendedBuildInformation,
  StoreUserText,
  ListStartupLines,
  StoreStartupLine,
  Restore,
  Sleep,
  ListAlarms,
  ListErrors,
  ListSettingGroups,
  ListSettingDefinitions,
  ListAlarmsAsCsv,
  ListErrorsAsCsv,
  ListSettingsAsCsv,
  ListSettingsAsTabs,
  ListEverything,
  SettingDescription,
  BlockDelete,
  SingleBlock,
  OptionalStop,
  SetToolReference,
  ProbeToolPlate,
  ReportLimits,
  ReportHomeSwitches,
  ReportLastEvents,
  ReportNothing,
  NotAvailable,
  ListSpindles,
  ListSpindlesForMachines,
  HelpTopics,
  ListChangedSettings,
  ListNamedSettings,
  ListSettingNames,
  ListCommands,
  ReadStartupLine,
  ListState,
  ReleaseMotors,
  EraseMemory,
  MemoryUse,
};

/// One `$` command of a firmware.
struct CommandRow {
  std::string_view name;  ///< in capitals, without `$`
  Command command{};
  StateSet states = StateSet::any();  ///< in any other state the answer is error:8
  /// Given in front of whatever follows `=`: the axis of `$HX`, the number of `$N0`.
  std::string_view prefix{};
  bool takes_value = false;      ///< `$I=text`
  bool ignores_value = false;    ///< `$G=1` is `$G`
  bool needs_value = false;      ///< without `=` it is error:3
  bool works_critically = true;  ///< grblHAL: also while only a reset helps; otherwise error:79
  std::string_view long_name{};  ///< Rabbit: "GCode/Modes"
};

/// A `$` line, understood.
struct ParsedCommand {
  Command command{};
  StateSet states = StateSet::any();
  /// Setting id, axis letter or line number, as far as the command has one.
  std::string key{};
  /// What follows `=`; empty without it.
  std::string value{};
  bool has_value = false;

  friend bool operator==(const ParsedCommand& left, const ParsedCommand& right) {
    return left.command == right.command && left.key == right.key && left.value == right.value &&
           left.has_value == right.has_value;
  }
};

struct Personality;
class SettingsStore;

/// Reads a `$` line (without the `$`) as one firmware does; its order of checks decides which error is answered.
using CommandParser = std::expected<ParsedCommand, ErrorCode> (*)(const Personality&, std::string_view line,
                                                                  MachineState state, bool critical);
/// The value that `text` gives to a setting, as one firmware checks it.
using SettingCheck = std::expected<std::string, ErrorCode> (*)(const SettingsStore&, const vocabulary::SettingMatch&,
                                                               std::string_view text);

/// How homing goes, and what the machine remembers of it.
struct HomingRules {
  /// Axis masks of the cycles in order, where they are compiled in; zeros are skipped.
  std::array<std::uint8_t, 6> fixed_cycles{};
  /// First of the consecutive settings that hold the masks; 0 where they are compiled in.
  int cycle_setting = 0;
  int cycle_settings = 0;
  /// Setting with the number of locate passes; 0 where it is 1.
  int passes_setting = 0;
  float search_scalar = 1.5F;      ///< times the longest travel
  float locate_scalar = 5.0F;      ///< times the pull-off
  float endless_search_mm = 0.0F;  ///< as far as a lone axis without travel goes (Rabbit)
  bool cuts_position = false;      ///< the homed position is cut to whole steps, not rounded (Rabbit)
  /// Says `<Home...>` and waits 100 ms before it moves, and `[MSG:]` when done.
  bool announces = false;
  /// Counts which axes are homed; soft limits then only hold for those.
  bool tracks_axes = false;
  TravelRule travel = TravelRule::NegativeSpace;
  /// `$HX` exists.
  bool homes_single_axes = true;
  /// How long the loop stands still when a move of the cycle has come to its planned end (grblHAL).
  Duration end_pause{};
  /// A step is pulsed one interrupt after it was decided, so a switch closes that much later.
  bool switch_sees_pulses = false;
  /// Answer to `$H` when no cycle has an axis.
  ErrorCode no_cycle_error = ErrorCode::HomingDisabled;
};

/// What happens when power comes or a reset has cleared everything.
struct StartRules {
  bool blank_memory_error = false;           ///< error:7 before the welcome
  bool blank_memory_lists_settings = false;  ///< then all settings (gnea/grbl settings.c)
  bool homing_locks = false;                 ///< `$22` on: power-up ends in Alarm (gnea/grbl main.c)
  bool has_homing_alarm = false;             ///< `$22` bit 2: ALARM:11
  bool limits_lock = false;                  ///< an active limit input with `$21` on ends in Alarm
  bool same_alarm_is_silent = false;         ///< an alarm that is in force already is not printed again
  bool startup_blocks_split = false;         ///< `|` separates blocks in one startup line
  bool has_reset_actions = false;            ///< `$676`
  /// `$N7=` carries its block out and says ok, though it is kept nowhere (gnea/grbl system.c).
  bool runs_lines_it_cannot_store = false;
};

/// A setting of old that only writes one bit of another one, if that one's first bit is set.
struct ObsoleteSetting {
  std::string_view key{};
  int writes = 0;
  unsigned bit = 0;
};

/// How status reports come about.
struct StatusRules {
  bool at_once = false;  ///< Rabbit answers from its receive task, whatever the main loop does
  bool when_critical = false;
  bool first_is_overrides = false;    ///< grblHAL: `Ov` is due before `WCO`; Grbl the other way round
  bool counts_changes = false;        ///< grblHAL: fields come when something changed
  bool coolant_on_is_untold = false;  ///< Rabbit: M7 and M8 make no report due, M9 always does
  bool accessories_alone = false;     ///< `A:` also without `Ov:`, and empty when all is off
};

/// What realtime bytes do.
struct RealtimeRules {
  bool same_instant_collapses = false;  ///< Grbl: two of the same override byte between two passes count once
  bool mist_toggle = false;
  bool reads_while_slowing = false;  ///< a hold suspends the main loop only when the machine stands
  bool toggles_coolant_in_jog = false;
  bool resume_says_nothing_said = false;  ///< grblHAL: an empty `[MSG:]` when a hold ends and `$63` bit 1 is set
  int door_resuming_substate = 3;
  /// Settings with the waits for spindle and coolant before a door or hold ends; where they are missing 4 s and 1 s.
  int door_spindle_setting = 392;
  int door_coolant_setting = 393;
  /// Rabbit: after a door mist and flood both come on if one was; the wait between them.
  int door_mist_setting = 0;
  bool door_again_ignored = false;  ///< 0x84 while in Door already
  /// A hold stays one if the probe touches while it slows down, and `~` drops the rest; grblHAL does not see the touch.
  bool hold_keeps_probe_contact = false;
};

/// Where the tool goes while the safety door is open, where that is compiled in (SourceRabbit/RabbitGRBL Config.h):
/// along Z, with homing enabled.
struct FixedParking {
  float target_mm = 0;
  float rate_mm_per_min = 0;
  float pull_out_mm = 0;
  float pull_out_rate_mm_per_min = 0;
};

/// How long the main loop keeps queued motion waiting while the machine rests, as in the recordings of real firmware
/// (motion.md 2). Answers do not show it: in them it is less than a byte on the wire.
struct LoopTimes {
  /// One pass of the main loop: everything below is a number of these.
  Duration pass{};
  int for_line = 0;
  int for_block = 0;
  int to_start = 0;
  /// More of them if the loop had nothing else to do when the motion was queued.
  int idle_to_start = 0;
  /// Until the steppers wake after `~` in a hold, for a jog, and for a move of the homing cycle; 0: at once.
  int resume_to_start = 0;
  int jog_to_start = 0;
  int homing_to_start = 0;
  /// From the pass that sees the last switch close to the end of the move.
  int switch_to_stop = 0;
  /// Each step of a delay before a resume costs one more pass.
  bool restore_delays_take_passes = false;
};

/// One firmware's ways. The function pointers are named policies; everything else is a value.
struct Personality {
  /// What both ends of the wire know of this build.
  const vocabulary::Dialect* speaks = nullptr;
  vocabulary::Firmware firmware{};
  Hardware hardware{};
  /// The most that a build of this firmware can have; axes are those of the dialect.
  Hardware most{};

  StartRules start{};
  HomingRules homing{};
  StatusRules status{};
  RealtimeRules realtime{};

  bool full_buffer_drops_realtime = false;  ///< Rabbit
  bool has_plugins = false;                 ///< grblHAL: a card slot and a pendant may be fitted
  bool network_waits_for_room = false;      ///< grblHAL: TCP takes no more than fits, realtime bytes wait behind data
  bool drops_delete = false;                ///< grblHAL: DEL outside `$` lines never reaches the line
  bool keeps_special_bytes = false;         ///< grblHAL: `$` lines and comments may keep DEL, top-bit bytes and `?!~`
  /// grblHAL's settings beyond Grbl's, and what hangs on them: jog clipping, door and tool change options, reset
  /// actions.
  bool has_extended_settings = false;
  /// Rabbit: settings and commands have names, a part of a name lists what it is part of, `[X/MaxRate]500` is
  /// `$X/MaxRate=500`, and axes that the board lacks have settings.
  bool names_settings = false;
  /// Rabbit waits after it has switched the spindle (`$37`, `$38`) or a coolant on (`$60`, `$61`).
  bool waits_after_switching = false;
  bool takes_up_backlash = false;  ///< Rabbit: `$180` on
  std::optional<FixedParking> fixed_parking{};
  /// `$22`=0 takes `$20` back.
  bool soft_limits_need_homing = true;
  bool tells_build_at_length = false;    ///< `$I` says as much as `$I+`
  bool options_follow_settings = false;  ///< the letters of `[OPT:]`
  bool version_has_user_text = true;
  bool codes_have_titles = true;  ///< `$EA`, `$EE`: else the title stays empty
  ErrorCode unknown_setting_error = ErrorCode::InvalidStatement;
  ObsoleteSetting obsolete_setting{};
  bool reads_lines_in_sleep = false;
  bool sleep_needs_setting = false;  ///< grblHAL `$62`
  /// grblHAL: M2 and M30 that wait for the motion say `[MSG:Pgm End]` even if a reset or 0x19 ends the wait.
  bool interrupted_program_ends = false;
  bool check_mode_is_silent = false;
  bool restore_resets = true;  ///< `$RST=` ends in a reset
  bool restores_network = false;
  bool tool_length_stays_metric = false;  ///< `[TLO:]` in spite of `$13`
  bool blocks_may_jog = false;            ///< grblHAL: `/$J=X1F100` jogs, and so does a startup line
  bool tells_parameters = false;          ///< grblHAL: `$#=5`, `$#=_x`
  bool parameters_pause = false;          ///< Rabbit waits 100 ms before the ok of `$#`
  bool stored_writes_synchronise = false;
  bool checks_whole_arcs = false;         ///< an arc whose end lies outside the travel does not even begin
  bool has_work_offset_sync_bit = false;  ///< `$10` bit 8; otherwise every change of WCO waits for the motion
  bool soft_limits_in_check = false;
  bool probe_begins_at_target = false;  ///< [PRB:] has the target of a probe motion until the probe says more
  bool skips_empty_dwell = false;       ///< a dwell of no time does not even wait for the motion
  /// The board's spindle takes its power from the step interrupt, so `$32`=1 is laser mode; else S changes wait for the
  /// motion all the same (motion.md 1.5).
  bool has_laser_spindle = false;
  LoopTimes loop{};
  /// What one byte of memory takes on a board whose writes stall everything; zero elsewhere.
  Duration memory_byte_time{};

  CommandParser parse_command{};
  SettingCheck check_setting{};
  std::span<const CommandRow> commands{};
  std::string_view help{};
  /// `$I` rows behind NEWOPT: key and value.
  std::span<const std::array<std::string_view, 2>> build_rows{};

  [[nodiscard]] const vocabulary::Dialect& dialect() const { return *speaks; }
  /// What people call it on a command line: "grblhal-expr".
  [[nodiscard]] std::string_view key() const { return speaks->key; }
};

/// The personality of a firmware; Grbl 1.1h for an unknown one.
[[nodiscard]] const Personality& personality_of(vocabulary::Firmware firmware);

/// The same firmware on other hardware, as far as it can have it; zeros leave a count as it is.
[[nodiscard]] Personality built_with(const Personality& personality, const Hardware& hardware);

/// The first of `wanted` that no build of this firmware has.
[[nodiscard]] std::optional<HardwareFault> fault_in(const Hardware& wanted, const Personality& personality);

/// The personality whose key is `name`, in any case; null if there is none.
[[nodiscard]] const Personality* personality_named(std::string_view name);

/// The usual build of each firmware, in the order of vocabulary::Firmware.
[[nodiscard]] std::span<const Personality* const> all_personalities();
/// The keys of all builds as a sentence lists them: "grbl, rabbit, grblhal or grblhal-expr".
[[nodiscard]] std::string personality_names();
/// The same for those that can be built with `wanted`; empty if there are none.
[[nodiscard]] std::string personality_names_for(const Hardware& wanted);

}  // namespace kerf::firmware
