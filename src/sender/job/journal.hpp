#pragma once
// What happened to a job, so that it can be resumed after anything: records as values. The session makes them, `io`
// writes them down within 50 ms, and JobHistory is what one finds there afterwards.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "sender/job/executing_lines.hpp"
#include "sender/job/job_state.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// Where the text of a job comes from, as whoever starts it knows.
struct JobOrigin {
  /// Absolute path of the file; empty for a text without one.
  std::string path{};
  /// Of the file, where the job's program is only a part of it (a resumed job); else empty, and the program's counts.
  std::string file_hash{};
  /// The job's program begins with this line of the file…
  std::uint32_t first_line = 1;
  /// …behind so many lines that Kerf put before it: program line n is file line n - preamble_lines + first_line - 1.
  std::uint32_t preamble_lines = 0;
  /// The journal's number of the job that this one continues.
  std::optional<std::int64_t> continues{};
  bool operator==(const JobOrigin&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobOrigin, (), (path, file_hash, first_line, preamble_lines, continues))

/// Line of the file for a line of the job's program; a line of the preamble counts as the first one behind it.
[[nodiscard]] std::uint32_t file_line_of(const JobOrigin& origin, std::uint32_t line);

/// The machine before the first line of a job. An empty optional means "never told".
struct MachineAtStart {
  vocabulary::Firmware firmware = vocabulary::Firmware::Unknown;
  std::string version{};
  std::string build{};
  /// The text that the owner stored with `$I=`.
  std::string user_text{};
  std::string axes{};
  int planner_blocks = 0;
  /// As listed by `$$`, passwords left out.
  std::vector<machine::SettingAssignment> settings{};

  vocabulary::MachineState state = vocabulary::MachineState::Unknown;
  /// Words of `[GC:]`, and what they mean. They are those from before the first line if `modes_are_current`.
  std::vector<std::string> parser_words{};
  machine::ParserModes modes{};
  bool modes_are_current = false;
  /// Rows of `$#` in mm: "G54" … "G59.3", "G28", "G30", "G92".
  std::map<std::string, std::vector<double>> offsets_mm{};
  bool offsets_are_current = false;
  std::optional<std::string> work_coordinate_system{};
  std::optional<int> tool{};
  machine::ToolLength tool_length{};
  std::optional<machine::OverridePercentages> overrides{};
  machine::Homing homing{};
  std::optional<std::vector<double>> machine_position_mm{};
  std::optional<std::vector<double>> work_offset_mm{};
  bool operator==(const MachineAtStart&) const = default;
};
BOOST_DESCRIBE_STRUCT(MachineAtStart, (),
                      (firmware, version, build, user_text, axes, planner_blocks, settings, state, parser_words, modes,
                       modes_are_current, offsets_mm, offsets_are_current, work_coordinate_system, tool, tool_length,
                       overrides, homing, machine_position_mm, work_offset_mm))

/// The first record of a job: it comes before its first line leaves.
struct JobBegun {
  std::string program{};
  /// content_hash() of the bytes of the program, whatever their line ends.
  std::string hash{};
  std::uint64_t size_bytes = 0;
  std::uint32_t lines = 0;
  JobOrigin origin{};
  MachineAtStart machine{};
  bool operator==(const JobBegun&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobBegun, (), (program, hash, size_bytes, lines, origin, machine))

/// How far a job is. All line numbers are those of the job's program.
struct JobAdvanced {
  JobPhase phase = JobPhase::Running;
  /// Acknowledged last: parsed and queued by the controller, not yet cut. 0 before the first.
  std::uint32_t line_acknowledged = 0;
  std::uint64_t bytes_acknowledged = 0;
  /// Sent last: nothing after it can have been executed. 0 before the first.
  std::uint32_t line_sent = 0;
  /// As of this record.
  ExecutingLines executing{};
  /// `Ln:` of the last status report.
  std::optional<long> reported_line{};

