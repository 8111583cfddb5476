// Rabbit GRBL 1.6.0 (SourceRabbit/RabbitGRBL; protocol.md).

#include "firmware/personalities/personalities.hpp"
#include "firmware/settings_store.hpp"
#include "firmware/system_commands.hpp"

namespace kerf::firmware {

namespace {

constexpr StateSet kIdleOrAlarm = {MachineState::Idle, MachineState::Alarm};
constexpr StateSet kNotInCycle = {MachineState::Idle,  MachineState::Jog,  MachineState::Home,  MachineState::Alarm,
                                  MachineState::Check, MachineState::Door, MachineState::Sleep, MachineState::Tool};

constexpr CommandRow kCommands[] = {
    {.name = "$", .command = Command::ListSettings, .states = kNotInCycle},
    {.name = "+", .command = Command::ListNamedSettings, .states = kNotInCycle},
    {.name = "G", .command = Command::ParserState},
    {.name = "#", .command = Command::Parameters, .states = kIdleOrAlarm},
    {.name = "C", .command = Command::CheckMode, .states = {MachineState::Idle, MachineState::Check}},
    {.name = "X", .command = Command::Unlock},
    {.name = "H", .command = Command::Home, .states = kIdleOrAlarm},
    {.name = "HX", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "X"},
    {.name = "HY", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "Y"},
    {.name = "HZ", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "Z"},
    {.name = "HA", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "A"},
    {.name = "HB", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "B"},
    {.name = "HC", .command = Command::Home, .states = kIdleOrAlarm, .prefix = "C"},
    {.name = "J",
     .command = Command::Jog,
     .states = {MachineState::Idle, MachineState::Jog},
     .takes_value = true,
     .needs_value = true},
    {.name = "I", .command = Command::BuildInformation, .states = kIdleOrAlarm},
    {.name = "N", .command = Command::ListStartupLines, .states = kIdleOrAlarm},
    {.name = "N0",
     .command = Command::StoreStartupLine,
     .states = {MachineState::Idle},
     .prefix = "0",
     .takes_value = true,
     .needs_value = true},
    {.name = "N1",
     .command = Command::StoreStartupLine,
     .states = {MachineState::Idle},
     .prefix = "1",
     .takes_value = true,
     .needs_value = true},
    {.name = "SLP", .command = Command::Sleep, .states = kIdleOrAlarm},
    {.name = "RST", .command = Command::Restore, .states = kIdleOrAlarm, .takes_value = true, .needs_value = true},
    {.name = "EA", .command = Command::ListAlarms, .takes_value = true},
    {.name = "EE", .command = Command::ListErrors, .takes_value = true},
    {.name = "E", .command = Command::ListErrors, .takes_value = true},
    {.name = "A", .command = Command::ListAlarms, .takes_value = true},
    {.name = "S", .command = Command::ListNamedSettings, .states = kNotInCycle},
    {.name = "SC", .command = Command::ListChangedSettings, .states = kNotInCycle},
    {.name = "L", .command = Command::ListSettingNames, .states = kNotInCycle},
    {.name = "CMD", .command = Command::ListCommands, .states = kNotInCycle},
};

}  // namespace

const Personality kRabbit = {
    .firmware = vocabulary::Firmware::Rabbit,
    .start = {.homing_locks = true, .limits_lock = true},
    .homing = {.fixed_cycles = {},
               .cycle_setting = 50,
               .cycle_settings = 6,
               .search_scalar = 1.1F,
               .travel = TravelRule::MirroredByDirection,
               .no_cycle_error = ErrorCode::HomingNotDefined},
    .status = {.at_once = true, .when_critical = true},
    .realtime = {.toggles_coolant_in_jog = true},
    .full_buffer_drops_realtime = true,
    .version_has_user_text = false,
    .check_mode_is_silent = true,
    .restore_resets = false,
    .restores_network = true,
    .parameters_pause = true,
    .stored_writes_synchronise = true,
    .soft_limits_in_check = true,
    .skips_empty_dwell = true,
    .loop = {.pass = std::chrono::microseconds{8}, .to_start = 1},
    .parse_command = parse_command_rabbit,
    .check_setting = check_setting_rabbit,
    .commands = kCommands,
    .help = "$$ $+ $# $S $L $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H $EA $EE ~ ! ? ctrl-x",
};

}  // namespace kerf::firmware
