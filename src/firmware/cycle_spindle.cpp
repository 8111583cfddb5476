// What the spindle has to do with motion: it is stopped in a hold, and motion begins with it (grblHAL with an encoder).

#include "firmware/cycle.hpp"

namespace kerf::firmware {

namespace {

constexpr std::chrono::seconds kPatience{5};

}  // namespace

// grblHAL/core state_machine.c: the second index starts a thread; a feed per turn wants a spindle that turns.
std::optional<Duration> Cycle::wait_for_index() const {
  constexpr int kIndexes = 2;
  const gcode::Feed& feed = board_.planner.current()->feed;
  if (!feed.synchronized) return Duration::zero();
  if (!feed.per_revolution) {
    const auto wait = board_.encoder.until_index(board_.now, kIndexes);
    return wait && *wait <= kPatience ? wait : std::nullopt;
  }
  return board_.encoder.rpm() > 0 ? std::optional{Duration::zero()} : std::nullopt;
}

void Cycle::miss_spindle() {
  const bool waits = !board_.planner.current()->feed.per_revolution;
  board_.state = MachineState::Run;
  spindle_missed_at_ = waits ? board_.now + kPatience : board_.now;
  if (waits) board_.locked_until = spindle_missed_at_;
}

bool Cycle::cuts_thread() const {
  const auto* block = board_.planner.current();
  return block != nullptr && block->feed.synchronized && !block->feed.per_revolution;
}

void Cycle::toggle_spindle_stop() {
  using gcode::SpindleDirection::Off;
  if (board_.state != MachineState::Hold || !board_.hold_complete || to_restore_.spindle == Off) return;
  Accessories wanted = board_.accessories;
  if (wanted.spindle != Off) {
    wanted.spindle = Off;
  } else {
    board_.say(vocabulary::FeedbackText::RestoringSpindle);
    wanted.spindle = to_restore_.spindle;
  }
  board_.set_accessories(wanted);
}

}  // namespace kerf::firmware
