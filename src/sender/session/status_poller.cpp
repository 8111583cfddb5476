#include "sender/session/status_poller.hpp"

#include <algorithm>
#include <chrono>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;

/// A silence this long is told. Shorter ones are firmware that writes its memory (protocol.md 10 row 31).
constexpr Duration kSilence = 2s;
/// Answers may take this long before the health says that they are missing.
constexpr Duration kPatience = 1s;
/// A question without an answer is repeated, but not at the full pace: the answers may be queued up.
constexpr Duration kAskAgain = 1s;
/// Reports that come by themselves may fail to come this often before Kerf asks after all.
constexpr int kAutomaticMissed = 4;
constexpr Duration kAutomaticPatience = 500ms;
/// Reports that come unasked again and again are automatic ones, also where the controller does not say so (`AR:`).
constexpr int kUnaskedMeansAutomatic = 6;
constexpr int kUnaskedCounts = 3;
constexpr Duration kLongestAutomatic = 1s;
/// A pendant's machine is only watched.
constexpr Duration kAskPendant = 2s;
/// After so many questions a link counts as deaf: grblHAL switches it off while the pendant commands (stream.c).
constexpr int kDeafAfter = 3;

/// A report is about 100 bytes: 10 a second take a tenth of 115200 baud and leave the rest to the job.
struct PaceRow {
  int baud_from;
  PollPeriods periods;
};
constexpr PollPeriods kFast{.moving = 50ms, .resting = 100ms};
constexpr PaceRow kPaces[] = {
    {.baud_from = 230400, .periods = kFast},
    {.baud_from = 57600, .periods = {.moving = 100ms, .resting = 200ms}},
    {.baud_from = 0, .periods = {.moving = 500ms, .resting = 500ms}},
};

}  // namespace

PollPeriods poll_periods(const streaming::LinkPace& link) {
  if (!link.baud) return kFast;
  return std::ranges::find_if(kPaces, [&](const PaceRow& row) { return *link.baud >= row.baud_from; })->periods;
}

void StatusPoller::start(Instant now, PollPeriods periods) {
  *this = {};
  periods_ = periods;
  ask_at_ = now;
}

void StatusPoller::stop() {
  ask_at_ = kNever;
  unanswered_since_.reset();
  unanswered_ = 0;
}

void StatusPoller::on_asked(Instant now) {
  asked_at_ = now;
  ++unanswered_;
  ask_at_ = now + std::max(period(), pendant_ ? kAskPendant : kAskAgain);
  if (pendant_ && unanswered_ >= kDeafAfter) ask_at_ = kNever;
  if (!unanswered_since_) unanswered_since_ = now;
}

bool StatusPoller::on_report(Instant now, const ReportFacts& report) {
  if (ask_at_ == kNever && !pendant_) return false;
  const bool was_asked = unanswered_since_.has_value();
  unasked_ = std::clamp(unasked_ + (was_asked ? -1 : kUnaskedCounts), 0, kUnaskedMeansAutomatic);
  if (!was_asked) {
    between_unasked_ = unasked_at_ ? now - *unasked_at_ : kLongestAutomatic;
    unasked_at_ = now;
  }
  if (was_asked && unanswered_ == 1) {
    answer_time_ = now - asked_at_;
    least_answer_time_ = std::min(least_answer_time_, *answer_time_);
    most_answer_time_ = std::max(most_answer_time_, *answer_time_);
    ++round_trips_;
  }
  reported_at_ = now;
  const Instant asked_at = was_asked ? asked_at_ : now;
  unanswered_since_.reset();
  unanswered_ = 0;
  moving_ = report.moving;
  pendant_ = report.pendant;
  automatic_ = report.automatic;
  if (automatic_ == Duration{} && unasked_ >= kUnaskedMeansAutomatic && between_unasked_ < kLongestAutomatic) {
    automatic_ = between_unasked_;
  }
  if (pendant_) {
    ask_at_ = now + kAskPendant;
  } else if (automatic_ > Duration{}) {
    ask_at_ = now + std::max(kAutomaticPatience, kAutomaticMissed * automatic_);
  } else {
    ask_at_ = std::max(now, asked_at + period());
  }
  const bool ends_silence = silence_told_;
  silence_told_ = false;
  return ends_silence;
}

Instant StatusPoller::silent_at() const {
  return unanswered_since_ && !silence_told_ && !pendant_ ? *unanswered_since_ + kSilence : kNever;
}

std::optional<double> StatusPoller::take_silence(Instant now) {
  if (now < silent_at()) return std::nullopt;
  silence_told_ = true;
  return base::to_seconds(now - *unanswered_since_);
}

bool StatusPoller::is_silent(Instant now) const {
  return unanswered_since_ && !pendant_ && now - *unanswered_since_ >= kPatience;
}

LinkHealth StatusPoller::health(Instant now) const {
  LinkHealth health;
  if (reported_at_) health.report_age_s = base::to_seconds(now - *reported_at_);
  if (is_silent(now)) health.silent_for_s = base::to_seconds(now - *unanswered_since_);
  if (answer_time_) {
    health.answer_time_s = base::to_seconds(*answer_time_);
    health.answer_time_least_s = base::to_seconds(least_answer_time_);
    health.answer_time_most_s = base::to_seconds(most_answer_time_);
  }
  health.round_trips = round_trips_;
  health.ask_every_s = base::to_seconds(pendant_ ? kAskPendant : period());
  health.automatic = automatic_ > Duration{};
  return health;
}

Instant StatusPoller::next_deadline() const {
  return std::min(ask_at_, silent_at());
}

}  // namespace kerf::session
