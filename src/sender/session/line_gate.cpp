#include "sender/session/line_gate.hpp"

#include <chrono>
#include <utility>

#include "sender/machine/rest.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// A question that gets lost is repeated after a second, and a report that comes by itself is a second old at most.
constexpr Duration kBlindAfter = 1500ms;

/// What was begun is over; a hold, an open door or a tool change only interrupts it.
bool is_over(MachineState state) {
  return state == MachineState::Idle || state == MachineState::Alarm || state == MachineState::Check ||
         state == MachineState::Sleep;
}

}  // namespace

void LineGate::open(Instant now) {
  *this = {};
  known_at_ = active_at_ = now;
}

void LineGate::on_asked(Instant now) {
  if (!asked_at_) asked_at_ = now;
}

void LineGate::on_activity(Instant now) {
  active_at_ = now;
  if (!moves_) is_own_ = true;
}

void LineGate::on_report(Instant now, const machine::Snapshot& snapshot, bool is_at_work) {
  known_at_ = std::exchange(asked_at_, std::nullopt).value_or(now);
  if (is_at_work) is_own_ = true;
  const bool moves =
      snapshot.state != MachineState::Unknown && snapshot.state != MachineState::Idle && !machine::is_at_rest(snapshot);
  if (is_over(snapshot.state) && !is_at_work && known_at_ > active_at_) is_own_ = false;
  if (moves && !moves_ && !is_own_) owes_notice_ = true;
  moves_ = moves;
}

GateVerdict LineGate::verdict(Instant now) const {
  if (sees_foreign_motion()) return GateVerdict::ForeignMotion;
  return now - known_at_ > kBlindAfter ? GateVerdict::Blind : GateVerdict::Open;
}

bool LineGate::take_notice() {
  return std::exchange(owes_notice_, false);
}

}  // namespace kerf::session
