#include "firmware/virtual_controller.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "firmware/board.hpp"
#include "firmware/cycle.hpp"
#include "firmware/foreground.hpp"
#include "firmware/pendant.hpp"
#include "firmware/realtime.hpp"
#include "firmware/receiver.hpp"
#include "firmware/reporter.hpp"

namespace kerf::firmware {

/// The parts, wired together in the order in which they need each other.
namespace {

/// As grblHAL writes control inputs; 0 for inputs that are no buttons.
char letter_of(Input input) {
  switch (input) {
    case Input::FeedHold: return 'H';
    case Input::CycleStart: return 'S';
    case Input::Reset: return 'R';
    case Input::Door: return 'D';
    case Input::EmergencyStop: return 'E';
    default: return 0;
  }
}

}  // namespace

struct VirtualController::Parts {
  Parts(const Personality& personality, StoredState stored, Equipment equipment)
      : board(personality, std::move(stored), std::move(equipment)),
        receiver(personality),
        cycle(board),
        reporter(board),
        foreground(board, cycle, receiver, reporter),
        realtime(board, cycle, foreground, receiver, reporter),
        pendant(board, receiver, reporter, foreground) {}

  [[nodiscard]] Instant next_deadline() const {
    if (is_stalled()) return std::min(cycle.next_deadline(), stalled_until);
    return std::min(
        {cycle.next_deadline(), foreground.next_deadline(), pendant.next_deadline(), board.upload.next_deadline()});
  }

  /// Motion, then the main loop, at one instant.
  void live_at(Instant at) {
    board.now = at;
    cycle.advance();
    is_settled = true;
    if (is_stalled()) return;
    catch_up();
    foreground.look_at_switches();
    foreground.settle();
    pendant.advance();
    board.outbox.say_bytes(board.upload.advance(at));
    is_settled = true;
  }

  [[nodiscard]] bool is_stalled() const { return board.now < stalled_until; }

  /// One byte of the wire in command.
  void take(std::uint8_t byte) {
    if (is_stalled()) return receive_asleep(byte);
    if (board.slot.exists() && (board.upload.is_receiving() || YModem::begins(byte))) return take_upload(byte);
    if (receiver.full()) foreground.run();
    const auto fate = receiver.take(byte, foreground.line_context());
    if (fate == Receiver::Fate::Realtime) return act(byte);
    // `$39`=0 looks at the line that is being read, byte by byte.
    if (foreground.waiting_for() == WaitingFor::Nothing && (byte == '$' || byte == '(')) foreground.run();
  }

  /// While a file is uploaded, nothing else is heard on that wire (ymodem.c put_char).
  void take_upload(std::uint8_t byte) {
    if (!board.upload.is_receiving()) {
      board.upload.begin(board.now, board.slot.mounted ? board.slot.card : nullptr, board.slot.folder);
    }
    board.outbox.say_bytes(board.upload.take(board.now, byte));
    if (board.upload.take_purged()) receiver.cancel();
  }

  void act(std::uint8_t byte) {
    foreground.settle();
    if (board.pendant_commands && byte == static_cast<std::uint8_t>(vocabulary::Realtime::MpgModeToggle)) {
      pendant.give_back();
    } else {
      realtime.act(byte);
    }
    foreground.run();
  }

  void take_from_pendant(std::uint8_t byte) {
    if (board.pendant_commands) {
      take(byte);
    } else if (is_stalled()) {
      late_pendant_bytes += static_cast<char>(byte);
    } else if (!pendant.take_unasked(byte)) {
      act(byte);
    }
  }

  void happen(const WorkcellEvent& event) {
    foreground.settle();
    board.workcell.apply(event);
    board.follow_spindle();
    foreground.look_at_switches();
    if (const auto* change = std::get_if<InputChanged>(&event)) {
      if (change->active) press(change->input);
      if (change->input == Input::Door && !change->active) cycle.close_door();
    }
    foreground.run();
  }

  /// Only the receive interrupt is awake, and what a firmware answers from there.
  void receive_asleep(std::uint8_t byte) {
    if (receiver.take(byte, foreground.line_context()) != Receiver::Fate::Realtime) return;
    if (board.personality.status.at_once && byte == static_cast<std::uint8_t>(vocabulary::Realtime::StatusQuery)) {
      realtime.act(byte);
    } else {
      late_bytes += static_cast<char>(byte);
    }
  }

  /// What waited for the main loop.
  void catch_up() {
    if (late_bytes.empty() && late_pendant_bytes.empty() && late_events.empty()) return;
    for (const char byte : std::exchange(late_bytes, {})) act(static_cast<std::uint8_t>(byte));
    for (const char byte : std::exchange(late_pendant_bytes, {})) take_from_pendant(static_cast<std::uint8_t>(byte));
    for (const WorkcellEvent& event : std::exchange(late_events, {})) happen(event);
  }

  void press(Input input) {
    if (const char letter = letter_of(input); letter != 0) board.last_control = letter;
    switch (input) {
      case Input::FeedHold: cycle.feed_hold(); break;
      case Input::CycleStart:
        board.report.cycle_start_pressed = true;
        realtime.act(static_cast<std::uint8_t>('~'));
        break;
      case Input::Reset: realtime.reset(); break;
      case Input::Door: foreground.open_door_by_switch(); break;
      case Input::EmergencyStop: foreground.emergency_stop(); break;
      default: break;
    }
  }

