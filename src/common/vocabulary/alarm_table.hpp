#pragma once
// Every alarm of every firmware, in our own words (protocol.md 8).

#include <array>

#include "common/vocabulary/alarms.hpp"

namespace kerf::vocabulary::tables {

inline constexpr std::array kAlarmRows{
    CodeRow{
        1, "Hard limit reached",
        "A limit switch was hit and the machine stopped dead, so its position is probably wrong. Reset, unlock, move "
        "off the switch with care and home again.",
        FirmwareSet::All, true},
    CodeRow{
        2, "Soft limit: the target lies outside the travel",
        "The program asked for a place that the machine cannot reach. Position is kept. Reset and unlock, then check "
        "the work zero and the size of the program.",
        FirmwareSet::All, true},
    CodeRow{3, "Reset while moving",
            "The motors were stopped without braking and may have lost steps. Unlock and home before going on.",
            FirmwareSet::All},
    CodeRow{
        4, "Probe in the wrong state before probing",
        "The probe was already touching before a cycle towards the work, or open before a cycle away from it. Check "
        "the wiring and the start position.",
        FirmwareSet::All},
    CodeRow{5, "Probe made no contact",
            "The probe did not change state within the programmed distance. Start closer, or probe further.",
            FirmwareSet::All},
    CodeRow{6, "Homing was reset", "A reset ended the homing cycle. Position is unknown: home again.",
            FirmwareSet::All},
    CodeRow{7, "Door opened while homing", "Close the safety door and home again.", FirmwareSet::All},
    CodeRow{8, "Switch still pressed after pull-off",
            "Backing off did not free the limit switch. Raise the pull-off distance in $27, or check the wiring.",
            FirmwareSet::All},
    CodeRow{
        9, "Limit switch not found",
        "No switch was met within the search distance. Check the maximum travel in $130 and up, the homing direction "
        "in $23 and the wiring.",
        FirmwareSet::All},
    CodeRow{
        10, "Second switch of a dual axis not found",
        "One side of the ganged axis reached its switch and the other did not. Check both switches and the squareness.",
        FirmwareSet::Grbl | FirmwareSet::Rabbit},
    CodeRow{10, "E-stop", "The emergency stop is pressed. Make the machine safe, release it, then reset.",
            FirmwareSet::GrblHal, true},
    CodeRow{11, "Homing required", "The controller is set up to be homed before use. Send $H.", FirmwareSet::GrblHal},
    CodeRow{12, "Limit switch engaged at start", "Free the switch, then unlock or home.", FirmwareSet::GrblHal},
    CodeRow{13, "Probe protection", "The probe was touched outside of a probing cycle. Free it before going on.",
            FirmwareSet::GrblHal},
    CodeRow{14, "Spindle did not reach its speed",
            "The spindle was not at speed in time. Check the drive, the tolerance in $340 and the delay in $394.",
            FirmwareSet::GrblHal},
    CodeRow{15, "Second switch of a squared axis not found",
            "One side of the auto-squared axis reached its switch and the other did not. Check both switches.",
            FirmwareSet::GrblHal},
    CodeRow{16, "Self-test failed", "The start-up self-test found a fault. Power off and on, then check the hardware.",
            FirmwareSet::GrblHal},
    CodeRow{17, "Motor fault", "A motor driver reports a fault. Find the cause, then reset.", FirmwareSet::GrblHal,
            true},
    CodeRow{18, "Homing set-up is wrong",
            "The homing settings contradict each other. Check $22, $44 to $49 and the switches.", FirmwareSet::GrblHal},
    CodeRow{19, "Modbus failure",
            "A device on the Modbus did not answer in time or sent nonsense. Check cable and address.",
            FirmwareSet::GrblHal},
    CodeRow{20, "I/O expander failure", "The board lost its I/O expander. Check the connection, then reset.",
            FirmwareSet::GrblHal, true},
    CodeRow{21, "Settings memory failure", "The settings memory cannot be read or written. Settings may be defaults.",
            FirmwareSet::GrblHal},
    CodeRow{22, "Buffer overflow",
            "More bytes came than the controller could take, so lines were lost. Start the job again.",
            FirmwareSet::GrblHal},
};

}  // namespace kerf::vocabulary::tables
