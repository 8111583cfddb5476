#include "common/vocabulary/realtime.hpp"

#include <algorithm>

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kNone = FirmwareSet::None;

// Rows as in protocol.md 2.
constexpr std::array kRows{
    RealtimeRow{Realtime::Exit,
                "exit",
                "Reset and restart the main loop; a board greets again. Compatibility level 0 only.",
                kHal,
                kHal,
                {}},
    RealtimeRow{Realtime::Enquiry, "status query", "Like 0x80.", kHal, kNone, Realtime::StatusQuery},
    RealtimeRow{
        Realtime::Reboot, "reboot", "Restart of the processor, only directly after ESC (0x1B).", kHal, kHal, {}},
    RealtimeRow{
        Realtime::SoftReset,
        "soft reset",
        "Stops everything at once, empties all buffers and greets. In motion the position is lost. grblHAL ignores "
        "it while the E-stop input is active.",
        kAll,
        kNone,
        {}},
    RealtimeRow{
        Realtime::Stop,
        "stop",
        "Brakes, empties planner and receive buffer, spindle and coolant off, back to Idle without an alarm. Also "
        "clears most alarms that are not critical.",
        kHal,
        kNone,
        {}},
    RealtimeRow{
        Realtime::FeedHold,
        "feed hold",
        "Brakes to a stop and keeps the plan. In a jog Grbl and Rabbit cancel the jog; grblHAL ignores it there.",
        kAll,
        kNone,
        {}},
    RealtimeRow{Realtime::StatusQuery, "status query", "One status report, in any state.", kAll, kNone, {}},
    RealtimeRow{
        Realtime::CycleStart,
        "cycle start",
        "Resumes from a finished hold, a closed door or a tool change and starts queued moves. Lost while a hold is "
        "still braking.",
        kAll,
        kNone,
        {}},
    RealtimeRow{Realtime::StatusQueryAlternate, "status query", "Like ?, but silent while automatic reports are on.",
                kHal, kNone, Realtime::StatusQuery},
    RealtimeRow{Realtime::CycleStartAlternate, "cycle start", "Like ~, and never part of a text.", kHal, kNone,
                Realtime::CycleStart},
    RealtimeRow{Realtime::FeedHoldAlternate, "feed hold", "Like !, and never part of a text.", kHal, kNone,
                Realtime::FeedHold},
    RealtimeRow{Realtime::ParserReport,
                "parser report",
                "Pushes [GC:] without an ok, also in Run, Hold and Door.",
                kHal,
                kNone,
                {}},
    RealtimeRow{Realtime::SafetyDoor,
                "safety door",
                "As if the door had been opened: brakes, spindle and coolant off. Not in Alarm, Check or Sleep.",
                kAll,
                kNone,
                {}},
    RealtimeRow{
        Realtime::JogCancel,
        "jog cancel",
        "Brakes a jog and drops the queued ones. On grblHAL it also empties the receive buffer, in every state, "
        "without answers, and clears the error latch.",
        kAll,
        kNone,
        {}},
    RealtimeRow{Realtime::DebugReport,
                "debug report",
                "Only in debug builds of Grbl.",
                FirmwareSet::Grbl,
                FirmwareSet::Grbl,
                {}},
    RealtimeRow{Realtime::FullStatus,
                "full status report",
                "A report with every field, the firmware's name among them up to compatibility level 1.",
                kHal,
                kNone,
                {}},
    RealtimeRow{Realtime::OptionalStopToggle,
                "optional stop toggle",
                "Whether M1 stops; not if there is a switch for it.",
                kHal,
                kHal,
                {}},
    RealtimeRow{Realtime::SingleBlockToggle,
                "single block toggle",
                "Hold after each block; not if there is a switch for it.",
                kHal,
                kHal,
                {}},
    RealtimeRow{Realtime::FanToggle, "fan toggle", "Needs the fan plugin.", kHal, kHal, {}},
    RealtimeRow{
        Realtime::MpgModeToggle, "pendant mode toggle", "Only heard on the pendant's own stream.", kHal, kHal, {}},
    RealtimeRow{Realtime::AutoReportToggle, "automatic report toggle", "Only if $481 sets a period.", kHal, kNone, {}},
    RealtimeRow{Realtime::FeedOverrideReset, "feed override 100 %", "Feed as programmed.", kAll, kNone, {}},
    RealtimeRow{Realtime::FeedOverrideCoarsePlus, "feed override +10 %", "At most 200 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::FeedOverrideCoarseMinus, "feed override -10 %", "At least 10 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::FeedOverrideFinePlus, "feed override +1 %", "At most 200 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::FeedOverrideFineMinus, "feed override -1 %", "At least 10 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::RapidOverrideReset, "rapid override 100 %", "Rapids at full rate.", kAll, kNone, {}},
    RealtimeRow{Realtime::RapidOverrideMedium, "rapid override 50 %", "Rapids at half rate.", kAll, kNone, {}},
    RealtimeRow{Realtime::RapidOverrideLow, "rapid override 25 %", "Rapids at a quarter of the rate.", kAll, kNone, {}},
    RealtimeRow{Realtime::RapidOverrideExtraLow,
                "rapid override 5 %",
                "Rapids at a twentieth of the rate.",
                FirmwareSet::Rabbit,
                kNone,
                {}},
    RealtimeRow{Realtime::SpindleOverrideReset, "spindle override 100 %", "Speed as programmed.", kAll, kNone, {}},
    RealtimeRow{Realtime::SpindleOverrideCoarsePlus, "spindle override +10 %", "At most 200 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::SpindleOverrideCoarseMinus, "spindle override -10 %", "At least 10 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::SpindleOverrideFinePlus, "spindle override +1 %", "At most 200 %.", kAll, kNone, {}},
    RealtimeRow{Realtime::SpindleOverrideFineMinus, "spindle override -1 %", "At least 10 %.", kAll, kNone, {}},
    RealtimeRow{
        Realtime::SpindleStopToggle, "spindle stop toggle", "Spindle off and on again, in Hold only.", kAll, kNone, {}},
    RealtimeRow{Realtime::FloodToggle, "flood toggle", "In Idle, Run and Hold.", kAll, kNone, {}},
    RealtimeRow{Realtime::MistToggle, "mist toggle", "In Idle, Run and Hold, if the build has mist.", kAll, kAll, {}},
    RealtimeRow{Realtime::PidReport,
                "PID report",
                "Without the PID option it causes an error that belongs to no line: do not send it.",
                kHal,
                kHal,
                {}},
    RealtimeRow{Realtime::ToolChangeAcknowledge,
                "tool change acknowledge",
                "In state Tool: lines are read again, for jogs and tool probing.",
                kHal,
                kNone,
                {}},
    RealtimeRow{Realtime::ProbeConnectedToggle, "probe connected toggle", "If the driver can be told.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro0, "macro 0", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro1, "macro 1", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro2, "macro 2", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro3, "macro 3", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro4, "macro 4", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro5, "macro 5", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro6, "macro 6", "Needs the macro plugin.", kHal, kHal, {}},
    RealtimeRow{Realtime::Macro7, "macro 7", "Needs the macro plugin.", kHal, kHal, {}},
};

static_assert(std::ranges::is_sorted(kRows, {}, &RealtimeRow::byte));

}  // namespace

std::span<const RealtimeRow> realtime_rows() {
  return kRows;
}

const RealtimeRow* find_realtime(std::uint8_t byte) {
  const auto at = std::ranges::lower_bound(kRows, static_cast<Realtime>(byte), {}, &RealtimeRow::byte);
  return at != kRows.end() && at->byte == static_cast<Realtime>(byte) ? &*at : nullptr;
}

bool acts_on(Firmware firmware, Realtime byte) {
  const RealtimeRow* const row = find_realtime(static_cast<std::uint8_t>(byte));
  return row != nullptr && contains(row->known_to, firmware);
}

}  // namespace kerf::vocabulary
