#pragma once
// What an operator may ask of a session. Commands are imperatives; a command that cannot be obeyed comes back as
// CommandRefused.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "sender/job/journal.hpp"
#include "sender/job/program.hpp"
#include "sender/job/timeline.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/words.hpp"
#include "sender/session/job_options.hpp"

namespace kerf::session {

/// Streams a program. Needs a machine that is identified, at rest in Idle or Check, and no job under way. With a
/// timeline its progress is told by the rehearsed time. Begins when modes and offsets are known to be those before its
/// first line: after lines by hand the controller is asked for them first.
struct StartJob {
  std::shared_ptr<const job::Program> program{};
  std::shared_ptr<const job::Timeline> timeline{};
  /// For the journal.
  job::JobOrigin origin{};
  JobOptions options{};
};

/// Feed hold: decelerate and stand still, position kept. Works in every state.
struct HoldJob {};

/// Goes on after a hold, a program pause, a closed door, a tool change or a refused line (without it); refused while
/// the machine still decelerates, because a cycle start in Hold:1 is lost (protocol.md 2). Behind jogs at a tool change
/// the machine first goes back to where it waited.
struct ResumeJob {};

/// Hold, wait for standstill, then soft reset: position kept, no alarm. Without a job it stops what moves by hand; a
/// jog needs no reset, it is cancelled.
struct StopJob {};

/// Soft reset now. Where the machine was moving, its position is suspect afterwards.
struct AbortJob {};

/// One line by hand, without line end. Refused when it holds bytes that a controller would take as realtime commands,
/// and while a job runs; at its tool changes the lines of ToolWork are taken.
struct SendLine {
  std::string text;
};

/// One realtime byte, past everything that waits.
struct SendRealtime {
  std::uint8_t byte = 0;
};

/// `$X`.
struct Unlock {};

/// `$H`.
struct Home {};

/// `$J=` with these words, such as "G91G21X10F1000".
struct Jog {
  std::string words;
};

/// 0x85.
struct CancelJog {};

/// 0x18, also while the handshake waits for a machine that it may not reset on its own account.
struct SoftReset {};

/// Writes settings to a machine at rest, one at a time, each read back; all of them, or none (SettingsChange). The
/// reason is kept with the result.
struct ChangeSettings {
  std::vector<machine::SettingAssignment> settings;
  std::string reason;
};

/// What the machine had when it was last seen, and when that was, in words. What differs is told once it is identified.
struct RecallSettings {
  std::vector<machine::SettingAssignment> settings;
  std::string since;
};

/// What the firmware said about itself at another time, for FirmwareIdentified: it is not asked for again.
struct RecallWords {
  machine::Words words;
};

/// 0x8B: takes the machine back from a pendant, where the controller hears this link meanwhile.
struct TakeControl {};

using Command = std::variant<StartJob, HoldJob, ResumeJob, StopJob, AbortJob, SendLine, SendRealtime, Unlock, Home, Jog,
                             CancelJog, SoftReset, ChangeSettings, RecallSettings, TakeControl, RecallWords>;

/// The names under which commands are written down, in the order of the variant.
inline constexpr std::array<std::string_view, std::variant_size_v<Command>> kCommandNames{
    "StartJob", "HoldJob", "ResumeJob", "StopJob",   "AbortJob",       "SendLine",       "SendRealtime", "Unlock",
    "Home",     "Jog",     "CancelJog", "SoftReset", "ChangeSettings", "RecallSettings", "TakeControl",  "RecallWords",
};
static_assert(!kCommandNames.back().empty(), "name the new command here, in the order of the variant");

// Logs hold commands with their members; StartJob's program is written down apart.
BOOST_DESCRIBE_STRUCT(StartJob, (), (options))
BOOST_DESCRIBE_STRUCT(HoldJob, (), ())
BOOST_DESCRIBE_STRUCT(ResumeJob, (), ())
BOOST_DESCRIBE_STRUCT(StopJob, (), ())
BOOST_DESCRIBE_STRUCT(AbortJob, (), ())
BOOST_DESCRIBE_STRUCT(SendLine, (), (text))
BOOST_DESCRIBE_STRUCT(SendRealtime, (), (byte))
BOOST_DESCRIBE_STRUCT(Unlock, (), ())
BOOST_DESCRIBE_STRUCT(Home, (), ())
BOOST_DESCRIBE_STRUCT(Jog, (), (words))
BOOST_DESCRIBE_STRUCT(CancelJog, (), ())
BOOST_DESCRIBE_STRUCT(SoftReset, (), ())
BOOST_DESCRIBE_STRUCT(ChangeSettings, (), (settings, reason))
BOOST_DESCRIBE_STRUCT(RecallSettings, (), (settings, since))
BOOST_DESCRIBE_STRUCT(TakeControl, (), ())
BOOST_DESCRIBE_STRUCT(RecallWords, (), (words))

/// Why a command was not obeyed.
enum class Refused {
  NotConnected,      ///< no link
  NotIdentified,     ///< the handshake has not finished
  PendantInControl,  ///< a pendant has the machine
  MachineNotIdle,    ///< needs Idle or Check
  MachineInAlarm,    ///< unlock or home first
  ForeignMotion,     ///< it moves, and Kerf did not start that
  JobUnderWay,       ///< another job runs
  NoJob,             ///< there is nothing to hold, resume or stop
  NotAtRest,         ///< resume needs Hold:0, Door:0 or Tool
  LineTooLong,       ///< longer than the controller takes
  RealtimeInLine,    ///< `?`, `!`, `~` or a byte that is not ASCII text
  SettingsUnderWay,  ///< settings are being changed
  NeverSent,         ///< would desynchronise or crash the controller (protocol.md 11, rule 15)
  NotAnswering,      ///< the controller has been silent for a while
  NoPendant,         ///< there is no control to take back
  ControlNotGiven,   ///< the controller does not give control back on this link
  NotAtToolChange,   ///< a job waits for a tool, and the line would spoil what comes behind
};
BOOST_DESCRIBE_ENUM(Refused, NotConnected, NotIdentified, PendantInControl, MachineNotIdle, MachineInAlarm,
                    ForeignMotion, JobUnderWay, NoJob, NotAtRest, LineTooLong, RealtimeInLine, SettingsUnderWay,
                    NeverSent, NotAnswering, NoPendant, ControlNotGiven, NotAtToolChange)

}  // namespace kerf::session
