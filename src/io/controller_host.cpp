#include "io/controller_host.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <utility>

namespace kerf::io {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// How long a peer on the same computer may take to answer an `ok` with the next line.
constexpr Duration kPeerPatience = 2ms;
/// A machine at rest jumps only this long after it heard something: a dwell or the pause after an alarm passes at once,
/// while periodic reports do not come a thousand times a second.
constexpr Duration kRestJumps = 250ms;
/// Real time that one loop turn may spend on jumps.
constexpr Duration kTurn = 1ms;

bool is_moving(MachineState state) {
  return state == MachineState::Run || state == MachineState::Jog || state == MachineState::Home;
}

}  // namespace

ControllerHost::ControllerHost(EventLoop& loop, firmware::VirtualController controller, Speed speed)
    : loop_(loop), rig_(std::move(controller)), speed_(speed), timer_(loop) {}

void ControllerHost::power_on() {
  real_began_ = loop_.now();
  last_input_ = real_began_;
  saved_revision_ = controller().stored_revision();
  rig_.power_on(virtual_now());
  settle();
}

void ControllerHost::receive(std::string_view bytes) {
  last_input_ = loop_.now();
  patient_until_ = last_input_;
  const Instant now = virtual_now();
  rig_.advance_to(now);
  rig_.on_bytes(now, bytes);
  settle();
}

void ControllerHost::receive_from_pendant(std::string_view bytes) {
  last_input_ = loop_.now();
  patient_until_ = last_input_;
  const Instant now = virtual_now();
  rig_.advance_to(now);
  rig_.on_pendant_bytes(now, bytes);
  settle();
}

Instant ControllerHost::virtual_now() const {
  const Duration real = loop_.now() - real_began_;
  return virtual_began_ + base::from_seconds(base::to_seconds(real) * speed_.factor.value_or(1.0));
}

Instant ControllerHost::real_time_of(Instant virtual_time) const {
  if (virtual_time == kNever) return kNever;
  // A deadline in a year is as good as one in a thousand years, and fits into a Duration at every speed.
  constexpr double kYearSeconds = 3.2e7;
  const double seconds = base::to_seconds(virtual_time - virtual_began_) / speed_.factor.value_or(1.0);
  return real_began_ + base::from_seconds(std::min(seconds, kYearSeconds));
}

bool ControllerHost::may_jump() const {
  if (!speed_.is_max() || rig_.next_deadline() == kNever) return false;
  return is_moving(controller().state()) || loop_.now() < last_input_ + kRestJumps;
}

void ControllerHost::jump() {
  const Instant turn_ends = loop_.now() + kTurn;
  bool has_said = false;
  while (!has_said && may_jump() && loop_.now() < turn_ends) {
    const Instant deadline = std::max(rig_.next_deadline(), virtual_now());
    rig_.advance_to(deadline);
    real_began_ = loop_.now();
    virtual_began_ = deadline;
    has_said = hand_over_output();
  }
}

bool ControllerHost::hand_over_output() {
  const std::string sent = rig_.take_outbox();
  const std::string to_pendant = rig_.take_pendant_outbox();
  if (sent.empty() && to_pendant.empty()) return false;
  patient_until_ = loop_.now() + kPeerPatience;
  if (output_ && !sent.empty()) output_(sent);
  if (pendant_output_ && !to_pendant.empty()) pendant_output_(to_pendant);
  return true;
}

void ControllerHost::on_timer() {
  rig_.advance_to(virtual_now());
  if (may_jump() && loop_.now() >= patient_until_) jump();
  settle();
}

std::size_t ControllerHost::network_room() const {
  constexpr auto kAny = std::numeric_limits<std::size_t>::max();
  return controller().personality().network_waits_for_room ? rig_.receive_room() : kAny;
}

firmware::Rig::PlayerId ControllerHost::play(firmware::RigRecordKind kind, std::string name,
                                             std::vector<firmware::ScriptLine> lines) {
  const auto player = rig_.play(virtual_now(), kind, std::move(name), std::move(lines));
  arm();
  return player;
}

void ControllerHost::add(firmware::Rig::PlayerId player, firmware::ScriptLine line) {
  rig_.add(virtual_now(), player, std::move(line));
  settle();
}

void ControllerHost::settle() {
  static_cast<void>(hand_over_output());
  if (controller().stored_revision() != saved_revision_) {
    saved_revision_ = controller().stored_revision();
    if (stored_) stored_(controller().stored());
  }
  tell_what_happened();
  arm();
}

void ControllerHost::tell_what_happened() {
  if (rig_.link() != told_link_) {
    told_link_ = rig_.link();
    if (link_) link_(told_link_);
  }
  for (const auto& record : rig_.take_records()) {
    if (record_) record_(record);
  }
  for (const auto& done : rig_.take_lines_done()) {
    if (line_done_) line_done_(done);
  }
  if (turn_) turn_();
}

void ControllerHost::arm() {
  Instant at = real_time_of(rig_.next_deadline());
  if (may_jump()) at = std::min(at, std::max(patient_until_, loop_.now()));
  timer_.arm(at, [this] { on_timer(); });
}

}  // namespace kerf::io
