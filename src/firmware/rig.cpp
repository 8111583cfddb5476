#include "firmware/rig.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/protocol/secrets.hpp"

namespace kerf::firmware {
namespace {

constexpr std::array<std::string_view, kByteFaults> kFaultVerbs{"dropped", "doubled", "changed", "delayed"};

std::string status_word(const VirtualController& controller) {
  std::string word{name_of(controller.state())};
  if (const auto substate = controller.substate()) word += ":" + std::to_string(*substate);
  return word;
}

/// The part that the deed is about, if this machine does not have it.
std::string_view missing_part(const Deed& deed, const VirtualController& controller) {
  const Hardware& hardware = controller.personality().hardware;
  const auto* const event = std::get_if<WorkcellEvent>(&deed);
  const auto* const port = event == nullptr ? nullptr : std::get_if<PortInputChanged>(event);
  if (port != nullptr) {
    if (port->digital) return port->port < hardware.ports.digital_inputs ? "" : "such user input";
    return port->port < hardware.ports.analog_inputs ? "" : "such analog input";
  }
  const bool is_encoder = event != nullptr && std::holds_alternative<EncoderPlugged>(*event);
  if (is_encoder && !hardware.spindle_encoder) return "spindle encoder";
  const bool is_pendant = std::holds_alternative<PendantTakes>(deed) || std::holds_alternative<PendantSays>(deed);
  return is_pendant && !controller.equipment().pendant ? "pendant" : "";
}

}  // namespace

Rig::Rig(VirtualController controller) : controller_(std::move(controller)) {}

void Rig::power_on(Instant now) {
  now_ = first_power_on_ = now;
  is_powered_ = true;
  controller_.power_on(now);
  move_bytes();
  play_due_lines();
}

void Rig::on_bytes(Instant now, std::string_view bytes) {
  if (now > now_) advance_to(now);
  if (link_ != LinkState::Up || !is_powered_) return;
  to_controller_.send(now_, bytes);
  note_faults(to_controller_, "on the way to the controller");
  move_bytes();
  play_due_lines();
}

void Rig::on_pendant_bytes(Instant now, std::string_view bytes) {
  advance_to(now);
  hear_pendant(bytes);
  move_bytes();
  play_due_lines();
}

void Rig::submit(Instant now, const ScriptLine& line, std::string_view from) {
  advance_to(now);
  records_.push_back({.at = now_,
                      .kind = RigRecordKind::Order,
                      .from = std::string(from),
                      .what = protocol::Secrets{}.hidden(line.text)});
  if (line.deed) carry_out(*line.deed);
  play_due_lines();
}

void Rig::submit(Instant now, const Deed& deed) {
  advance_to(now);
  carry_out(deed);
  play_due_lines();
}

void Rig::note_missing_part(const Deed& deed) {
  const std::string_view part = missing_part(deed, controller_);
  if (part.empty()) return;
  records_.push_back(
      {.at = now_, .kind = RigRecordKind::InVain, .from = {}, .what = "there is no " + std::string(part)});
}

void Rig::hear_pendant(std::string_view bytes) {
  if (is_powered_) controller_.on_pendant_bytes(now_, bytes);
}

void Rig::carry_out(const Deed& deed) {
  note_missing_part(deed);
  std::visit(base::Overloaded{
                 [&](const WorkcellEvent& event) {
                   if (is_powered_) {
                     controller_.submit(now_, event);
                   } else {
                     cell_.apply(event);
                   }
                 },
                 [&](const PressButton& press) {
                   carry_out(WorkcellEvent{InputChanged{.input = press.input, .active = true}});
                   carry_out(WorkcellEvent{InputChanged{.input = press.input, .active = false}});
                 },
                 [&](const SetLink& link) { set_link(link.state); },
                 [&](const SetPower& power) { set_power(power.on); },
                 [&](const Reboot&) {
                   set_power(false);
                   set_power(true);
                 },
                 [&](const Stall& stall) {
                   if (is_powered_) controller_.stall(now_, stall.time);
                 },
                 [&](const OrderByteFault& fault) { order(fault); },
                 [&](const EndByteFaults&) {
                   to_controller_.end_orders();
                   from_controller_.end_orders();
                 },
                 [&](const SeedChance& chance) {
                   // Two wires must not be hit alike.
                   to_controller_.seed(chance.seed);
                   from_controller_.seed(~chance.seed);
                 },
                 [&](const InjectBytes& injection) { inject(injection); },
                 [&](const PendantTakes& takes) {
                   if (controller_.pendant_commands() != takes.command) hear_pendant("\x8b");
                 },
                 [&](const PendantSays& said) { hear_pendant(said.bytes); },
                 [](const WriteNote&) {},
             },
             deed);
  move_bytes();
}

void Rig::order(const OrderByteFault& order) {
  if (order.directions.to_controller) to_controller_.order(order.order);
  if (order.directions.from_controller) from_controller_.order(order.order);
}

void Rig::inject(const InjectBytes& injection) {
  if (injection.directions.to_controller && is_powered_) controller_.on_bytes(now_, injection.bytes);
  if (injection.directions.from_controller && link_ == LinkState::Up) arrived_ += injection.bytes;
}

void Rig::set_link(LinkState state) {
  link_ = state;
  if (state == LinkState::Up) return;
  to_controller_.cut();
  from_controller_.cut();
  arrived_.clear();
}

void Rig::set_power(bool on) {
  if (on == is_powered_) return;
  is_powered_ = on;
  if (on) {
    controller_ = VirtualController(controller_.personality(), controller_.stored(), controller_.equipment());
    controller_.set_workcell(cell_);
    controller_.power_on(now_);
  } else {
    cell_ = controller_.workcell();
    cell_.restart_count(controller_.motor_steps());
    to_controller_.cut();
  }
}

void Rig::advance_to(Instant now) {
  play_due_lines();
  for (;;) {
    const Instant next = next_stop();
    if (next > now) break;
    step_to(std::max(next, now_));
  }
  // Bytes that came at this very instant make the controller want another look at it.
  if (now > now_ || (is_powered_ && controller_.next_deadline() <= now)) step_to(std::max(now, now_));
}

void Rig::step_to(Instant at) {
  now_ = at;
  if (is_powered_) controller_.advance_to(at);
  move_bytes();
  play_due_lines();
}

void Rig::move_bytes() {
  if (const std::string bytes = to_controller_.take_arrived(now_); !bytes.empty() && is_powered_) {
    controller_.on_bytes(now_, bytes);
  }
  if (const std::string said = controller_.take_outbox(); !said.empty() && is_powered_ && link_ == LinkState::Up) {
    from_controller_.send(now_, said);
    note_faults(from_controller_, "on the way from the controller");
  }
  arrived_ += from_controller_.take_arrived(now_);
}

void Rig::play_due_lines() {
  note_state();
  bool anything = !players_.empty();
  while (anything) {
    anything = false;
    for (auto& [id, player] : players_) anything = play_due_line(id, player) || anything;
  }
}

bool Rig::play_due_line(PlayerId id, Player& player) {
  const auto line = player.script.take_due({.now = now_,
                                            .first_power_on = first_power_on_,
                                            .state = controller_.state(),
                                            .substate = controller_.substate(),
                                            .lines_begun = controller_.lines_begun()});
  if (!line) return false;
  const bool is_script = player.kind == RigRecordKind::Script;
  records_.push_back({.at = now_,
                      .kind = player.kind,
                      .from = is_script ? player.name + ":" + std::to_string(line->number) : player.name,
                      .what = protocol::Secrets{}.hidden(line->text)});
  if (line->deed) carry_out(*line->deed);
  lines_done_.push_back({.player = id, .number = line->number});
  note_state();
  return true;
}

void Rig::note_state() {
  const auto state = controller_.state();
  const auto substate = controller_.substate();
  if (state == last_state_ && substate == last_substate_ && is_powered_ == last_powered_) return;
  last_state_ = state;
  last_substate_ = substate;
  last_powered_ = is_powered_;
  records_.push_back({.at = now_,
                      .kind = RigRecordKind::State,
                      .from = {},
                      .what = is_powered_ ? status_word(controller_) : "no power"});
}

void Rig::note_faults(ByteFaults& wire, std::string_view direction) {
  const protocol::Secrets secrets;
  for (const ByteFaultRecord& record : wire.take_records()) {
    std::string what{kFaultVerbs.at(static_cast<std::size_t>(record.kind))};
    what += " byte " + std::to_string(record.first);
    if (record.bytes.size() > 1) what += " to " + std::to_string(record.first + record.bytes.size() - 1);
    what += " " + std::string(direction) + ": " + base::escape(secrets.hidden_part(record.line_before, record.bytes));
    if (!record.became.empty()) {
      what += " became " + base::escape(secrets.hidden_part(record.line_before, record.became));
    }
    records_.push_back({.at = record.at, .kind = RigRecordKind::Fault, .from = {}, .what = std::move(what)});
  }
}

Instant Rig::next_stop() const {
  Instant next = std::min(to_controller_.next_deadline(), from_controller_.next_deadline());
  bool looks_at_machine = false;
  for (const auto& [id, player] : players_) {
    next = std::min(next, player.script.next_deadline(first_power_on_));
    looks_at_machine = looks_at_machine || player.script.waits_for_machine();
  }
  if (looks_at_machine && is_powered_) next = std::min(next, controller_.next_deadline());
  return next;
}

Instant Rig::next_deadline() const {
  return is_powered_ ? std::min(next_stop(), controller_.next_deadline()) : next_stop();
}

std::string Rig::take_outbox() {
  move_bytes();
  return std::exchange(arrived_, {});
}

Rig::PlayerId Rig::play(Instant now, RigRecordKind kind, std::string name, std::vector<ScriptLine> lines) {
  const PlayerId id = ++last_player_;
  Player& player = players_[id];
  player.kind = kind;
  player.name = std::move(name);
  for (ScriptLine& line : lines) player.script.add(now, std::move(line));
  return id;
}

void Rig::add(Instant now, PlayerId player, ScriptLine line) {
  advance_to(now);
  players_.at(player).script.add(now_, std::move(line));
  play_due_lines();
}

std::vector<Rig::LineDone> Rig::take_lines_done() {
  return std::exchange(lines_done_, {});
}

std::vector<RigRecord> Rig::take_records() {
  return std::exchange(records_, {});
}

std::size_t Rig::receive_room() const {
  if (!is_powered_ || link_ != LinkState::Up) return std::numeric_limits<std::size_t>::max();
  const std::size_t room = controller_.receive_room();
  const std::size_t coming = to_controller_.bytes_on_the_way();
  return coming < room ? room - coming : 0;
}

}  // namespace kerf::firmware
