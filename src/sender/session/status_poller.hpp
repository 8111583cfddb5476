#pragma once
// When to ask for a status report, and when silence means something.

#include <optional>

#include "common/base/time.hpp"

namespace kerf::session {

/// Asks at a steady pace while reports come, and slower while they do not. Liveness is missed answers, not port errors.
class StatusPoller {
 public:
  /// `period` between questions.
  void start(Instant now, Duration period);
  void stop();

  /// A question goes out now. Call only when `is_due`.
  void on_asked(Instant now);
  /// A report came in; `comes_by_itself` when the controller reports unasked (protocol.md 3.6). True when it ends a
  /// silence that was told.
  bool on_report(Instant now, bool comes_by_itself);

  [[nodiscard]] bool is_due(Instant now) const { return now >= ask_at_; }
  /// Seconds without an answer, once for each silence, when it has lasted long enough to be told.
  [[nodiscard]] std::optional<double> take_silence(Instant now);
  [[nodiscard]] Instant next_deadline() const;

 private:
  [[nodiscard]] Instant silent_at() const;

  Duration period_{};
  Instant ask_at_ = kNever;
  /// First question since the last report.
  std::optional<Instant> unanswered_since_;
  bool silence_told_ = false;
};

}  // namespace kerf::session
