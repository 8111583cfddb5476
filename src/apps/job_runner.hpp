#pragma once
// One job from opening the link to its end, and what the operator does meanwhile. Loop's thread only.

#include <memory>
#include <optional>
#include <string>

#include "apps/exit_status.hpp"
#include "apps/job_view.hpp"
#include "apps/terminal.hpp"
#include "io/event_loop.hpp"
#include "io/session_host.hpp"
#include "io/sleep_inhibitor.hpp"
#include "preparation/job_preparation.hpp"

namespace kerf::apps {

using preparation::AskOperator;
using preparation::BeginJob;
using preparation::JobPreparation;
using preparation::KeepWaiting;
using preparation::NoJob;

class JobRunner {
 public:
  /// The job is what `preparation` makes of the machine that is found. `can_ask`: there is a terminal whose keys answer
  /// questions.
  JobRunner(io::EventLoop& loop, io::MachineUrl url, std::unique_ptr<JobPreparation> preparation,
            const session::JobOptions& options, JobView& view, bool can_ask);

  /// Runs the event loop until the job has ended.
  [[nodiscard]] ExitStatus run(const io::RecordingOptions& recording);

 private:
  /// What the operator wants beyond cutting. Each Ctrl-C goes one further.
  enum class Wish { Cut, Hold, Stop, Abort };

  void on_event(const session::Event& event);
  void go_on_preparing();
  void follow(const KeepWaiting& wait);
  void follow(const session::Command& command);
  void follow(const AskOperator& question);
  void follow(const BeginJob& begin);
  void follow(const NoJob& none);
  void answer(char key);
  void on_lost(const io::TransportError& error);
  void on_signal(int signal);
  void on_key(char key);
  void type(char key);
  void go_on();
  void interrupt();
  void wish_stop();
  void ask_if_held(const job::JobState& job);
  void end_job(const job::JobState& job);
  void fail(std::string_view sentence, ExitStatus status);
  void finish(ExitStatus status);
  void look_after_power();
  void warn_of_sleep(const job::Progress& progress);

  void on(const session::ControllerFound& found);
  void on(const session::ControllerReset& reset);
  void on(const session::ControllerBusy& busy);
  void on(const session::HandshakeFailed& failed);
  void on(const session::LineReceived& line);
  void on(const session::AlarmRaised& alarm);
  void on(const session::JobStarted& started);
  void on(const session::JobProgressed& progressed);
  void on(const session::JobEnded& ended);
  void on(const session::LineRefused& refused);
  void on(const session::ProgramSpoke& spoke);
  void on(const session::JobStalled& stalled);
  void on(const session::CommandRefused& refused);
  void on(const session::SettingsDrifted& drift);
  void on(const session::LinkSilent& silent);
  void on(const session::PathUnwatched& gap);
  void on(const session::LinkAnswering& answering);
  template <typename Other>
  void on(const Other&) {}

  io::EventLoop& loop_;
  const io::MachineUrl url_;
  const session::JobOptions options_;
  std::unique_ptr<JobPreparation> preparation_;
  bool is_preparing_ = false;
  bool is_at_work_ = false;
  bool awaits_answer_ = false;
  JobView& view_;
  const bool can_ask_;
  std::optional<ExitStatus> status_;
  Wish wish_ = Wish::Cut;
  bool is_asking_ = false;
  std::string question_;
  /// What is being typed for the machine, at a tool change.
  std::optional<std::string> typed_;
  bool is_holding_ = false;
  bool is_started_ = false;
  io::Timer redraw_;
  std::unique_ptr<io::SleepInhibitor> awake_;
  /// Nobody keeps this computer awake, which matters to long jobs only.
  std::string sleep_warning_;
  std::unique_ptr<KeyReader> keys_;
  std::unique_ptr<io::SignalWatch> signals_;
  std::unique_ptr<io::SessionHost> host_;
};

}  // namespace kerf::apps
