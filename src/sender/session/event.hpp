#pragma once
// What a session tells its observers. Events are past participles and carry everything that a person needs to
// understand them.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/protocol/message.hpp"
#include "sender/job/job_state.hpp"
#include "sender/machine/explanation.hpp"
#include "sender/machine/handshake.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/command.hpp"
#include "sender/session/settings_change.hpp"
#include "sender/streaming/ledger.hpp"

namespace kerf::session {

/// A line went to the wire.
struct LineSent {
  streaming::Purpose purpose{};
  std::uint32_t file_line = 0;
  std::string text;
};
BOOST_DESCRIBE_STRUCT(LineSent, (), (purpose, file_line, text))

/// A line came in: as it was, and as it was understood. An answer says which line it answers.
struct LineReceived {
  protocol::Message message;
  std::string raw;
  std::optional<streaming::OwedLine> answers;
  /// Belongs to a question that Kerf asked on its own account.
  bool for_kerf = false;
};

/// The handshake moved from one stage to another: when, why, and what it was seen from.
struct HandshakeMoved {
  machine::StageChange change;
};
BOOST_DESCRIBE_STRUCT(HandshakeMoved, (), (change))

/// The handshake is under way, in one sentence.
struct HandshakeNoted {
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(HandshakeNoted, (), (sentence))

/// Kerf resets the machine of its own accord, and why. Comes before the byte.
struct ControllerReset {
  std::string reason;
};
BOOST_DESCRIBE_STRUCT(ControllerReset, (), (reason))

/// The firmware is known by a text that stays the same while it does; what it says about itself comes next, unless
/// RecallWords gives it.
struct FirmwareIdentified {
  std::string identity;
};
BOOST_DESCRIBE_STRUCT(FirmwareIdentified, (), (identity))

/// The machine does something that Kerf did not start, or a pendant has it: Kerf watches and waits.
struct ControllerBusy {
  vocabulary::MachineState state{};
  bool pendant = false;
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(ControllerBusy, (), (state, pendant, sentence))

/// The handshake is complete: commands are obeyed from now on.
struct ControllerFound {
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(ControllerFound, (), (sentence))

using machine::HandshakeFailure;

/// No machine that Kerf can work with; the sentence says what was found and what to do.
struct HandshakeFailed {
  HandshakeFailure failure{};
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(HandshakeFailed, (), (failure, sentence))

/// A status report changed the snapshot.
struct StatusReported {
  vocabulary::MachineState before{};
  vocabulary::MachineState after{};
};
BOOST_DESCRIBE_STRUCT(StatusReported, (), (before, after))

/// A welcome came in after the handshake. `asked` when Kerf had sent the reset.
struct ControllerRestarted {
  bool asked = false;
};
BOOST_DESCRIBE_STRUCT(ControllerRestarted, (), (asked))

/// Lines sent of which the answers will never come, because the controller dropped them unread: a reset, a flush, a
/// critical alarm, a lost link.
struct LinesLost {
  std::vector<streaming::OwedLine> lines;
};
BOOST_DESCRIBE_STRUCT(LinesLost, (), (lines))

struct AlarmRaised {
  int code = 0;
  std::string title;
  std::string text;
  machine::Explanation explanation;
};
BOOST_DESCRIBE_STRUCT(AlarmRaised, (), (code, title, text, explanation))

/// An `error:` to a line. For a job line also the job's state tells it.
struct LineRefused {
  streaming::Purpose purpose{};
  job::Refusal refusal;
  /// A repeat of the first error by a controller that latches (protocol.md 6.4): the line was not executed.
  bool latched_repeat = false;
  machine::Explanation explanation;
};
BOOST_DESCRIBE_STRUCT(LineRefused, (), (purpose, refusal, latched_repeat, explanation))

/// `(MSG,…)` of the program, on a controller that drops comments. Others say it themselves.
struct ProgramSpoke {
  std::uint32_t file_line = 0;
  std::string text;
};
BOOST_DESCRIBE_STRUCT(ProgramSpoke, (), (file_line, text))

/// Answers are missing, and waiting does not help: the cause, what shows it, and the safe way on.
struct JobStalled {
  job::Stall stall;
};
BOOST_DESCRIBE_STRUCT(JobStalled, (), (stall))

struct JobStarted {
  std::string program;
};
BOOST_DESCRIBE_STRUCT(JobStarted, (), (program))

/// The job moved on, or its phase changed.
struct JobProgressed {
  job::JobState job;
};
BOOST_DESCRIBE_STRUCT(JobProgressed, (), (job))

/// The job reached a final phase; `job.reason` says how.
struct JobEnded {
  job::JobState job;
};
BOOST_DESCRIBE_STRUCT(JobEnded, (), (job))

/// From this line on Kerf cannot tell whether the machine keeps to the program's path.
struct PathUnwatched {
  std::uint32_t file_line = 0;
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(PathUnwatched, (), (file_line, sentence))

struct CommandRefused {
  Refused reason{};
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(CommandRefused, (), (reason, sentence))

/// Status questions stay without an answer although the link is open.
struct LinkSilent {
  double silent_for_s = 0;
};
BOOST_DESCRIBE_STRUCT(LinkSilent, (), (silent_for_s))

/// Answers come again after a LinkSilent.
struct LinkAnswering {};
BOOST_DESCRIBE_STRUCT(LinkAnswering, (), ())

/// A pendant has taken the machine: from now on only hold, stop and reset are obeyed.
struct PendantTookOver {
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(PendantTookOver, (), (sentence))

/// The pendant has given the machine back; Kerf asks for everything that it may have changed.
struct PendantReleased {};
BOOST_DESCRIBE_STRUCT(PendantReleased, (), ())

/// A setting was written and read back, `step` of `steps`.
struct SettingWritten {
  machine::SettingDifference setting;
  std::size_t step = 0;
  std::size_t steps = 0;
};
BOOST_DESCRIBE_STRUCT(SettingWritten, (), (setting, step, steps))

/// A ChangeSettings has come to its end.
struct SettingsChanged {
  SettingsResult result;
};
BOOST_DESCRIBE_STRUCT(SettingsChanged, (), (result))

/// The machine's settings are not those of the last connection (RecallSettings).
struct SettingsDrifted {
  std::vector<machine::SettingDifference> differences;
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(SettingsDrifted, (), (differences, sentence))

using Event = std::variant<LineSent, LineReceived, HandshakeMoved, HandshakeNoted, FirmwareIdentified, ControllerReset,
                           ControllerBusy, ControllerFound, HandshakeFailed, StatusReported, ControllerRestarted,
                           LinesLost, AlarmRaised, LineRefused, JobStarted, JobProgressed, JobEnded, CommandRefused,
                           LinkSilent, LinkAnswering, SettingWritten, SettingsChanged, SettingsDrifted, PendantTookOver,
                           PendantReleased, PathUnwatched, ProgramSpoke, JobStalled>;

}  // namespace kerf::session
