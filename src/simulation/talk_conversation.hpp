#pragma once
// Our half of a talk while it runs: says the lines, checks the answers. It has the one shape of every living part, so
// the same conversation runs against a virtual controller in virtual time and against a real one in real time.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "simulation/talk.hpp"

namespace kerf::simulation {

/// Where and why a talk failed; `line` is 0 when it failed before its first step.
struct TalkFailure {
  std::size_t line = 0;
  std::string step;  ///< as written in the file, or what was tried before the first step
  std::string what;
};

struct TalkOutbox {
  std::string bytes;
  std::string pendant_bytes;
  std::vector<firmware::WorkcellEvent> events;
  [[nodiscard]] bool is_empty() const { return bytes.empty() && pendant_bytes.empty() && events.empty(); }
};

/// One run of one talk. `talk` outlives it. After take_outbox() returned something, deliver it and call advance_to()
/// again: at most one step's bytes are out at a time.
class TalkConversation {
 public:
  TalkConversation(const Talk& talk, Instant now);

  void on_bytes(Instant now, std::string_view bytes);
  /// What the pendant hears.
  void on_pendant_bytes(Instant now, std::string_view bytes);
  /// The link is gone: the talk has failed unless it was over.
  void on_closed();
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const { return deadline_; }
  [[nodiscard]] TalkOutbox take_outbox();

  [[nodiscard]] bool is_finished() const { return phase_ == Phase::Finished; }
  [[nodiscard]] const std::optional<TalkFailure>& failure() const { return failure_; }
  /// The talk needs a controller that has just been switched on, and this one has not.
  [[nodiscard]] bool came_too_late() const { return came_too_late_; }
  /// Every line said and heard, with its time in seconds since the start.
  [[nodiscard]] const std::string& record() const { return record_; }

 private:
  enum class Phase { Listening, AwaitingWelcome, Quieting, AwaitingSettingOk, Running, Ending, Finished };
  enum class Asking { No, AwaitingReport, Pausing };

  void step_once(Instant now);
  void begin_or_configure(Instant now);
  void next_setting_or_reset(Instant now);
  void soft_reset(Instant now);
  void run_step(Instant now);
  void run(Instant now, const SendBytes& send);
  void run(Instant now, const ExpectLine& expect);
  void run_on_pendant(Instant now, const ExpectLine& expect);
  void run(Instant now, const AllowLines& allow);
  void run(Instant now, const ForbidLines& forbid);
  void run(Instant now, const LetTimePass& pass);
  void run(Instant now, const WaitUntil& until);
  void run(Instant now, const MoveSwitch& move);
  void step_done(Instant now);
  void finish(Instant now);
  void fail(std::string what);
  void await_line(Instant now);
  void say(Instant now, std::string_view bytes);
  void note(Instant now, std::string_view direction, std::string_view text);
  void withdraw_allowances();
  [[nodiscard]] bool is_allowed(std::string_view line) const;
  [[nodiscard]] bool heard_welcome() const;

  const Talk& talk_;
  const Instant began_;
  Phase phase_ = Phase::Listening;
  Instant deadline_;
  bool must_yield_ = false;  ///< bytes are out: nothing more until they were delivered
  bool came_too_late_ = false;

  std::string partial_line_;
  std::deque<std::string> lines_;
  std::string partial_pendant_line_;
  std::deque<std::string> pendant_lines_;
  std::vector<const LinePattern*> allowed_;

  std::size_t setting_ = 0;
  bool is_configured_ = false;
  std::size_t step_ = 0;
  std::optional<Instant> step_limit_;
  Asking asking_ = Asking::No;
  std::size_t reports_from_ = 0;  ///< index of the first line that may be the report asked for

  TalkOutbox outbox_;
  std::optional<TalkFailure> failure_;
  std::string record_;
};

}  // namespace kerf::simulation
