// grblHAL at compatibility level 0, as its simulator build behaves (grblHAL/core; protocol.md).

#include "common/vocabulary/dialects/grblhal.hpp"

#include "firmware/personalities/personalities.hpp"
#include "firmware/settings_store.hpp"
#include "firmware/system_commands.hpp"

namespace kerf::firmware {

namespace {

constexpr StateSet kIdleOrAlarm = {MachineState::Idle, MachineState::Alarm};
constexpr StateSet kSettled = {MachineState::Idle, MachineState::Alarm, MachineState::Check};
constexpr StateSet kInformed = {MachineState::Idle, MachineState::Alarm, MachineState::Check, MachineState::Sleep};

constexpr CommandRow kCommands[] = {
    {.name = "G", .command = Command::ParserState},
    {.name = "J",
     .command = Command::Jog,
     .states = {MachineState::Idle, MachineState::Jog, MachineState::Tool},
     .takes_value = true,
     .needs_value = true,
     .works_critically = false},
    {.name = "#", .command = Command::Parameters, .takes_value = true},
    {.name = "$", .command = Command::DescribeSetting, .takes_value = true},
    {.name = "+", .command = Command::DescribeSetting, .takes_value = true},
    {.name = "SED", .command = Command::SettingDescription, .takes_value = true},
    {.name = "B", .command = Command::BlockDelete, .works_critically = false},
    {.name = "S", .command = Command::SingleBlock, .works_critically = false},
    {.name = "O", .command = Command::OptionalStop, .works_critically = false},
    {.name = "C",
     .command = Command::CheckMode,
     .states = {MachineState::Idle, MachineState::Check},
     .works_critically = false},
    {.name = "X", .command = Command::Unlock, .takes_value = true, .works_critically = false},
    {.name = "H", .command = Command::Home, .states = kIdleOrAlarm, .takes_value = true, .works_critically = false},
    {.name = "HX", .command = Command::Home, .prefix = "X", .takes_value = true, .works_critically = false},
    {.name = "HY", .command = Command::Home, .prefix = "Y", .takes_value = true, .works_critically = false},
    {.name = "HZ", .command = Command::Home, .prefix = "Z", .takes_value = true, .works_critically = false},
    {.name = "HA", .command = Command::Home, .prefix = "A", .takes_value = true, .works_critically = false},
    {.name = "HB", .command = Command::Home, .prefix = "B", .takes_value = true, .works_critically = false},
    {.name = "HC", .command = Command::Home, .prefix = "C", .takes_value = true, .works_critically = false},
    {.name = "HU", .command = Command::Home, .prefix = "U", .takes_value = true, .works_critically = false},
    {.name = "HV", .command = Command::Home, .prefix = "V", .takes_value = true, .works_critically = false},
    {.name = "HSS", .command = Command::ReportHomeSwitches},
    {.name = "SPINDLES", .command = Command::ListSpindles},
    {.name = "SPINDLESH", .command = Command::ListSpindlesForMachines},
    {.name = "SLP", .command = Command::Sleep, .works_critically = false},
    {.name = "TLR", .command = Command::SetToolReference, .works_critically = false},
    {.name = "TPW", .command = Command::ProbeToolPlate, .works_critically = false},
    {.name = "I", .command = Command::BuildInformation, .states = kInformed, .takes_value = true},
    {.name = "I+", .command = Command::ExtendedBuildInformation},
    {.name = "RST", .command = Command::Restore, .states = kIdleOrAlarm, .takes_value = true, .needs_value = true},
    {.name = "N", .command = Command::ListStartupLines, .states = kSettled},
    {.name = "N0",
     .command = Command::StoreStartupLine,
     .prefix = "0",
     .takes_value = true,
     .needs_value = true,
     .works_critically = false},
    {.name = "N1",
     .command = Command::StoreStartupLine,
     .prefix = "1",
     .takes_value = true,
     .needs_value = true,
     .works_critically = false},
    {.name = "EA", .command = Command::ListAlarms},
    {.name = "EE", .command = Command::ListErrors},
    {.name = "EAG", .command = Command::ListAlarmsAsCsv},
    {.name = "EEG", .command = Command::ListErrorsAsCsv},
    {.name = "EG", .command = Command::ListSettingGroups},
    {.name = "ES", .command = Command::ListSettingDefinitions},
    {.name = "ESG", .command = Command::ListSettingsAsCsv},
    {.name = "ESH", .command = Command::ListSettingsAsTabs},
    {.name = "E*", .command = Command::ListEverything},
    {.name = "PINS", .command = Command::ReportNothing},
    {.name = "PINSTATE", .command = Command::ReportNothing},
    {.name = "PORTS", .command = Command::ReportNothing},
    {.name = "DWNGRD", .command = Command::ReportNothing},
    {.name = "SD", .command = Command::NotAvailable, .takes_value = true},
    {.name = "SR", .command = Command::NotAvailable, .takes_value = true},
    {.name = "RTC", .command = Command::NotAvailable, .takes_value = true},
    {.name = "SDS", .command = Command::NotAvailable},
    {.name = "REBOOT", .command = Command::NotAvailable},
    {.name = "LEV", .command = Command::ReportLastEvents},
    {.name = "LIM", .command = Command::ReportLimits},
};

constexpr std::array<std::string_view, 2> kBuildRows[] = {
    {"SIGNALS", "D"},
    {"NVS STORAGE", "*EEPROM"},
    {"DRIVER", "Kerf"},
    {"DRIVER VERSION", "1"},
};

}  // namespace

constexpr Personality kUsual = {
    .speaks = &vocabulary::dialects::kGrblHal,
    .firmware = vocabulary::Firmware::GrblHal,
    .most = {.tools = 32,  // grblHAL/core config.h N_TOOLS
             .ports = {.digital_inputs = 16, .digital_outputs = 16, .analog_inputs = 16, .analog_outputs = 16},
             .spindle_encoder = true},
    .start = {.blank_memory_error = true,
              .has_homing_alarm = true,
              .same_alarm_is_silent = true,
              .startup_blocks_split = true,
              .has_reset_actions = true},
    .homing = {.fixed_cycles = {},
               .cycle_setting = 44,
               .cycle_settings = 6,
               .passes_setting = 43,
               .locate_scalar = 10.0F,
               .announces = true,
               .tracks_axes = true,
               .travel = TravelRule::HomedEnvelope,
               .end_pause = std::chrono::milliseconds{2},
               .switch_sees_pulses = true},
    .status = {.when_critical = true, .first_is_overrides = true, .counts_changes = true, .accessories_alone = true},
    .realtime = {.mist_toggle = true,
                 .resume_says_nothing_said = true,
                 .door_resuming_substate = 4,
                 .door_again_ignored = true},
    .has_plugins = true,
    .network_waits_for_room = true,
    .drops_delete = true,
    .keeps_special_bytes = true,
    .has_extended_settings = true,
    .tells_build_at_length = true,
    .options_follow_settings = true,
    .codes_have_titles = false,
    .unknown_setting_error = ErrorCode::SettingDisabled,
    .obsolete_setting = {.key = "7", .writes = 9, .bit = 1},
    .reads_lines_in_sleep = true,
    .sleep_needs_setting = true,
    .interrupted_program_ends = true,
    .blocks_may_jog = true,
    .tells_parameters = true,
    .checks_whole_arcs = true,
    .has_work_offset_sync_bit = true,
    .probe_begins_at_target = true,
    .loop = {.pass = std::chrono::microseconds{10},
             .for_line = 1,
             .for_block = 2,
             .to_start = 1,
             .jog_to_start = 3,
             .switch_to_stop = 1},
    .parse_command = parse_command_grblhal,
    .check_setting = check_setting_grblhal,
    .commands = kCommands,
    .help = "$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H $B ~ ! ? ctrl-x",
    .build_rows = kBuildRows,
};

const Personality kGrblHal = kUsual;

const Personality kGrblHalExpressions = [] {
  Personality personality = kUsual;
  personality.speaks = &vocabulary::dialects::kGrblHalExpressions;
  return personality;
}();

}  // namespace kerf::firmware
