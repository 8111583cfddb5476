#include "simulation/world.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <utility>
#include <variant>

#include "common/base/text.hpp"
#include "firmware/personality.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using session::SessionPhase;

constexpr Duration kConnectLimit = 60s;
/// A welcome waits in the controller behind what it says already, and lines on a slow wire.
constexpr Duration kProcessing = 60ms;

}  // namespace

WorldOptions serial_world(vocabulary::Firmware firmware, int baud) {
  WorldOptions options;
  options.firmware = firmware;
  options.wire.baud = baud;
  options.session.link.baud = baud;
  return options;
}

WorldOptions network_world(vocabulary::Firmware firmware, Duration latency) {
  WorldOptions options;
  options.firmware = firmware;
  options.wire.latency = latency;
  options.session.link.network = true;
  return options;
}

World::World(const WorldOptions& options)
    : options_(options),
      rig_(firmware::VirtualController(firmware::personality_of(options.firmware), options.stored, options.equipment)),
      session_(options.session),
      to_controller_(options.wire, WireGrain::Byte),
      from_controller_(options.wire, WireGrain::Line),
      wire_watch_(kProcessing + 2 * options.wire.latency) {
  rig_.power_on(now_);
  // Nobody listens yet: what a controller says before the link is open is lost.
  const Instant opened_at = now_ + options.head_start;
  while (rig_.next_deadline() <= opened_at) {
    now_ = std::max(now_, rig_.next_deadline());
    rig_.advance_to(now_);
  }
  now_ = opened_at;
  rig_.advance_to(now_);
  begin_wire_log();
}

void World::begin_wire_log() {
  if (!options_.keeps_wire_log) return;
  session::append_line(wire_log_,
                       {.at = now_, .what = session::LogHeader{.machine = "virtual", .options = options_.session}});
}

void World::open() {
  // What was said before nobody heard.
  static_cast<void>(rig_.take_outbox());
  linked_ = true;
  watch_.on_link_changed();
  wire_watch_.on_link_changed();
  session_.on_open(now_, {.sentence = {}, .may_restart = options_.opening_resets});
  if (options_.opening_resets) restart_controller();
  settle();
}

void World::restart_controller() {
  watch_.on_power_changed();
  rig_.submit(now_, firmware::Reboot{});
  settle();
}

void World::cut_link() {
  linked_ = false;
  watch_.on_link_changed();
  wire_watch_.on_link_changed();
  to_controller_.cut();
  from_controller_.cut();
  session_.on_closed(now_, session::LinkLoss::Unplugged);
  settle();
}

void World::kill_sender(Duration unwritten) {
  linked_ = false;
  watch_.on_link_changed();
  wire_watch_.on_link_changed();
  from_controller_.cut();
  session_ = session::RecordedSession(options_.session);
  journal_.lose_since(now_ - unwritten);
  if (options_.keeps_wire_log) earlier_wire_logs_.push_back(std::exchange(wire_log_, {}));
  begin_wire_log();
  settle();
}

void World::submit(const session::Command& command) {
  watch_.on_command(command);
  wire_watch_.on_command(command);
  session_.submit(now_, command);
  settle();
}

void World::touch(const firmware::WorkcellEvent& event) {
  rig_.submit(now_, event);
  settle();
}

bool World::order(std::string_view line) {
  const auto parsed = firmware::parse_script_line(line);
  if (!parsed || !*parsed) return false;
  rig_.submit(now_, **parsed, "test");
  settle();
  return true;
}

bool World::play(std::string_view script) {
  auto lines = firmware::parse_script(script);
  if (!lines) return false;
  rig_.play(now_, firmware::RigRecordKind::Script, "script", *std::move(lines));
  return true;
}

void World::inject_to_controller(std::string_view bytes) {
  watch_.on_stranger();
  rig_.on_bytes(now_, bytes);
  settle();
}

void World::inject_to_session(std::string_view bytes) {
  wire_watch_.on_received(now_, bytes);
  session_.on_bytes(now_, bytes);
  settle();
}

void World::touch_pendant(std::string_view bytes) {
  watch_.on_stranger();
  rig_.on_pendant_bytes(now_, bytes);
  settle();
}

void World::record(Direction direction, const std::string& bytes) {
  if (options_.keeps_transcript) transcript_.push_back({.at = now_, .direction = direction, .bytes = bytes});
}

