#include "preparation/homing_wait.hpp"

#include <chrono>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"

namespace kerf::preparation {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// A large machine that seeks slowly takes minutes; a controller gives up by itself behind its travel.
constexpr Duration kLongestHoming = 15min;
/// grblHAL tells H: with one report in a few only.
constexpr Duration kUntilReported = 5s;

}  // namespace

void HomingWait::begin(Instant at, const machine::Snapshot& now) {
  *this = {};
  has_begun_ = true;
  begun_at_ = at;
  reports_before_ = now.reports;
}

void HomingWait::on_event(const session::Event& event) {
  if (!has_begun_) return;
  std::visit(base::Overloaded{
                 [this](const session::LineReceived& line) {
                   const bool is_ok = std::holds_alternative<protocol::Ok>(line.message);
                   if (is_ok && line.answers && line.answers->purpose == streaming::Purpose::Operator) {
                     is_answered_ = true;
                   }
                 },
                 [this](const session::LineRefused& refused) {
                   if (refused.purpose == streaming::Purpose::Operator) refusal_ = refused.explanation.headline;
                 },
                 [this](const session::ControllerRestarted&) { is_lost_ = true; },
                 [this](const session::LinesLost&) { is_lost_ = true; },
                 [](const auto&) {},
             },
             event);
}

HomingWait::Verdict HomingWait::fail(std::string sentence) {
  sentence_ = std::move(sentence);
  return Verdict::Failed;
}

HomingWait::Verdict HomingWait::look(Instant at, const machine::Snapshot& now) {
  if (!refusal_.empty()) return fail("The controller refused to home. " + refusal_);
  const bool is_new = now.reports != reports_before_;
  const bool is_over = is_answered_ || is_lost_;
  if (is_over && is_new && now.state == MachineState::Alarm) return fail("Homing ended in an alarm.");
  if (is_lost_) return fail("The controller restarted in the middle of homing.");
  if (at - begun_at_ >= kLongestHoming) return fail("Homing has not come to an end within 15 minutes.");
  if (!is_answered_ || !is_new || now.state != MachineState::Idle) {
    idle_since_ = kNever;
    return Verdict::Waiting;
  }
  if (now.homing.all.value_or(false)) return Verdict::Homed;
  if (idle_since_ == kNever) idle_since_ = at;
  if (at - idle_since_ < kUntilReported) return Verdict::Waiting;
  const std::string axes = now.homing.axes.value_or("");
  return fail(axes.empty() ? "The machine stands still behind homing, and does not say that it is homed."
                           : "Homing is over, but only " + axes + " of the axes " + (axes.size() == 1 ? "is" : "are") +
                                 " homed.");
}

}  // namespace kerf::preparation
