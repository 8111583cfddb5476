#pragma once
// Why no answer comes: one named cause, what shows it, and the safe way on.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/vocabulary/machine_state.hpp"

namespace kerf::job {

/// What a job waits for. From LostAnswer on it would wait for ever.
enum class StallCause {
  PlannerFull,         ///< a long move: the controller takes the next line when a block is free
  Dwell,               ///< G4
  NotReading,          ///< lines lie unread in the controller
  Hold,                ///< somebody held the machine
  SingleBlock,         ///< the controller stops behind every line
  Door,                ///< the safety door
  ToolChange,          ///< the controller's Tool state
  WaitingForOperator,  ///< M0, M1, a tool change or a refused line
  LostAnswer,          ///< the lines were executed, an `ok` got lost
  LostLine,            ///< a line never arrived
  LostLineEnd,         ///< a line arrived without its end
  DeadLink,            ///< nothing comes from the controller at all
  Unexplained,         ///< answers are missing, and nothing proves what became of their lines
};
BOOST_DESCRIBE_ENUM(StallCause, PlannerFull, Dwell, NotReading, Hold, SingleBlock, Door, ToolChange, WaitingForOperator,
                    LostAnswer, LostLine, LostLineEnd, DeadLink, Unexplained)

[[nodiscard]] constexpr bool needs_decision(StallCause cause) {
  return cause >= StallCause::LostAnswer;
}

/// A diagnosis, for people and programs.
struct Stall {
  StallCause cause{};
  /// The oldest line without an answer; 0 where it is no line of the file.
  std::uint32_t file_line = 0;
  /// Answers have been missing for this long.
  double since_s = 0;
  std::string headline{};
  std::vector<std::string> evidence{};
  /// The safe way on, the first step first.
  std::vector<std::string> steps{};
  /// Going on is safe: nothing is sent twice and nothing is left out. The line it goes on with.
  std::optional<std::uint32_t> goes_on_at{};
  bool operator==(const Stall&) const = default;
};
BOOST_DESCRIBE_STRUCT(Stall, (), (cause, file_line, since_s, headline, evidence, steps, goes_on_at))

/// What came of asking the controller behind the lines that it owes answers to. The question is `$G`: a controller that
/// reads it has read every line before it, and behind a line without its end it makes that line an error, so that
/// nothing moves either way.
enum class StallProof {
  NotAsked,
  Asked,
  LinesRead,       ///< `[GC:` came: all lines before were read, and no more answers to them will come
  LineEndMissing,  ///< an error came instead: the question was taken for the end of another line
  NoAnswer,
};
BOOST_DESCRIBE_ENUM(StallProof, NotAsked, Asked, LinesRead, LineEndMissing, NoAnswer)

/// What is known while answers are missing.
struct StallFacts {
  vocabulary::MachineState state{};
  bool waits_for_operator = false;
  bool single_block = false;
  bool link_is_dead = false;
  /// Free and in all; empty where the controller does not report them (`Bf:`).
  std::optional<int> planner_free{};
  int planner_blocks = 0;
  std::optional<int> rx_free{};
  int rx_bytes = 0;
  std::size_t owed_lines = 0;
  std::uint32_t first_owed_line = 0;
  std::uint32_t last_owed_line = 0;
  /// Of all dwells among the owed lines; negative where one is computed.
  double dwell_s = 0;
  double unanswered_s = 0;
  StallProof proof = StallProof::NotAsked;
  /// The link was silent when this line was the oldest without an answer, and nothing has proven since that all were
  /// answered; 0 otherwise.
  std::uint32_t silent_from_line = 0;
  /// Behind so many of the owed lines the machine stands, as their targets and its position tell; empty if they do not.
  std::optional<std::size_t> executed_lines{};
  /// File line of the first owed line that was not executed, if `executed_lines` says so.
  std::uint32_t first_not_executed = 0;
};

/// The one cause; empty while everything goes its way.
[[nodiscard]] std::optional<Stall> diagnose(const StallFacts& facts);

/// Every line has been read, the machine is idle and still owes answers: time to ask for a proof.
[[nodiscard]] bool calls_for_proof(const StallFacts& facts);

/// Decides when answers are missing for too long, and when to ask for a proof. Told what happens; asks for one thing.
class StallWatch {
 public:
  /// A line was sent although none was owed, or an answer came.
  void on_progress(Instant now);
  /// Facts without `unanswered_s` and `proof`, which it knows itself. Gives what is wrong now.
  [[nodiscard]] std::optional<Stall> on_report(Instant now, StallFacts facts);
  /// True once: send the question.
  [[nodiscard]] bool take_question();
  void on_proof(StallProof proof) { proof_ = proof; }
  [[nodiscard]] StallProof proof() const { return proof_; }
  [[nodiscard]] double unanswered_s(Instant now) const { return base::to_seconds(now - progress_at_); }

 private:
  Instant progress_at_{};
  Instant asked_at_{};
  StallProof proof_ = StallProof::NotAsked;
  int idle_reports_ = 0;
  bool question_due_ = false;
  bool was_held_ = false;
};

}  // namespace kerf::job