  Board board;
  Receiver receiver;
  Cycle cycle;
  Reporter reporter;
  Foreground foreground;
  Realtime realtime;
  Pendant pendant;
  /// False while the main loop may still find something to do at `board.now`.
  bool is_settled = true;
  /// The main loop stands still until then; what it will find is kept.
  Instant stalled_until{Instant::min()};
  std::string late_bytes;
  std::string late_pendant_bytes;
  std::vector<WorkcellEvent> late_events;
};

VirtualController::VirtualController(const Personality& personality, StoredState stored, Equipment equipment)
    : parts_(std::make_unique<Parts>(personality, std::move(stored), std::move(equipment))) {}
VirtualController::~VirtualController() = default;
VirtualController::VirtualController(VirtualController&&) noexcept = default;
VirtualController& VirtualController::operator=(VirtualController&&) noexcept = default;

void VirtualController::power_on(Instant now) {
  parts_->board.now = now;
  parts_->foreground.power_on();
  parts_->is_settled = false;
}

void VirtualController::on_bytes(Instant now, std::string_view bytes) {
  if (now > parts_->board.now) advance_to(now);
  parts_->foreground.note_activity();
  for (const char byte : bytes) {
    if (!parts_->board.memory.hears(parts_->board.now)) continue;
    if (!parts_->board.pendant_commands) parts_->take(static_cast<std::uint8_t>(byte));
  }
  if (parts_->is_stalled()) return;
  parts_->foreground.run();
  parts_->is_settled = false;
}

void VirtualController::on_pendant_bytes(Instant now, std::string_view bytes) {
  if (!parts_->board.equipment.pendant) return;
  if (now > parts_->board.now) advance_to(now);
  for (const char byte : bytes) parts_->take_from_pendant(static_cast<std::uint8_t>(byte));
  if (parts_->is_stalled()) return;
  parts_->foreground.run();
  parts_->is_settled = false;
}

void VirtualController::submit(Instant now, const WorkcellEvent& event) {
  if (now > parts_->board.now) advance_to(now);
  if (parts_->is_stalled()) {
    parts_->late_events.push_back(event);
    return;
  }
  parts_->happen(event);
  parts_->is_settled = false;
}

void VirtualController::stall(Instant now, Duration time) {
  advance_to(now);
  parts_->stalled_until = std::max(parts_->stalled_until, parts_->board.now + time);
}

void VirtualController::advance_to(Instant now) {
  if (!parts_->is_settled) parts_->live_at(parts_->board.now);
  for (;;) {
    const Instant next = parts_->next_deadline();
    if (next > now || next == kNever) break;
    parts_->live_at(std::max(next, parts_->board.now));
  }
  if (now > parts_->board.now) parts_->live_at(now);
}

Instant VirtualController::next_deadline() const {
  return parts_->is_settled ? parts_->next_deadline() : parts_->board.now;
}

std::string VirtualController::take_outbox() {
  return parts_->board.outbox.take(Port::Main);
}

std::string VirtualController::take_pendant_outbox() {
  return parts_->board.outbox.take(Port::Pendant);
}

std::size_t VirtualController::receive_room() const {
  return parts_->receiver.free(Port::Main);
}

const StoredState& VirtualController::stored() const {
  return parts_->board.stored;
}

const Equipment& VirtualController::equipment() const {
  return parts_->board.equipment;
}

unsigned VirtualController::stored_revision() const {
  return parts_->board.stored_revision;
}

const std::vector<std::string>& VirtualController::rejected_settings() const {
  return parts_->board.rejected_settings;
}

const Personality& VirtualController::personality() const {
  return parts_->board.personality;
}

vocabulary::MachineState VirtualController::state() const {
  return parts_->board.state;
}

std::optional<int> VirtualController::substate() const {
  const Board& board = parts_->board;
  if (board.state != MachineState::Alarm) return substate_of(board);
  return board.alarm != 0 ? std::optional{board.alarm} : std::nullopt;
}

bool VirtualController::pendant_commands() const {
  return parts_->board.pendant_commands;
}

bool VirtualController::is_moving() const {
  using enum motion::ExecutorPhase;
  const auto phase = parts_->board.executor.phase();
  return phase == Running || phase == Decelerating || parts_->board.state == MachineState::Home;
}

bool VirtualController::is_rapid() const {
  const motion::StepBlock* block = parts_->board.executor.executing();
  return block != nullptr && block->rapid;
}

bool VirtualController::is_spindle_on() const {
  return parts_->board.accessories.is_spinning();
}

std::uint32_t VirtualController::lines_begun() const {
  return parts_->board.blocks_begun;
}

const Workcell& VirtualController::workcell() const {
  return parts_->board.workcell;
}

void VirtualController::set_workcell(const Workcell& workcell) {
  parts_->board.workcell = workcell;
}

vocabulary::AxisSteps VirtualController::motor_steps() const {
  return parts_->board.executor.motor_steps_at(parts_->board.now);
}

vocabulary::AxisSteps VirtualController::position_steps() const {
  return parts_->board.steps();
}

std::vector<double> VirtualController::position_mm() const {
  const Board& board = parts_->board;
  const vocabulary::AxisSteps steps = board.steps();
  std::vector<double> mm(static_cast<std::size_t>(board.settings.axes()));
  for (std::size_t axis = 0; axis < mm.size(); ++axis) {
    mm[axis] =
        static_cast<double>(steps.at(axis)) / static_cast<double>(board.planner.settings().steps_per_mm.at(axis));
  }
  return mm;
}

MotionLog& VirtualController::keep_motion_log() {
  parts_->board.lines_read = 0;
  return parts_->board.motion_log.emplace();
}

const MotionLog& VirtualController::motion_log() const {
  static const MotionLog empty;
  return parts_->board.motion_log ? *parts_->board.motion_log : empty;
}

}  // namespace kerf::firmware
