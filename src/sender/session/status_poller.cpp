#include "sender/session/status_poller.hpp"

#include <algorithm>
#include <chrono>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSilence = 3s;
/// A question without an answer is repeated, but not at the full pace: the answers may be queued up.
constexpr Duration kAskAgain = 1s;
/// Reports that come by themselves are trusted this long before Kerf asks after all.
constexpr Duration kUnaskedPatience = 2s;

}  // namespace

void StatusPoller::start(Instant now, Duration period) {
  period_ = period;
  ask_at_ = now;
  unanswered_since_.reset();
  silence_told_ = false;
}

void StatusPoller::stop() {
  ask_at_ = kNever;
  unanswered_since_.reset();
}

void StatusPoller::on_asked(Instant now) {
  ask_at_ = now + (unanswered_since_ ? kAskAgain : std::max(period_, kAskAgain));
  if (!unanswered_since_) unanswered_since_ = now;
}

bool StatusPoller::on_report(Instant now, bool comes_by_itself) {
  if (ask_at_ == kNever) return false;
  const Instant asked_at = unanswered_since_.value_or(now);
  unanswered_since_.reset();
  ask_at_ = comes_by_itself ? now + kUnaskedPatience : std::max(now, asked_at + period_);
  const bool ends_silence = silence_told_;
  silence_told_ = false;
  return ends_silence;
}

Instant StatusPoller::silent_at() const {
  return unanswered_since_ && !silence_told_ ? *unanswered_since_ + kSilence : kNever;
}

std::optional<double> StatusPoller::take_silence(Instant now) {
  if (now < silent_at()) return std::nullopt;
  silence_told_ = true;
  return base::to_seconds(now - *unanswered_since_);
}

Instant StatusPoller::next_deadline() const {
  return std::min(ask_at_, silent_at());
}

}  // namespace kerf::session
