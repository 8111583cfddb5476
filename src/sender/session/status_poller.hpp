#pragma once
// When to ask for a status report, and when silence means something.

#include <cstdint>
#include <optional>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/streaming/window.hpp"

namespace kerf::session {

/// How often to ask: 20 times a second while something moves on a fast link, 5 times at rest on a slow one.
struct PollPeriods {
  Duration moving{};
  Duration resting{};
};
[[nodiscard]] PollPeriods poll_periods(const streaming::LinkPace& link);

/// What the poller needs of a report.
struct ReportFacts {
  /// Axes move, or may any moment.
  bool moving = false;
  /// A pendant has the machine: this link may be deaf meanwhile.
  bool pendant = false;
  /// Period of automatic reports; zero when there are none.
  Duration automatic{};
};

/// How the link answers, for people.
struct LinkHealth {
  /// Age of the last report; empty before the first.
  std::optional<double> report_age_s{};
  /// Questions have been left unanswered for this long; empty while answers come.
  std::optional<double> silent_for_s{};
  /// Time from the last question to its report.
  std::optional<double> answer_time_s{};
  /// The shortest and the longest such time since the machine is known.
  std::optional<double> answer_time_least_s{};
  std::optional<double> answer_time_most_s{};
  std::uint32_t round_trips = 0;  ///< so many were measured
  double ask_every_s = 0;
  /// Reports come unasked.
  bool automatic = false;
};
BOOST_DESCRIBE_STRUCT(LinkHealth, (),
                      (report_age_s, silent_for_s, answer_time_s, answer_time_least_s, answer_time_most_s, round_trips,
                       ask_every_s, automatic))

/// Asks at a pace that fits state and link while reports come, and slower while they do not; does not ask where they
/// come by themselves. Liveness is missed answers, not port errors.
class StatusPoller {
 public:
  void start(Instant now, PollPeriods periods);
  void stop();

  /// A question goes out now. Call only when `is_due`.
  void on_asked(Instant now);
  /// A report came in. True when it ends a silence that was told.
  bool on_report(Instant now, const ReportFacts& report);

  /// The next report is made later than this; empty where reports come unasked.
  [[nodiscard]] std::optional<Instant> asked_since() const {
    return automatic_ == Duration{} ? unanswered_since_ : std::nullopt;
  }
  [[nodiscard]] bool is_due(Instant now) const { return now >= ask_at_; }
  /// Seconds without an answer, once for each silence, when it has lasted long enough to be told.
  [[nodiscard]] std::optional<double> take_silence(Instant now);
  /// Answers are missing for longer than they may take.
  [[nodiscard]] bool is_silent(Instant now) const;
  [[nodiscard]] LinkHealth health(Instant now) const;
  [[nodiscard]] Instant next_deadline() const;

 private:
  [[nodiscard]] Duration period() const { return moving_ ? periods_.moving : periods_.resting; }
  [[nodiscard]] Instant silent_at() const;

  PollPeriods periods_{};
  bool moving_ = false;
  bool pendant_ = false;
  Duration automatic_{};
  Instant ask_at_ = kNever;
  /// First and last question since the last report.
  std::optional<Instant> unanswered_since_;
  Instant asked_at_{};
  int unanswered_ = 0;
  std::optional<Instant> reported_at_;
  std::optional<Duration> answer_time_;
  Duration least_answer_time_ = Duration::max();
  Duration most_answer_time_{};
  std::uint32_t round_trips_ = 0;
  /// Rises with reports that nobody had asked for, and falls with others.
  int unasked_ = 0;
  std::optional<Instant> unasked_at_;
  Duration between_unasked_{};
  bool silence_told_ = false;
};

}  // namespace kerf::session
