#pragma once
// The state of a job as observers see it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "sender/job/error_policy.hpp"
#include "sender/job/path_follower.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/progress.hpp"
#include "sender/job/stall_diagnosis.hpp"

namespace kerf::job {

/// Phases of a job. Those from Finished on are final: nothing leaves them, and nothing restarts by itself.
enum class JobPhase {
  Running,
  Holding,      ///< feed hold asked for, the machine still decelerates
  Held,         ///< at rest, `hold_cause` says why; `ResumeJob` goes on where it can
  Draining,     ///< an alarm: no more lines, answers still to come
  Stopping,     ///< hold, standstill, then reset
  Finished,     ///< every line answered, motion ended, Idle seen
  Refused,      ///< the controller refused a line
  Alarmed,      ///< an alarm ended it
  Interrupted,  ///< reset, pendant or link loss from outside
  Stopped,      ///< the operator stopped or aborted it
};
BOOST_DESCRIBE_ENUM(JobPhase, Running, Holding, Held, Draining, Stopping, Finished, Refused, Alarmed, Interrupted,
                    Stopped)

[[nodiscard]] constexpr bool is_final(JobPhase phase) {
  return phase >= JobPhase::Finished;
}

/// Why a job stands still.
enum class HoldCause {
  None,
  FeedHold,
  Door,
  ToolChange,    ///< the controller waits in its Tool state, or Kerf holds the line with M6 back
  ProgramPause,  ///< M0, M1 or M60
  SingleBlock,   ///< the controller stops behind every line
  Refusal,       ///< a line was refused, and the operator is asked
  OffPath,       ///< the machine is not where the program says
  Stall,         ///< answers got lost, and the operator is asked
};
BOOST_DESCRIBE_ENUM(HoldCause, None, FeedHold, Door, ToolChange, ProgramPause, SingleBlock, Refusal, OffPath, Stall)

/// Lines sent whose fate matters after a refusal, an alarm or an interruption.
struct Aftermath {
  /// First file line that was certainly not executed; 0 when every line sent was answered well.
  std::uint32_t first_line_not_executed = 0;
  /// Lines after the refused one that the controller accepted and executed all the same (no error latch:
  /// protocol.md 6.4).
  std::uint32_t lines_executed_after_refusal = 0;
  /// Lines answered with the latched error, or lost with the receive buffer.
  std::uint32_t lines_not_executed = 0;
  bool operator==(const Aftermath&) const = default;
};
BOOST_DESCRIBE_STRUCT(Aftermath, (), (first_line_not_executed, lines_executed_after_refusal, lines_not_executed))

/// A job from start to its end.
struct JobState {
  std::string program;
  JobPhase phase = JobPhase::Running;
  HoldCause hold_cause = HoldCause::None;
  Progress progress;
  /// The last line that was refused.
  std::optional<Refusal> refusal;
  /// Lines of the file that were refused and not executed.
  std::uint32_t lines_refused = 0;
  /// The tool change at which it stands.
  std::optional<ToolGate> tool_change;
  /// Why no answer comes.
  std::optional<Stall> stall;
  /// The line that ended the program (M2, M30, `%`); what the file holds behind it was not sent.
  std::uint32_t end_line = 0;
  std::optional<int> alarm_code;
  /// The machine did something else than the program says, and Kerf held it.
  std::optional<PathDeparture> departure;
  Aftermath aftermath;
  /// After an abort or an alarm in motion the position may be wrong.
  bool position_suspect = false;
  /// One sentence for a final phase: what happened.
  std::string reason;
  bool operator==(const JobState&) const = default;
};
BOOST_DESCRIBE_STRUCT(JobState, (),
                      (program, phase, hold_cause, progress, refusal, lines_refused, tool_change, stall, end_line,
                       alarm_code, departure, aftermath, position_suspect, reason))

}  // namespace kerf::job
