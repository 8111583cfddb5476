#pragma once
// A virtual controller where it stands: with a power switch, a cable that may be bad, the machine around it, and
// scripts that play with all of them.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "firmware/byte_faults.hpp"
#include "firmware/script_player.hpp"
#include "firmware/virtual_controller.hpp"
#include "firmware/workcell.hpp"
#include "firmware/workcell_script.hpp"

namespace kerf::firmware {

/// Who or what an entry of the log is about.
enum class RigRecordKind : std::uint8_t {
  Script,  ///< a line of a script was carried out
  Order,   ///< a person's or a test's line was carried out
  Fault,   ///< bytes were hit
  Link,    ///< somebody connected or went away
  State,   ///< the machine's state changed
  InVain,  ///< a line asked for a part that this machine does not have
};
BOOST_DESCRIBE_ENUM(RigRecordKind, Script, Order, Fault, Link, State, InVain)

/// One entry of the log.
struct RigRecord {
  Instant at{};
  RigRecordKind kind{};
  std::string from;  ///< file and line of a script; who ordered it
  std::string what;
};
BOOST_DESCRIBE_STRUCT(RigRecord, (), (at, kind, from, what))

/// Has the shape of a VirtualController and stands in its place. Without orders it changes no byte and no instant.
class Rig {
 public:
  using PlayerId = std::uint32_t;

  /// A line of this player has been carried out.
  struct LineDone {
    PlayerId player{};
    std::size_t number = 0;
  };

  explicit Rig(VirtualController controller);

  void power_on(Instant now);
  void on_bytes(Instant now, std::string_view bytes);
  /// The pendant has a cable of its own, which no fault touches.
  void on_pendant_bytes(Instant now, std::string_view bytes);
  /// Does what the line says at once, whatever its timing; `from` is who wants it.
  void submit(Instant now, const ScriptLine& line, std::string_view from);
  /// Does it without an entry in the log.
  void submit(Instant now, const Deed& deed);
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const;
  /// What arrives at the sender's end, in order.
  [[nodiscard]] std::string take_outbox();
  [[nodiscard]] std::string take_pendant_outbox() { return controller_.take_pendant_outbox(); }

  /// A script begins; `name` stands in the log, with the number of each line if `kind` is Script.
  PlayerId play(Instant now, RigRecordKind kind, std::string name, std::vector<ScriptLine> lines);
  /// One more line for a script that plays.
  void add(Instant now, PlayerId player, ScriptLine line);
  /// What it has not done yet will not be done.
  void stop(PlayerId player) { players_.erase(player); }
  [[nodiscard]] std::vector<LineDone> take_lines_done();
  [[nodiscard]] std::vector<RigRecord> take_records();

  /// Bytes that may be given without loss; a link with back-pressure hands over no more than this.
  [[nodiscard]] std::size_t receive_room() const;
  [[nodiscard]] LinkState link() const { return link_; }
  [[nodiscard]] bool is_powered() const { return is_powered_; }
  /// The one that has power, or had it last.
  [[nodiscard]] const VirtualController& controller() const { return controller_; }
  [[nodiscard]] VirtualController& controller() { return controller_; }

 private:
  struct Player {
    RigRecordKind kind{};
    std::string name;
    ScriptPlayer script;
  };

  void carry_out(const Deed& deed);
  void note_missing_part(const Deed& deed);
  void hear_pendant(std::string_view bytes);
  void order(const OrderByteFault& order);
  void inject(const InjectBytes& injection);
  void set_link(LinkState state);
  void set_power(bool on);
  void step_to(Instant at);
  /// Carries bytes both ways as far as they come now.
  void move_bytes();
  void play_due_lines();
  [[nodiscard]] bool play_due_line(PlayerId id, Player& player);
  void note_state();
  void note_faults(ByteFaults& wire, std::string_view direction);
  /// Where advance_to() has to stop and look.
  [[nodiscard]] Instant next_stop() const;

  VirtualController controller_;
  bool is_powered_ = false;
  Instant now_{};
  Instant first_power_on_{};
  /// While the power is off.
  Workcell cell_;
  LinkState link_ = LinkState::Up;
  ByteFaults to_controller_{1};
  ByteFaults from_controller_{2};
  std::string arrived_;
  std::map<PlayerId, Player> players_;
  PlayerId last_player_ = 0;
  std::vector<LineDone> lines_done_;
  std::vector<RigRecord> records_;
  vocabulary::MachineState last_state_{};
  std::optional<int> last_substate_;
  bool last_powered_ = false;
};

}  // namespace kerf::firmware
