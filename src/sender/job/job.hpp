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
  SendSync,     ///< a line whose answer proves that the motion has ended (protocol.md 6.5)
  ClearLatch,   ///< an empty line, so that the next line is not refused on behalf of this job (protocol.md 6.4)
  FeedHold,
  CycleStart,
  SoftReset,
};
BOOST_DESCRIBE_ENUM(JobOrder, StopFeeding, SendSync, ClearLatch, FeedHold, CycleStart, SoftReset)

/// The answer to a line of the program.
struct JobAnswer {
  std::uint32_t file_line = 0;
  std::uint64_t file_offset_after = 0;
  std::string_view text;
  int error_code = 0;  ///< 0 is ok
  std::string_view meaning;
};

/// Follows one job. It never restarts anything: a welcome, a lost link or a pendant ends it, and only the operator's
/// `resume` leaves a hold. After an error no further line is fed; what the controller had already taken is accounted
/// for, and the job ends when the machine rests.
class Job {
 public:
  /// `has_error_latch`: an error makes the controller refuse all later lines (protocol.md 6.4). `timeline` may be null.
  Job(Instant now, const Program& program, bool has_error_latch, std::shared_ptr<const Timeline> timeline = nullptr);

  /// Takes an answer; true when it is a latched repeat of the first error, so that the line was not executed.
  bool on_answer(Instant now, const JobAnswer& answer);
  /// All lines of the program have been sent and answered.
  void on_lines_answered(Instant now);
  void on_sync_answered(Instant now);
  void on_snapshot(Instant now, const machine::Snapshot& snapshot);
  /// `meaning` for the sentence at the end.
  void on_alarm(Instant now, int code, std::string_view meaning);
  /// The controller forgot everything that it had not answered: reset, critical alarm or flush.
  void on_lines_lost(std::uint32_t first_file_line, std::uint32_t lines);
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
  [[nodiscard]] const JobState& state() const { return state_; }
  /// Brings `state().progress` up to `now`.
  void update_progress(Instant now) { state_.progress = meter_.at(now); }

 private:
  /// What the job waits for beyond its phase.
  enum class Waiting { ForLines, ForSync, ForRest };

  void order(JobOrder what) { orders_.push_back(what); }
  void stop_feeding();
  void enter(Instant now, JobPhase phase, HoldCause cause = HoldCause::None, bool resumable = false);
  void order_hold(Instant now);
  void end(Instant now, JobPhase phase, std::string reason);
  void end_by_alarm(Instant now);
  void obey_stop();
  void follow_motion(Instant now, const machine::Snapshot& snapshot);
  void follow_run(Instant now);
  [[nodiscard]] bool ended() const { return is_final(state_.phase); }

  JobState state_;
  ProgressMeter meter_;
  StopSequence stop_;
  bool has_error_latch_ = false;
  Waiting waiting_ = Waiting::ForLines;
  bool feeding_ = true;
  bool lines_settled_ = false;
  bool resumable_ = false;
  bool hold_ordered_ = false;
  bool moving_ = false;
  Instant deadline_ = kNever;
  Instant hold_ordered_at_{};
  /// Reports about the hold before this instant may have been on their way when the cycle start went out.
  Instant deaf_to_hold_until_{};
  std::string alarm_meaning_;
  std::vector<JobOrder> orders_;
};

}  // namespace kerf::job
