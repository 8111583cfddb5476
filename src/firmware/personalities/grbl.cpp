// Grbl 1.1h as its reference build behaves (gnea/grbl; protocol.md).

#include "common/vocabulary/dialects/grbl.hpp"

#include "firmware/personalities/personalities.hpp"
#include "firmware/settings_store.hpp"
#include "firmware/system_commands.hpp"

namespace kerf::firmware {

namespace {

constexpr StateSet kNotInCycle = {MachineState::Idle,  MachineState::Jog,  MachineState::Home,  MachineState::Alarm,
                                  MachineState::Check, MachineState::Door, MachineState::Sleep, MachineState::Tool};

// Names with `=` take a value.
constexpr CommandRow kCommands[] = {
    {.name = "$", .command = Command::ListSettings, .states = kNotInCycle},
    {.name = "G", .command = Command::ParserState},
    {.name = "C", .command = Command::CheckMode, .states = {MachineState::Idle, MachineState::Check}},
    {.name = "X", .command = Command::Unlock},
    {.name = "#", .command = Command::Parameters},
    {.name = "SLP", .command = Command::Sleep},
    {.name = "I", .command = Command::BuildInformation},
    {.name = "I=", .command = Command::StoreUserText},
    {.name = "RST=", .command = Command::Restore},
};

}  // namespace

const Personality kGrbl = {
    .speaks = &vocabulary::dialects::kGrbl,
    .firmware = vocabulary::Firmware::Grbl,
    .most = {.slow_memory = true},
    .start = {.blank_memory_error = true,
              .blank_memory_lists_settings = true,
              .homing_locks = true,
              .limits_lock = true,
              .runs_lines_it_cannot_store = true},
    .homing = {.fixed_cycles = {0b100, 0b011}, .homes_single_axes = false, .switch_sees_pulses = true},
    .realtime = {.same_instant_collapses = true,
                 .reads_while_slowing = true,
                 .toggles_coolant_in_jog = true,
                 .hold_keeps_probe_contact = true},
    .stored_writes_synchronise = true,
    .soft_limits_in_check = true,
    .has_laser_spindle = true,
    .loop = {.pass = std::chrono::microseconds{10},
             .to_start = 1,
             .idle_to_start = 1,
             .resume_to_start = 1,
             .jog_to_start = 1,
             .homing_to_start = 1,
             .switch_to_stop = 1,
             .restore_delays_take_passes = true},
    .memory_byte_time = std::chrono::microseconds{3400},  // ATmega328P, erase and write
    .parse_command = parse_command_grbl,
    .check_setting = check_setting_grbl,
    .commands = kCommands,
    .help = "$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x",
};

}  // namespace kerf::firmware
