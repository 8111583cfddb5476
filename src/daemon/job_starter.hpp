#pragma once
// From Start to the first line of a job: the preparation asks, checks and plans, a rehearsal tells the times. Loop's
// thread only.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/machine_view.hpp"
#include "io/event_loop.hpp"
#include "io/worker_pool.hpp"
#include "preparation/job_preparation.hpp"
#include "sender/session/session.hpp"

namespace kerf::daemon {

class JobStarter {
 public:
  struct Callbacks {
    /// The session of the moment; null when there is none.
    std::function<const session::Session*()> session;
    std::function<void(const session::Command&)> submit;
    std::function<void(NoteLevel, std::string sentence)> noted;
    std::function<void()> changed;
    /// Seconds of the machine in one of ours.
    double clock_speed = 1;
  };

  JobStarter(io::EventLoop& loop, io::WorkerPool& pool, Callbacks callbacks);

  /// Something has to be read first, and then there is a preparation, or one sentence why there is none.
  using Prepared = std::expected<std::unique_ptr<preparation::JobPreparation>, std::string>;
  void begin(std::string sentence, std::function<Prepared()> prepare, const session::JobOptions& options);
  /// The operator's answer to the question.
  [[nodiscard]] bool asks() const { return view_ && view_->question.has_value(); }
  void agree();
  /// Also without a question: there is, or will be, no job.
  void end();
  void on_event(const session::Event& event);

  /// There will be a job, or a question.
  [[nodiscard]] bool is_busy() const { return view_ && view_->phase != PreparationPhase::Refused; }
  [[nodiscard]] const std::optional<PreparationView>& view() const { return view_; }

 private:
  void go_on();
  void follow(const preparation::KeepWaiting& wait);
  void follow(const session::Command& command);
  void follow(const preparation::AskOperator& question);
  void follow(const preparation::BeginJob& begin);
  void follow(const preparation::NoJob& none);
  void tell(const preparation::Told& told);
  void rehearse(session::StartJob job);

  io::EventLoop& loop_;
  io::WorkerPool& pool_;
  const Callbacks callbacks_;
  io::Timer timer_;
  /// What comes back from the pool for an earlier one is dropped.
  std::uint64_t number_ = 0;
  std::optional<PreparationView> view_;
  std::unique_ptr<preparation::JobPreparation> preparation_;
  session::JobOptions options_;
  bool is_at_work_ = false;
  /// What comes back from the pool finds out with it whether anybody is there.
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace kerf::daemon
