#pragma once
// Descriptions of settings that several firmwares share, in our words.

#include <string_view>

namespace kerf::vocabulary::texts {

inline constexpr std::string_view kStepPulse =
    "Length of a step pulse. Shorten it only if the step rate asks for it; drivers have a minimum.";
inline constexpr std::string_view kStepIdle = "How long the motors stay on after a move. 255 keeps them on for good.";
inline constexpr std::string_view kStepInvert = "Axes whose step signal is active low.";
inline constexpr std::string_view kDirectionInvert = "Axes that turn the other way.";
inline constexpr std::string_view kEnableInvert = "Whether the signal that switches the motors on is active low.";
inline constexpr std::string_view kLimitInvert = "Whether the limit switches are read the other way round.";
inline constexpr std::string_view kProbeInvert = "Whether the probe is read the other way round.";
inline constexpr std::string_view kReportMask = "What a status report contains.";
inline constexpr std::string_view kJunctionDeviation =
    "How far a corner may be cut, which sets the speed through it. Smaller is slower and more exact.";
inline constexpr std::string_view kArcTolerance = "How far the chords of an arc may lie off the circle.";
inline constexpr std::string_view kReportInches = "Positions and feeds are told in inches. Settings stay metric.";
inline constexpr std::string_view kSoftLimits = "Motion out of the travel is refused with an alarm. Needs homing.";
inline constexpr std::string_view kHardLimits = "A limit switch stops the machine at once, with an alarm.";
inline constexpr std::string_view kHoming = "The homing cycle, which finds machine zero with the limit switches.";
inline constexpr std::string_view kHomingDirection = "Axes that home towards their negative end.";
inline constexpr std::string_view kHomingFeed = "Slow rate at which a switch is located exactly.";
inline constexpr std::string_view kHomingSeek = "Fast rate at which a switch is searched.";
inline constexpr std::string_view kHomingDebounce = "Rest between the phases of homing, for the switches to settle.";
inline constexpr std::string_view kHomingPulloff = "How far an axis backs off its switch.";
inline constexpr std::string_view kSpindleMax = "Spindle speed at full output.";
inline constexpr std::string_view kSpindleMin = "Spindle speed at the lowest output.";
inline constexpr std::string_view kLaserMode =
    "Laser mode: moves do not stop when the power changes, and the power follows the speed with M4.";
inline constexpr std::string_view kPwmFrequency = "Frequency of the spindle signal.";
inline constexpr std::string_view kPwmOff = "Duty cycle when the spindle is off.";
inline constexpr std::string_view kPwmMin = "Duty cycle at the lowest speed.";
inline constexpr std::string_view kPwmMax = "Duty cycle at full speed.";
inline constexpr std::string_view kStepsPerMm = "Motor steps for one millimetre, or one degree.";
inline constexpr std::string_view kMaxRate = "Fastest rate of the axis, which is also its rapid rate.";
inline constexpr std::string_view kAcceleration = "How hard the axis speeds up and brakes.";
inline constexpr std::string_view kMaxTravel =
    "Travel of the axis from its homing switch. Used by soft limits and homing.";

}  // namespace kerf::vocabulary::texts