  /// The last status report, and when it came.
  std::optional<Instant> reported_at{};
  vocabulary::MachineState state = vocabulary::MachineState::Unknown;
  std::optional<int> substate{};
  std::optional<std::vector<double>> machine_position_mm{};
  std::optional<std::vector<double>> work_offset_mm{};
  std::optional<int> planner_blocks_free{};
  std::optional<double> feed_mm_per_min{};
  std::optional<double> spindle_rpm{};
  std::optional<machine::Accessories> accessories{};
  std::optional<machine::OverridePercentages> overrides{};
  std::optional<int> tool{};
  double elapsed_s = 0;
  double held_s = 0;
  bool operator==(const JobAdvanced&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobAdvanced, (),
                      (phase, line_acknowledged, bytes_acknowledged, line_sent, executing, reported_line, reported_at,
                       state, substate, machine_position_mm, work_offset_mm, planner_blocks_free, feed_mm_per_min,
                       spindle_rpm, accessories, overrides, tool, elapsed_s, held_s))

enum class NoteKind {
  Held,               ///< the job stands still, and why
  WentOn,             ///< …and goes on
  LineRefused,        ///< `error:`
  LinesLost,          ///< sent, and never to be answered
  AlarmRaised,        ///< `ALARM:`
  ControllerReset,    ///< Kerf sent a reset
  ControllerStarted,  ///< a welcome came
  LinkLost,           ///< the connection is gone
  LinkSilent,         ///< the controller does not answer
  LinkAnswering,      ///< …and answers again
  PendantTookOver,
  Message,      ///< `[MSG:]` to the operator
  Commanded,    ///< what the operator asked for
  Stalled,      ///< nothing moves although it should, and the cause
  OffThePath,   ///< the machine is not where the program says
  ToolChanged,  ///< the tool that is in now
};
BOOST_DESCRIBE_ENUM(NoteKind, Held, WentOn, LineRefused, LinesLost, AlarmRaised, ControllerReset, ControllerStarted,
                    LinkLost, LinkSilent, LinkAnswering, PendantTookOver, Message, Commanded, Stalled, OffThePath,
                    ToolChanged)

/// Something that a person wants to find in the journal, in one sentence. `line` is 0 where it is about no line.
struct JobNoted {
  NoteKind kind = NoteKind::Message;
  std::uint32_t line = 0;
  std::string text{};
  bool operator==(const JobNoted&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobNoted, (), (kind, line, text))

/// The last record of a job. A job without one was cut off: Kerf was killed, or the power failed.
struct JobClosed {
  JobState state{};
  bool operator==(const JobClosed&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobClosed, (), (state))

/// One entry. `job` counts the jobs of one session from 1; the store gives each a number of its own.
struct JournalRecord {
  using What = std::variant<JobBegun, JobAdvanced, JobNoted, JobClosed>;
  Instant at{};
  std::uint32_t job = 0;
  What what;
  bool operator==(const JournalRecord&) const = default;
};

/// A note with its instant.
struct TimedNote {
  Instant at{};
  JobNoted note{};
  bool operator==(const TimedNote&) const = default;
};
BOOST_DESCRIBE_STRUCT(TimedNote, (), (at, note))

/// How a job came to its end, as its journal tells.
enum class JobOutcome {
  CutOff,      ///< the journal ends in the middle: Kerf, its host or its power ended
  Unfinished,  ///< closed, but with lines that were not executed
  Complete,    ///< every line was executed
};
BOOST_DESCRIBE_ENUM(JobOutcome, CutOff, Unfinished, Complete)

/// What the journal knows about one job: everything that resuming it starts from.
struct JobHistory {
  Instant began_at{};
  JobBegun begun{};
  /// The records of how far it was, newest last; the oldest are forgotten.
  std::vector<JobAdvanced> advances{};
  std::vector<TimedNote> notes{};
  std::optional<JobClosed> closed{};
  /// Of the last record.
  Instant last_at{};

  /// The next record of this job. The first one must be its JobBegun.
  void fold(const JournalRecord& record);
  [[nodiscard]] JobOutcome outcome() const;
  /// Null before the first.
  [[nodiscard]] const JobAdvanced* latest() const { return advances.empty() ? nullptr : &advances.back(); }
  bool operator==(const JobHistory&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobHistory, (), (began_at, begun, advances, notes, closed, last_at))

/// So many of a job's JobAdvanced are kept: with 25 a second at most, the last 20 seconds.
inline constexpr std::size_t kAdvancesKept = 500;

}  // namespace kerf::job
