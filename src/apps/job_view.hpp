#pragma once
// How `kerf run` shows a job: on a terminal, in a log, or as JSON. Loop's thread only.

#include <memory>
#include <string_view>

#include "apps/exit_status.hpp"
#include "preparation/job_preparation.hpp"
#include "sender/job/job_state.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/event.hpp"

namespace kerf::apps {

using preparation::Told;

/// One way of showing. Sentences are complete; a view only decides where and how they appear.
class JobView {
 public:
  JobView() = default;
  virtual ~JobView() = default;
  JobView(const JobView&) = delete;
  JobView& operator=(const JobView&) = delete;

  /// What was found out before there is a job (a plan): lines for people, or one event for programs.
  virtual void told(const Told& told) = 0;
  virtual void found(std::string_view sentence, const machine::Capabilities& capabilities) = 0;
  /// Something that the operator should know, in one sentence.
  virtual void noted(std::string_view sentence) = 0;
  /// The machine speaks to the operator (`[MSG:]`).
  virtual void machine_said(std::string_view text) = 0;
  virtual void started(const job::JobState& job) = 0;
  /// Called often; the view decides how often it shows something.
  virtual void progressed(const job::JobState& job, const machine::Snapshot& snapshot) = 0;
  virtual void alarm_raised(const session::AlarmRaised& alarm) = 0;
  /// Answers are missing: why, and the safe way on.
  virtual void stalled(const job::Stall& stall) = 0;
  virtual void line_refused(const session::LineRefused& refused) = 0;
  /// The job stands still and the operator decides; the answer is a key.
  virtual void asked(const job::JobState& job, std::string_view question) = 0;
  virtual void ended(const job::JobState& job, const machine::Snapshot& snapshot, ExitStatus status) = 0;
  /// There is no job to end: the sentence says why.
  virtual void failed(std::string_view sentence, ExitStatus status) = 0;
};

/// A bar that is drawn again and again on one line of the terminal.
[[nodiscard]] std::unique_ptr<JobView> make_terminal_view();
/// Lines for a log: one every ten percent, at most one in two seconds between.
[[nodiscard]] std::unique_ptr<JobView> make_line_view();
/// One JSON object a line on standard output: {"event": …}.
[[nodiscard]] std::unique_ptr<JobView> make_json_view();
/// JSON if that is asked for, else what fits standard output.
[[nodiscard]] std::unique_ptr<JobView> make_view(bool json);

/// What happened, in one paragraph: how it ended, where, and what to do next.
[[nodiscard]] std::string summary_of(const job::JobState& job, const machine::Snapshot& snapshot);

}  // namespace kerf::apps
