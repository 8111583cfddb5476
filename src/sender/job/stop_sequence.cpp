#include "sender/job/stop_sequence.hpp"

#include <chrono>
#include <utility>

#include "sender/machine/rest.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// A hold that shows no effect is sent again: a byte can get lost.
constexpr Duration kHoldRepeat = 1s;
/// A machine that does not come to rest, or does not report, is reset all the same: the operator asked for a stop.
constexpr Duration kLongestStop = 60s;
constexpr Duration kLongestSilentStop = 5s;
/// Reset to welcome takes 10 ms, and 500 ms more behind an alarm (protocol.md 10.1).
constexpr Duration kWelcomeTimeout = 3s;

}  // namespace

void StopSequence::begin(Instant now, bool rests, Instant deaf_until) {
  stage_ = Stage::Braking;
  position_suspect_ = false;
  asked_at_ = reported_at_ = now;
  deaf_until_ = deaf_until;
  if (rests)
    reset(now);
  else
    order_hold(now);
}

void StopSequence::reset_now(Instant now) {
  reset(now);
}

void StopSequence::order_hold(Instant now) {
  orders_.push_back(StopOrder::FeedHold);
  deadline_ = now + kHoldRepeat;
}

void StopSequence::reset(Instant now) {
  stage_ = Stage::Resetting;
  orders_.push_back(StopOrder::SoftReset);
  deadline_ = now + kWelcomeTimeout;
}

void StopSequence::on_snapshot(Instant now, const machine::Snapshot& snapshot) {
  if (stage_ != Stage::Braking) return;
  reported_at_ = now;
  const bool idle_for_long = snapshot.state == MachineState::Idle && now - asked_at_ >= kHoldRepeat;
  const bool rests = machine::is_at_rest(snapshot) && now >= deaf_until_;
  // Only a reset ends a homing cycle.
  const bool homes = snapshot.state == MachineState::Home;
  if (homes) position_suspect_ = true;
  if (rests || idle_for_long || homes) reset(now);
}

void StopSequence::advance_to(Instant now) {
  if (now < deadline_) return;
  deadline_ = kNever;
  if (stage_ == Stage::Resetting) {
    stage_ = Stage::Unconfirmed;
    position_suspect_ = true;
  } else if (stage_ == Stage::Braking) {
    if (now - asked_at_ >= kLongestStop || now - reported_at_ >= kLongestSilentStop) {
      position_suspect_ = true;
      reset(now);
    } else {
      order_hold(now);
    }
  }
}

std::vector<StopOrder> StopSequence::take_orders() {
  return std::exchange(orders_, {});
}

}  // namespace kerf::job