void World::settle() {
  watch_.look(now_, rig_, session_.job() && !job::is_final(session_.job()->phase));
  auto out = session_.take_outbox();
  keep_records();
  journal_.append(std::move(out.journal));
  watch_.on_outbox(now_, out);
  wire_watch_.on_outbox(now_, out, session_.window_bytes());
  if (linked_) {
    to_controller_.send(now_, out.realtime);
    to_controller_.send(now_, out.lines);
  }
  events_.insert(events_.end(), std::make_move_iterator(out.events.begin()), std::make_move_iterator(out.events.end()));
  most_in_flight_ = std::max(most_in_flight_, session_.bytes_in_flight());
  const std::string said = rig_.take_outbox();
  if (linked_) from_controller_.send(now_, said);
  keep_log();
  follow_link();
}

void World::keep_records() {
  for (const session::Record& happened : session_.take_records()) {
    if (options_.keeps_wire_log) session::append_line(wire_log_, happened);
  }
}

void World::keep_log() {
  for (auto& record : rig_.take_records()) {
    // What a script does in somebody else's name.
    if (record.what.contains("inject to") || record.what.contains("start") || record.what.contains("pendant")) {
      watch_.on_stranger();
    }
    if (record.what.contains("reboot") || record.what.contains("power")) watch_.on_power_changed();
    log_.push_back(std::move(record));
  }
  static_cast<void>(rig_.take_lines_done());
}

void World::follow_link() {
  if (linked_ && rig_.link() == firmware::LinkState::Cut) cut_link();
}

void World::move_bytes() {
  if (const std::string bytes = to_controller_.take_arrived(now_); !bytes.empty()) {
    record(Direction::ToController, bytes);
    rig_.on_bytes(now_, bytes);
  }
  if (const std::string bytes = from_controller_.take_arrived(now_); !bytes.empty()) {
    record(Direction::FromController, bytes);
    wire_watch_.on_received(now_, bytes);
    session_.on_bytes(now_, bytes);
  }
}

Instant World::next_deadline() const {
  return std::min({session_.next_deadline(), rig_.next_deadline(), to_controller_.next_deadline(),
                   from_controller_.next_deadline()});
}

bool World::step(Instant limit) {
  const Instant next = next_deadline();
  if (next > limit) {
    // Not kNever, so that an endless wait does not end the clock.
    now_ = std::max(now_, limit);
    return false;
  }
  now_ = std::max(now_, next);
  rig_.advance_to(now_);
  move_bytes();
  if (session_.next_deadline() <= now_) session_.advance_to(now_);
  settle();
  return true;
}

void World::run_for(Duration time) {
  const Instant end = now_ + time;
  while (step(end)) {
  }
}

std::string World::transcript_text() const {
  std::string text;
  for (const auto& entry : transcript_) {
    base::append_fixed(text, base::to_seconds(entry.at), 6);
    text += entry.direction == Direction::ToController ? " > " : " < ";
    base::append_escaped(text, entry.bytes);
    text += '\n';
  }
  return text;
}

std::optional<job::JobState> run_job(World& world, std::shared_ptr<const job::Program> program, Duration limit,
                                     const session::JobOptions& options) {
  if (world.session().phase() == SessionPhase::Closed) world.open();
  const auto found_or_failed = [](const World& running) {
    const auto phase = running.session().phase();
    return phase == SessionPhase::Ready || phase == SessionPhase::Failed;
  };
  if (!world.run_until(found_or_failed, kConnectLimit) || world.session().phase() != SessionPhase::Ready) {
    return std::nullopt;
  }
  const std::size_t told = world.events().size();
  world.submit(session::StartJob{.program = std::move(program), .options = options});
  // Behind lines by hand it begins a little later.
  const auto begun_or_refused = [told](const World& running) {
    return std::any_of(running.events().begin() + static_cast<std::ptrdiff_t>(told), running.events().end(),
                       [](const session::Event& event) {
                         return std::holds_alternative<session::JobStarted>(event) ||
                                std::holds_alternative<session::CommandRefused>(event);
                       });
  };
  static_cast<void>(world.run_until(begun_or_refused, kConnectLimit));
  if (!world.session().job()) return std::nullopt;
  const auto over = [](const World& running) { return job::is_final(running.session().job()->phase); };
  static_cast<void>(world.run_until(over, limit));
  return world.session().job();
}

}  // namespace kerf::simulation
