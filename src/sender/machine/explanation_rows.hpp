#pragma once
// What is safe to do after each alarm, in order, and how far the position may be trusted. Errors leave the machine as
// it was, so they share a few rows.

#include <array>
#include <string_view>

#include "common/vocabulary/firmware.hpp"
#include "sender/machine/explanation.hpp"

namespace kerf::machine {

struct AlarmAdvice {
  int code = 0;
  vocabulary::FirmwareSet known_to{};
  PositionTrust position = PositionTrust::Kept;
  std::array<std::string_view, 4> steps{};
};

namespace advice {

inline constexpr auto kAll = vocabulary::FirmwareSet::All;
inline constexpr auto kHal = vocabulary::FirmwareSet::GrblHal;
inline constexpr auto kGrblAndRabbit = vocabulary::FirmwareSet::Grbl | vocabulary::FirmwareSet::Rabbit;

inline constexpr std::string_view kReset = "Reset the controller (Ctrl-X); nothing moves.";
inline constexpr std::string_view kUnlock = "Unlock with $X.";
inline constexpr std::string_view kHome = "Home with $H before you rely on any position.";

inline constexpr std::array kAlarmAdvice{
    AlarmAdvice{1,
                kAll,
                PositionTrust::Unknown,
                {"Look what hit the switch, and switch the spindle off.", "Reset (Ctrl-X), then unlock with $X.",
                 "Jog slowly away from the switch.", kHome}},
    AlarmAdvice{2,
                kAll,
                PositionTrust::Kept,
                {"Reset (Ctrl-X), then unlock with $X: the position is kept.",
                 "Check work zero, tool length and the size of the program.",
                 "Raise the tool, then start again from a line before this one."}},
    AlarmAdvice{3, kAll, PositionTrust::Suspect, {"Unlock with $X.", "Raise the tool with a slow jog.", kHome}},
    AlarmAdvice{4,
                kAll,
                PositionTrust::Kept,
                {"Look at the probe and its cable; status shows whether it touches.", kUnlock,
                 "Bring the probe into the state that the cycle expects, then probe again."}},
    AlarmAdvice{5,
                kAll,
                PositionTrust::Kept,
                {kUnlock, "Check that the clip or the plate is connected: touch it by hand and watch the probe input.",
                 "Start closer to the surface, or probe further."}},
    AlarmAdvice{6, kAll, PositionTrust::Unknown, {"Home again with $H."}},
    AlarmAdvice{7, kAll, PositionTrust::Unknown, {"Close the safety door.", "Home again with $H."}},
    AlarmAdvice{
        8,
        kAll,
        PositionTrust::Unknown,
        {"Look whether the switch is stuck.", "Raise the pull-off distance $27 a little.", "Home again with $H."}},
    AlarmAdvice{9,
                kAll,
                PositionTrust::Unknown,
                {"Press each switch by hand and watch the inputs.",
                 "Check the search distance ($130 and up), the homing direction ($23) and the search rate ($25).",
                 "Home again with $H."}},
    AlarmAdvice{10,
                kGrblAndRabbit,
                PositionTrust::Unknown,
                {"Check both switches of the ganged axis and whether the gantry is square.", "Home again with $H."}},
    AlarmAdvice{
        10, kHal, PositionTrust::Unknown, {"Make the machine safe, then release the E-stop.", kReset, kUnlock, kHome}},
    AlarmAdvice{11, kHal, PositionTrust::Unknown, {"See that the way to the switches is free.", "Home with $H."}},
    AlarmAdvice{12, kHal, PositionTrust::Kept, {"Move the axis off the switch by hand, or let $H do it.", kUnlock}},
    AlarmAdvice{13, kHal, PositionTrust::Kept, {"Free the probe by hand or with a slow jog away.", kUnlock}},
    AlarmAdvice{14,
                kHal,
                PositionTrust::Kept,
                {"Check the spindle drive: does it turn, and at what speed?", kUnlock,
                 "Allow more time ($394) or tolerance ($340) if the drive is only slow."}},
    AlarmAdvice{15, kHal, PositionTrust::Unknown, {"Check both switches of the squared axis.", "Home again with $H."}},
    AlarmAdvice{16, kHal, PositionTrust::Unknown, {"Power the controller off and on, then check the hardware."}},
    AlarmAdvice{17,
                kHal,
                PositionTrust::Unknown,
                {"Find out which motor driver reports the fault and why (heat, a blocked axis, a cable).", kReset,
                 kUnlock, kHome}},
    AlarmAdvice{
        18,
        kHal,
        PositionTrust::Unknown,
        {"Compare the homing settings $22 and $44 to $49 with the switches that exist.", "Home again with $H."}},
    AlarmAdvice{19,
                kHal,
                PositionTrust::Kept,
                {"Check cable, address and power of the Modbus device (often the spindle drive).", kUnlock}},
    AlarmAdvice{20, kHal, PositionTrust::Suspect, {"Check the board's I/O expander.", kReset, kUnlock}},
    AlarmAdvice{21,
                kHal,
                PositionTrust::Kept,
                {"Read all settings and compare them with a saved set before you move.", kUnlock}},
    AlarmAdvice{22, kHal, PositionTrust::Kept, {kUnlock, "Raise the tool, then start the job again."}},
};

/// For alarms that nobody knows.
inline constexpr AlarmAdvice kUnknownAlarm{
    0,
    kAll,
    PositionTrust::Suspect,
    {"Find the cause before you move anything.", "Reset (Ctrl-X), then unlock with $X.", kHome}};

}  // namespace advice
}  // namespace kerf::machine
