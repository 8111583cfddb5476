#include "sender/session/state_refresh.hpp"

#include <algorithm>
#include <chrono>

#include "common/vocabulary/realtime.hpp"

namespace kerf::session {
namespace {

using vocabulary::MachineState;
using vocabulary::Realtime;

/// Whoever types or sends a file sends more lines; Kerf's questions wait until there is a pause.
constexpr Duration kQuiet = std::chrono::milliseconds{300};
constexpr Duration kAskAgain = std::chrono::seconds{2};
/// A controller that does not tell is not asked for ever.
constexpr int kMostAttempts = 3;

/// Lines are read and answered at once, and nothing moves (protocol.md 6.6, 6.7).
bool answers_questions(const machine::Snapshot& snapshot) {
  if (snapshot.reset_required || !snapshot.controller_file.empty()) return false;
  return snapshot.state == MachineState::Idle || snapshot.state == MachineState::Check ||
         snapshot.state == MachineState::Alarm;
}

}  // namespace

void StateRefresh::on_change(Instant now) {
  changed_at_ = now;
  attempts_ = 0;
  // take_orders() sets it anew when the time has come.
  ask_at_ = kNever;
}

void StateRefresh::forget() {
  *this = {};
}

std::vector<RefreshOrder> StateRefresh::take_orders(Instant now, const RefreshSituation& situation) {
  std::vector<RefreshOrder> orders;
  const machine::Snapshot& snapshot = situation.snapshot;
  if (!situation.is_connected) {
    ask_at_ = kNever;
    return orders;
  }
  if (full_report_) {
    full_report_ = false;
    if (situation.dialect.answers_full_status) orders.push_back(RefreshOrder::FullReport);
  }
  const bool is_old = snapshot.parser_state_is_old || snapshot.offsets_are_old;
  if (!is_old || attempts_ >= kMostAttempts || !situation.is_quiet || !answers_questions(snapshot)) {
    ask_at_ = kNever;
    return orders;
  }
  if (ask_at_ == kNever) ask_at_ = std::max(now, changed_at_ + kQuiet);
  if (now < ask_at_) return orders;
  ask_at_ = now + kAskAgain;
  ++attempts_;
  if (snapshot.parser_state_is_old) {
    const bool by_byte = attempts_ == 1 && acts_on(situation.dialect.firmware, Realtime::ParserReport);
    orders.push_back(by_byte ? RefreshOrder::ParserReport : RefreshOrder::AskParser);
  }
  if (snapshot.offsets_are_old) orders.push_back(RefreshOrder::AskOffsets);
  return orders;
}

}  // namespace kerf::session
