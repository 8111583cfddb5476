#pragma once
// One job from its first line to its end: a state machine that is told what happens and says what to do.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "sender/job/job_state.hpp"
#include "sender/job/program.hpp"
#include "sender/job/stop_sequence.hpp"
#include "sender/job/timeline.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// What a job wants done. The order matters.
enum class JobOrder {
  StopFeeding,  ///< no more lines of the program
  HoldFeeding,  ///< no line of the program for now
  FeedAgain,    ///< from the line `goes_on_at()` on
  SendSync,     ///< a line whose answer proves that the motion has ended (protocol.md 6.5)
  ClearLatch,   ///< an empty line, so that the next line is not refused on behalf of this job (protocol.md 6.4)
  FeedHold,
  CycleStart,
  SoftReset,
  AnnounceReset,  ///< nobody has asked for the reset that is to come: the refused line is the reason
};
BOOST_DESCRIBE_ENUM(JobOrder, StopFeeding, HoldFeeding, FeedAgain, SendSync, ClearLatch, FeedHold, CycleStart,
                    SoftReset)

/// The answer to a line of the program.
struct JobAnswer {
  std::uint32_t file_line = 0;
  std::uint64_t file_offset_after = 0;
  std::string_view text;
  int error_code = 0;  ///< 0 is ok
  std::string_view meaning;
};

/// What a job goes by.
struct JobTerms {
  /// An error makes the controller refuse all later lines (protocol.md 6.4).
  bool has_error_latch = false;
  ErrorPolicy on_error = ErrorPolicy::HoldAndAsk;
  /// Shared with the lines that are fed; may be null.
  std::shared_ptr<ProgramFlow> flow{};
};

/// Follows one job. It never restarts anything: a welcome, a lost link or a pendant ends it, and only the operator's
/// `resume` leaves a hold. What happens after a refused line, its ErrorPolicy says; what the controller had already
/// taken is accounted for.
class Job {
 public:
  /// `timeline` may be null.
  Job(Instant now, const Program& program, JobTerms terms, std::shared_ptr<const Timeline> timeline = nullptr);

  /// Takes an answer; true when it is a latched repeat of the first error, so that the line was not executed.
  bool on_answer(Instant now, const JobAnswer& answer);
  /// All lines that were sent have been answered, and there is none to send now.
  void on_lines_answered(Instant now);
  void on_sync_answered(Instant now);
  /// `awaited`: the line whose answer is due next, empty if none is.
  void on_snapshot(Instant now, const machine::Snapshot& snapshot, std::string_view awaited = {});
  /// `meaning` for the sentence at the end.
  void on_alarm(Instant now, int code, std::string_view meaning);
  /// The controller forgot everything that it had not answered: reset, critical alarm or flush.
  void on_lines_lost(std::uint32_t first_file_line, std::uint32_t lines);
  /// What answers are waited for, as of now; empty when they come.
  void on_stall(std::optional<Stall> stall) {
    if (!asks_about_stall()) state_.stall = std::move(stall);
  }
  /// Lines lost their answers: the operator decides. Going on is possible where the stall says with which line.
  void hold_for(Instant now, Stall stall);
  void on_welcome(Instant now);
  void on_link_closed(Instant now);
  /// The machine is not where the program says: it is held, and the operator decides.
  void on_departure(Instant now, const PathDeparture& departure);
  void set_executing(const ExecutingLines& lines);

  void hold(Instant now);
  /// Only when `can_resume` holds.
  void resume(Instant now);
  void stop(Instant now);
  void abort(Instant now);

  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const { return std::min(deadline_, stop_.next_deadline()); }
  [[nodiscard]] std::vector<JobOrder> take_orders();

  /// A cycle start would be obeyed.
  [[nodiscard]] bool can_resume() const {
    return resumable_ && (state_.phase == JobPhase::Held || state_.phase == JobPhase::Draining);
  }
  /// It is held, or will be: no line may leave before it goes on.
  [[nodiscard]] bool stands() const { return state_.phase == JobPhase::Holding || state_.phase == JobPhase::Held; }
  /// The line of JobOrder::FeedAgain.
  [[nodiscard]] std::uint32_t goes_on_at() const { return goes_on_at_; }
  [[nodiscard]] const JobState& state() const { return state_; }
  /// Brings `state().progress` up to `now`.
  void update_progress(Instant now) { state_.progress = meter_.at(now); }

 private:
  /// What the job waits for beyond its phase.
  enum class Waiting { ForLines, ForSync, ForRest, ForToolState };

  void order(JobOrder what) { orders_.push_back(what); }
  void stop_feeding();
  void enter(Instant now, JobPhase phase, HoldCause cause = HoldCause::None, bool resumable = false);
  void order_hold(Instant now);
  void end(Instant now, JobPhase phase, std::string reason);
  void end_by_alarm(Instant now);
  void obey_stop();
  void refuse(Instant now, const JobAnswer& answer);
  void go_on(Instant now);
  void follow_motion(Instant now, const machine::Snapshot& snapshot, std::string_view awaited);
  void follow_rest(Instant now);
  void follow_tool_gate(Instant now);
  [[nodiscard]] HoldCause cause_of_hold(const machine::Snapshot& snapshot, std::string_view awaited) const;
  void follow_run(Instant now);
  [[nodiscard]] bool is_at_operators_gate() const;
  /// Held by Kerf while the machine is idle.
  [[nodiscard]] bool waits_while_idle() const {
    return is_at_operators_gate() || (state_.phase == JobPhase::Held && state_.hold_cause == HoldCause::Stall);
  }
  /// Answers got lost, and the operator is asked; whatever the machine reports meanwhile.
  [[nodiscard]] bool asks_about_stall() const { return feeding_held_ && !account_; }
  [[nodiscard]] bool asks_about_refusal() const { return account_ && feeding_held_ && !goes_on_; }
  /// A job that ends because of a refused line says so.
  [[nodiscard]] JobPhase stopped_phase() const { return account_ ? JobPhase::Refused : JobPhase::Stopped; }
  [[nodiscard]] bool ended() const { return is_final(state_.phase); }

  JobState state_;
  ProgressMeter meter_;
  StopSequence stop_;
  JobTerms terms_;
  /// Of the last refused line, until the job goes on behind it.
  std::optional<RefusalAccount> account_;
  std::uint32_t goes_on_at_ = 0;
  bool feeding_held_ = false;
  /// The operator, or the policy, has decided to go on without the refused line.
  bool goes_on_ = false;
  Waiting waiting_ = Waiting::ForLines;
  /// In the last report, while it waits for the end of a tool change.
  bool was_idle_ = false;
  bool feeding_ = true;
  bool resumable_ = false;
  bool hold_ordered_ = false;
  /// By the operator, who has not resumed yet.
  bool hold_asked_ = false;
  bool moving_ = false;
  bool in_hold_ = false;
  Instant deadline_ = kNever;
  Instant hold_ordered_at_{};
  Instant tool_line_answered_at_{};
  /// Reports about the hold before this instant may have been on their way when the cycle start went out.
  Instant deaf_to_hold_until_{};
  std::string alarm_meaning_;
  std::vector<JobOrder> orders_;
};

}  // namespace kerf::job
