#include "daemon/job_starter.hpp"

#include <chrono>
#include <utility>
#include <variant>

#include "preparation/rehearsal.hpp"

namespace kerf::daemon {
namespace {

using namespace std::chrono_literals;
using preparation::AskOperator;
using preparation::BeginJob;
using preparation::KeepWaiting;
using preparation::NoJob;

/// A machine that says nothing is looked at so often.
constexpr Duration kLookAgain = 250ms;

}  // namespace

JobStarter::JobStarter(io::EventLoop& loop, io::WorkerPool& pool, Callbacks callbacks)
    : loop_(loop), pool_(pool), callbacks_(std::move(callbacks)), timer_(loop) {}

void JobStarter::begin(std::string sentence, std::function<Prepared()> prepare, const session::JobOptions& options) {
  end();
  options_ = options;
  view_ = PreparationView{.sentence = std::move(sentence)};
  callbacks_.changed();
  pool_.run(
      [this, alive = std::weak_ptr(alive_), number = number_, prepare = std::move(prepare)]() -> std::function<void()> {
        auto prepared = std::make_shared<Prepared>(prepare());
        return [this, alive, number, prepared] {
          if (alive.expired() || number != number_) return;
          if (!*prepared) return follow(NoJob{.sentence = prepared->error()});
          preparation_ = std::move(**prepared);
          view_->phase = PreparationPhase::Checking;
          go_on();
        };
      });
}

void JobStarter::end() {
  ++number_;
  timer_.disarm();
  preparation_.reset();
  view_.reset();
  callbacks_.changed();
}

void JobStarter::agree() {
  view_->question.reset();
  view_->phase = PreparationPhase::Settling;
  preparation_->agree();
  go_on();
}

void JobStarter::on_event(const session::Event& event) {
  if (!preparation_) return;
  preparation_->on_event(event);
  // It will look by itself, outside of the session's own call.
  if (!asks()) timer_.arm(loop_.now(), [this] { go_on(); });
}

void JobStarter::go_on() {
  const session::Session* const session = callbacks_.session();
  if (!preparation_ || asks()) return;
  if (session == nullptr) return follow(NoJob{.sentence = "There is no link to the machine any more."});
  is_at_work_ = false;
  const auto number = number_;
  std::visit([this](const auto& next) { follow(next); }, preparation_->next(loop_.now(), *session));
  if (number != number_ || !preparation_ || asks()) return;
  timer_.arm(loop_.now() + (is_at_work_ ? Duration::zero() : kLookAgain), [this] { go_on(); });
}

void JobStarter::follow(const KeepWaiting& wait) {
  is_at_work_ = wait.is_at_work;
  if (wait.sentence.empty()) return;
  view_->sentence = wait.sentence;
  callbacks_.changed();
}

void JobStarter::follow(const session::Command& command) {
  view_->phase = PreparationPhase::Settling;
  if (std::holds_alternative<session::Home>(command)) view_->sentence = "The machine is homed first.";
  callbacks_.changed();
  callbacks_.submit(command);
}

void JobStarter::tell(const preparation::Told& told) {
  if (!told.lines.empty()) view_->told = told.lines;
}

void JobStarter::follow(const AskOperator& question) {
  tell(question.told);
  view_->phase = PreparationPhase::Asking;
  view_->question = question.question;
  callbacks_.changed();
}

void JobStarter::follow(const BeginJob& begin) {
  tell(begin.told);
  session::StartJob job = begin.job;
  preparation_.reset();
  if (job.program == nullptr) return follow(NoJob{.sentence = "The rest of the program cannot be sent."});
  rehearse(std::move(job));
}

void JobStarter::rehearse(session::StartJob job) {
  view_->phase = PreparationPhase::Rehearsing;
  view_->sentence = "The job is rehearsed on the virtual controller.";
  callbacks_.changed();
  job.options = options_;
  const session::Session* const session = callbacks_.session();
  if (session == nullptr) return follow(NoJob{.sentence = "There is no link to the machine any more."});
  pool_.run(
      [this, alive = std::weak_ptr(alive_), number = number_, job = std::move(job), speed = callbacks_.clock_speed,
       known =
           std::make_shared<const machine::Capabilities>(session->capabilities())]() mutable -> std::function<void()> {
        job.timeline = preparation::rehearse(*job.program, *known, speed);
        return [this, alive, number, job = std::move(job)] {
          if (alive.expired() || number != number_) return;
          end();
          if (callbacks_.session() != nullptr) callbacks_.submit(job);
        };
      });
}

void JobStarter::follow(const NoJob& none) {
  callbacks_.noted(NoteLevel::Trouble, none.sentence);
  PreparationView refused{.phase = PreparationPhase::Refused, .sentence = none.sentence, .told = none.told.lines};
  end();
  view_ = std::move(refused);
}

}  // namespace kerf::daemon
