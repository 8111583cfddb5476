#include "apps/job_runner.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <utility>

#include <fmt/format.h>

#include "io/power_warnings.hpp"
#include "preparation/rehearsal.hpp"

namespace kerf::apps {
namespace {

using namespace std::chrono_literals;

/// The clock of the progress display runs on between two reports.
constexpr Duration kRedraw = 250ms;
/// No desktop suspends a computer sooner by default.
constexpr double kSoonestSleepS = 600;

constexpr std::string_view kLinePrompt = "For the machine ($J= jogs, G10, G43.1, $TPW; Enter sends, Esc leaves): ";
constexpr char kEscape = '\x1b';
constexpr char kBackspace = '\b';
constexpr char kDelete = '\x7f';

ExitStatus status_of(job::JobPhase phase) {
  switch (phase) {
    case job::JobPhase::Finished: return ExitStatus::Done;
    case job::JobPhase::Refused: return ExitStatus::Refused;
    case job::JobPhase::Alarmed: return ExitStatus::Alarm;
    default: return ExitStatus::Interrupted;
  }
}

/// How it ends when the job could not even begin.
ExitStatus status_of(session::Refused reason) {
  switch (reason) {
    case session::Refused::LineTooLong:
    case session::Refused::RealtimeInLine:
    case session::Refused::NeverSent: return ExitStatus::Usage;
    case session::Refused::MachineInAlarm: return ExitStatus::Alarm;
    case session::Refused::NotConnected:
    case session::Refused::NotIdentified: return ExitStatus::NoConnection;
    default: return ExitStatus::Interrupted;
  }
}

/// Seconds that pass at the machine in one second here. A clock that jumps is as good as endlessly fast.
double clock_speed(const io::MachineUrl& url) {
  constexpr double kJumping = 1e6;
  const auto* address = std::get_if<io::VirtualAddress>(&url);
  return address == nullptr ? 1.0 : address->speed.factor.value_or(kJumping);
}

std::string tool_change_sentence(const job::JobState& job) {
  if (!job.tool_change) return "The machine waits for a tool change.";
  const std::string tool = job.tool_change->tool ? fmt::format("tool {}", *job.tool_change->tool) : "the next tool";
  return fmt::format("Change to {}, measure it again if its length differs, then continue.", tool);
}

/// The operator may jog, touch off and measure.
bool takes_lines(const job::JobState& job) {
  return job.phase == job::JobPhase::Held && job.hold_cause == job::HoldCause::ToolChange;
}

/// Why it stands, and what the operator can do before he goes on.
std::string held_sentence(const job::JobState& job) {
  switch (job.hold_cause) {
    case job::HoldCause::Door: return "The safety door is open: close it first.";
    case job::HoldCause::ToolChange: return tool_change_sentence(job);
    case job::HoldCause::ProgramPause: return "The program pauses here until you go on.";
    case job::HoldCause::SingleBlock: return "Single block is on: the machine stops behind every line.";
    case job::HoldCause::Refusal:
      return fmt::format("Line {} was refused ({}). Continue leaves it out; stop keeps the position.",
                         job.refusal->file_line, job.refusal->meaning);
    case job::HoldCause::Stall:
      return job.stall && job.stall->goes_on_at ? "Answers got lost; going on is safe."
                                                : "Answers got lost; only a stop is safe.";
    case job::HoldCause::OffPath:
      if (job.departure) return describe(*job.departure) + ": stop the job, home the machine and check the work zero.";
      [[fallthrough]];
    default: return "The machine stands still.";
  }
}

}  // namespace

JobRunner::JobRunner(io::EventLoop& loop, io::MachineUrl url, std::unique_ptr<JobPreparation> preparation,
                     const session::JobOptions& options, JobView& view, bool can_ask)
    : loop_(loop),
      url_(std::move(url)),
      options_(options),
      preparation_(std::move(preparation)),
      view_(view),
      can_ask_(can_ask),
      redraw_(loop) {}

ExitStatus JobRunner::run(const io::RecordingOptions& recording) {
  constexpr std::array<int, 4> kSignals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  signals_ = std::make_unique<io::SignalWatch>(loop_, kSignals, [this](int signal) { on_signal(signal); });
  if (can_ask_) keys_ = std::make_unique<KeyReader>(loop_, [this](char key) { on_key(key); });
  host_ = std::make_unique<io::SessionHost>(
      loop_, url_, session::SessionOptions{},
      io::SessionHost::Callbacks{.event = [this](const session::Event& event) { on_event(event); },
                                 .lost = [this](const io::TransportError& error) { on_lost(error); },
                                 .noted = [this](const std::string& sentence) { view_.noted(sentence); }},
      recording, io::WordsUse::Recall);
  loop_.run();
  return status_.value_or(ExitStatus::Interrupted);
}

void JobRunner::on_event(const session::Event& event) {
  if (status_) return;
  std::visit([this](const auto& alternative) { on(alternative); }, event);
  if (!is_preparing_ || status_) return;
  preparation_->on_event(event);
  go_on_preparing();
}

void JobRunner::go_on_preparing() {
  is_at_work_ = false;
  std::visit([this](const auto& next) { follow(next); }, preparation_->next(loop_.now(), host_->session()));
  if (!is_preparing_ || status_) return;
  redraw_.arm(loop_.now() + (is_at_work_ ? Duration::zero() : kRedraw), [this] {
    if (is_preparing_ && !status_) go_on_preparing();
  });
}

void JobRunner::follow(const KeepWaiting& wait) {
  is_at_work_ = wait.is_at_work;
  if (!wait.sentence.empty()) view_.noted(wait.sentence);
}

void JobRunner::follow(const session::Command& command) {
  if (std::holds_alternative<session::Home>(command)) view_.noted("Homing.");
  host_->submit(command);
}

void JobRunner::follow(const AskOperator& question) {
  view_.told(question.told);
  if (!can_ask_) return fail("There is no terminal to ask on: say --yes.", ExitStatus::Usage);
  awaits_answer_ = true;
  view_.asked(job::JobState{}, question.question + " [y/N] ");
}

void JobRunner::follow(const BeginJob& begin) {
  view_.told(begin.told);
  is_preparing_ = false;
  if (begin.job.program == nullptr) return fail("The rest of the program cannot be sent.", ExitStatus::Usage);
  session::StartJob job = begin.job;
  job.options = options_;
  job.timeline = preparation::rehearse(*job.program, host_->session().capabilities(), clock_speed(url_));
  host_->submit(job);
}

void JobRunner::follow(const NoJob& none) {
  is_preparing_ = false;
  view_.told(none.told);
  switch (none.reason) {
    case NoJob::Reason::NotWished: return finish(ExitStatus::Done);
    case NoJob::Reason::FaultsFound: return fail(none.sentence, ExitStatus::Refused);
    case NoJob::Reason::Impossible: return fail(none.sentence, ExitStatus::Usage);
  }
}

void JobRunner::answer(char key) {
  awaits_answer_ = false;
  if (key != 'y' && key != 'Y') return fail("Not confirmed: no line was sent.", ExitStatus::Interrupted);
  preparation_->agree();
  go_on_preparing();
}

void JobRunner::on(const session::ControllerFound& found) {
  if (is_started_) return;
  view_.found(found.sentence, host_->session().capabilities());
  is_preparing_ = true;
}

void JobRunner::on(const session::ControllerReset& reset) {
  if (!reset.reason.empty()) view_.noted(reset.reason);
}

void JobRunner::on(const session::ControllerBusy& busy) {
  view_.noted(busy.sentence);
}

void JobRunner::on(const session::SettingsDrifted& drift) {
  view_.noted(drift.sentence);
}

void JobRunner::on(const session::HandshakeFailed& failed) {
  // on_lost() says better what became of the link.
  if (failed.failure != session::HandshakeFailure::LinkLost) fail(failed.sentence, ExitStatus::NoConnection);
}

void JobRunner::on(const session::LineReceived& line) {
  const auto* feedback = std::get_if<protocol::Feedback>(&line.message);
  if (is_started_ && feedback != nullptr && !feedback->text.empty()) view_.machine_said(feedback->text);
}

void JobRunner::on(const session::AlarmRaised& alarm) {
  view_.alarm_raised(alarm);
}

void JobRunner::on(const session::JobStarted&) {
  is_started_ = true;
  if (const auto& job = host_->session().job()) view_.started(*job);
  look_after_power();
  if (wish_ != Wish::Cut) host_->submit(session::HoldJob{});
}

void JobRunner::look_after_power() {
  // A machine inside this process sleeps and wakes with it.
  if (std::holds_alternative<io::VirtualAddress>(url_)) return;
  for (const std::string& warning : io::power_warnings(url_)) view_.noted(warning);
  awake_ = std::make_unique<io::SleepInhibitor>(loop_, "A job runs on " + io::to_string(url_),
                                                [this](const std::string& sentence) { sleep_warning_ = sentence; });
}

void JobRunner::warn_of_sleep(const job::Progress& progress) {
  // What is left is known from a rehearsal only.
  const double known_s = progress.elapsed_s + (progress.cutting_line ? progress.remaining_s.value_or(0) : 0);
  if (sleep_warning_.empty() || known_s < kSoonestSleepS) return;
  view_.noted(std::exchange(sleep_warning_, {}));
}

void JobRunner::on(const session::JobProgressed& progressed) {
  ask_if_held(progressed.job);
  warn_of_sleep(progressed.job.progress);
  view_.progressed(progressed.job, host_->session().snapshot());
  redraw_.arm(loop_.now() + kRedraw, [this] {
    if (const auto& job = host_->session().job(); job && !status_) on(session::JobProgressed{*job});
  });
}

void JobRunner::on(const session::JobEnded& ended) {
  end_job(ended.job);
}

void JobRunner::on(const session::LineRefused& refused) {
  if (!is_started_ || refused.purpose != streaming::Purpose::JobLine || refused.latched_repeat) return;
  view_.line_refused(refused);
}

void JobRunner::on(const session::ProgramSpoke& spoke) {
  view_.machine_said(spoke.text);
}

void JobRunner::on(const session::JobStalled& stalled) {
  view_.stalled(stalled.stall);
}

void JobRunner::on(const session::CommandRefused& refused) {
  if (is_started_) {
    view_.noted(refused.sentence);
  } else {
    fail(refused.sentence, status_of(refused.reason));
  }
}

void JobRunner::on(const session::LinkSilent& silent) {
  view_.noted(fmt::format("The machine has not answered for {:.0f} s: check cable and power.", silent.silent_for_s));
}

void JobRunner::on(const session::PathUnwatched& gap) {
  view_.noted(gap.sentence);
}

void JobRunner::on(const session::LinkAnswering&) {
  view_.noted("The machine answers again.");
}

void JobRunner::on_lost(const io::TransportError& error) {
  if (status_) return;
  const std::string sentence = io::explain(url_, error);
  if (is_started_) return fail(sentence, ExitStatus::Interrupted);
  fail(sentence, ExitStatus::NoConnection);
}

void JobRunner::on_signal(int signal) {
  if (signal == SIGINT) return interrupt();
  if (signal == SIGUSR1) return go_on();
  wish_stop();  // nobody is there any more to be asked
}

void JobRunner::on_key(char key) {
  if (awaits_answer_) return answer(key);
  if (!is_started_) return;
  if (typed_) return type(key);
  if ((key == ' ' || key == '!') && wish_ == Wish::Cut && !is_asking_) return interrupt();
  if (!is_asking_) return;
  if (key == 'c' || key == 'C' || key == '~') {
    go_on();
  } else if (key == 's' || key == 'S') {
    wish_stop();
  } else if ((key == 't' || key == 'T') && takes_lines(*host_->session().job())) {
    typed_.emplace();
    view_.asked(*host_->session().job(), kLinePrompt);
  }
}

void JobRunner::type(char key) {
  const bool is_end = key == '\r' || key == '\n';
  if (is_end && !typed_->empty()) host_->submit(session::SendLine{*typed_});
  if (is_end || key == kEscape) {
    typed_.reset();
  } else if (key == kBackspace || key == kDelete) {
    if (!typed_->empty()) typed_->pop_back();
  } else if (key >= ' ' && key < kDelete) {
    *typed_ += key;
  }
  if (is_asking_) view_.asked(*host_->session().job(), typed_ ? std::string{kLinePrompt} + *typed_ : question_);
}

void JobRunner::go_on() {
  if (!is_asking_) return;
  is_asking_ = false;
  wish_ = Wish::Cut;
  view_.noted("Going on.");
  host_->submit(session::ResumeJob{});
}

void JobRunner::interrupt() {
  if (!is_started_) return fail("Interrupted before the job began: no line of it was sent.", ExitStatus::Interrupted);
  if (wish_ == Wish::Cut && !is_asking_) {
    wish_ = Wish::Hold;
    view_.noted(can_ask_ ? "Holding. Ctrl-C again stops the job."
                         : "Holding. There is no terminal to ask on: interrupt once more to stop the job.");
    host_->submit(session::HoldJob{});
    return;
  }
  wish_stop();
}

void JobRunner::wish_stop() {
  if (!is_started_) return fail("Interrupted before the job began: no line of it was sent.", ExitStatus::Interrupted);
  is_asking_ = false;
  if (wish_ == Wish::Stop || wish_ == Wish::Abort) {
    wish_ = Wish::Abort;
    view_.noted("Resetting the controller now.");
    host_->submit(session::AbortJob{});
    return;
  }
  wish_ = Wish::Stop;
  view_.noted("Stopping: hold, wait until the machine stands still, then reset.");
  host_->submit(session::StopJob{});
}

void JobRunner::ask_if_held(const job::JobState& job) {
  const bool was_holding = is_holding_;
  is_holding_ = job.phase == job::JobPhase::Holding || job.phase == job::JobPhase::Held;
  if (was_holding && job.phase == job::JobPhase::Running) {
    is_asking_ = false;
    if (wish_ == Wish::Hold) wish_ = Wish::Cut;
  }
  if (job.phase != job::JobPhase::Held) return;
  if (is_asking_ || wish_ == Wish::Stop || wish_ == Wish::Abort) return;
  is_asking_ = true;
  const std::string where = fmt::format("Held at line {}. {}", job.progress.shown_line(), held_sentence(job));
  question_ = !can_ask_          ? where + " SIGUSR1 continues, SIGINT stops the job."
              : takes_lines(job) ? where + " [c]ontinue, [t]ype a line for the machine, or [s]top? "
                                 : where + " [c]ontinue or [s]top? ";
  typed_.reset();
  view_.asked(job, question_);
}

void JobRunner::end_job(const job::JobState& job) {
  const bool left_out = job.phase == job::JobPhase::Finished && job.lines_refused > 0;
  const ExitStatus status = left_out ? ExitStatus::Refused : status_of(job.phase);
  view_.ended(job, host_->session().snapshot(), status);
  finish(status);
}

void JobRunner::fail(std::string_view sentence, ExitStatus status) {
  if (status_) return;
  view_.failed(sentence, status);
  finish(status);
}

void JobRunner::finish(ExitStatus status) {
  status_ = status;
  redraw_.disarm();
  awake_.reset();
  loop_.stop();
}

}  // namespace kerf::apps
