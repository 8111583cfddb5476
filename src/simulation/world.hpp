#pragma once
// Both sides of the wire on one virtual clock.

#include <chrono>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "firmware/equipment.hpp"
#include "firmware/rig.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/virtual_controller.hpp"
#include "firmware/workcell.hpp"
#include "sender/session/recorded_session.hpp"
#include "sender/session/replay.hpp"
#include "simulation/line_watch.hpp"
#include "simulation/memory_journal.hpp"
#include "simulation/wire.hpp"
#include "simulation/wire_watch.hpp"

namespace kerf::simulation {

/// What stands in a world.
struct WorldOptions {
  vocabulary::Firmware firmware = vocabulary::Firmware::GrblHal;
  firmware::StoredState stored;
  firmware::Equipment equipment;
  WireTiming wire;
  session::SessionOptions session;
  /// Opening the port restarts the controller, as DTR does to an Uno.
  bool opening_resets = false;
  /// How long the controller is up before the link is opened.
  Duration head_start{};
  bool keeps_transcript = true;
  bool keeps_wire_log = true;
};

/// A serial line of `baud`, on both sides: the wire paces, the session caps its window.
[[nodiscard]] WorldOptions serial_world(vocabulary::Firmware firmware, int baud);
/// A network with `latency` one way.
[[nodiscard]] WorldOptions network_world(vocabulary::Firmware firmware, Duration latency);

enum class Direction : std::uint8_t { ToController, FromController };

/// Bytes as they arrived at the far end, and when.
struct TranscriptEntry {
  Instant at{};
  Direction direction{};
  std::string bytes;
  friend bool operator==(const TranscriptEntry&, const TranscriptEntry&) = default;
};

/// A session, a virtual controller in its rig, and two wires. Time jumps from one deadline to the next; the same inputs
/// at the same instants give the same bytes.
class World {
 public:
  explicit World(const WorldOptions& options);

  /// Opens the link; the handshake begins.
  void open();
  /// The link is gone, with everything on it.
  void cut_link();
  /// Kerf is killed, as by `kill -9`: what it had given to the wire still arrives, and what it told its journal less
  /// than `unwritten` ago is lost. The next open() is that of a new process.
  void kill_sender(Duration unwritten = std::chrono::milliseconds{50});
  void submit(const session::Command& command);
  void touch(const firmware::WorkcellEvent& event);
  /// The disk of the journal has no room, or has some again.
  void fill_disk(bool is_full) { journal_.fill_disk(is_full); }
  /// Does what a line of a script says, now: `drop to next 3`, `link cut`, `reboot`. False if it is none.
  [[nodiscard]] bool order(std::string_view line);
  /// Plays a script from now on. False if it is none.
  [[nodiscard]] bool play(std::string_view script);
  /// Bytes that somebody else sends to the controller: another sender, a boot loader, noise.
  void inject_to_controller(std::string_view bytes);
  /// Bytes that reach the session although the controller did not send them.
  void inject_to_session(std::string_view bytes);
  /// The controller loses power and comes back with what it had stored.
  void restart_controller();

  /// One deadline further; false when nothing will ever happen again or the next thing is later than `limit`.
  bool step(Instant limit);
  void run_for(Duration time);
  /// Runs until `done(*this)` holds; false when it did not within `limit`.
  template <std::predicate<const World&> Done>
  bool run_until(const Done& done, Duration limit) {
    const Instant end = now_ + limit;
    while (!done(*this)) {
      if (!step(end)) return done(*this);
    }
    return true;
  }

  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] const session::Session& session() const { return session_; }
  [[nodiscard]] const firmware::VirtualController& controller() const { return rig_.controller(); }
  /// What was ordered, what was hit, and what became of the machine.
  [[nodiscard]] const std::vector<firmware::RigRecord>& log() const { return log_; }
  /// Everything that the session told, in order.
  [[nodiscard]] const std::vector<session::Event>& events() const { return events_; }
  [[nodiscard]] const std::vector<TranscriptEntry>& transcript() const { return transcript_; }
  /// One line an entry: seconds, `>` or `<`, the bytes with escapes.
  [[nodiscard]] std::string transcript_text() const;
  /// The connection as a wire log has it: one record a line.
  [[nodiscard]] const std::string& wire_log() const { return wire_log_; }
  /// Those of the senders that were killed.
  [[nodiscard]] const std::vector<std::string>& earlier_wire_logs() const { return earlier_wire_logs_; }
  /// What stands in the journal.
  [[nodiscard]] const MemoryJournal& journal() const { return journal_; }
  /// Whether the sender kept its promise: no line to a machine in motion that it did not start.
  [[nodiscard]] const LineWatch& line_watch() const { return watch_; }
  /// The account of the wire by somebody who sees only its bytes.
  [[nodiscard]] const WireWatch& wire_watch() const { return wire_watch_; }
  /// Most bytes that were ever unanswered at once.
  [[nodiscard]] std::size_t most_bytes_in_flight() const { return most_in_flight_; }

 private:
  [[nodiscard]] Instant next_deadline() const;
  void settle();
  void move_bytes();
  void follow_link();
  void keep_log();
  void record(Direction direction, const std::string& bytes);
  void keep_records();
  void begin_wire_log();

  WorldOptions options_;
  Instant now_{};
  firmware::Rig rig_;
  session::RecordedSession session_;
  Wire to_controller_;
  Wire from_controller_;
  LineWatch watch_;
  WireWatch wire_watch_;
  bool linked_ = false;
  std::vector<session::Event> events_;
  std::vector<firmware::RigRecord> log_;
  std::vector<TranscriptEntry> transcript_;
  std::string wire_log_;
  std::vector<std::string> earlier_wire_logs_;
  MemoryJournal journal_;
  std::size_t most_in_flight_ = 0;
};

/// Connects unless connected, starts `program` and runs until the job is over or `limit` has passed. Empty when the
/// machine was never found or refused the job. Nobody is there to be asked, so a refused line stops it.
[[nodiscard]] std::optional<job::JobState> run_job(World& world, std::shared_ptr<const job::Program> program,
                                                   Duration limit,
                                                   const session::JobOptions& options = {
                                                       .on_error = job::ErrorPolicy::Stop});

}  // namespace kerf::simulation
