#pragma once
// From an open link to a controller that is known: asks before it resets, and never sends a line to a machine that is
// doing something (protocol.md 1.6). docs/handshake.md has the diagram and the sentence of each outcome.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/protocol/message.hpp"
#include "common/vocabulary/realtime.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/capability_collector.hpp"
#include "sender/machine/handshake_orders.hpp"
#include "sender/machine/handshake_sentences.hpp"
#include "sender/machine/interview.hpp"
#include "sender/machine/link_opening.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/machine/stranger.hpp"

namespace kerf::machine {

/// When may the handshake soft-reset a machine of its own accord?
enum class ResetPolicy {
  /// At rest in Idle, where the half line that an earlier sender may have left behind cannot be dropped otherwise; or
  /// in an alarm in which it reads no line. Nothing moves then.
  WhenAtRest,
  /// Also when nothing answers: it may be a machine in a hard-limit alarm, but also one that homes (protocol.md 3.2).
  WhenSilentToo,
  Never,
};
BOOST_DESCRIBE_ENUM(ResetPolicy, WhenAtRest, WhenSilentToo, Never)

struct HandshakeOptions {
  ResetPolicy reset_policy = ResetPolicy::WhenAtRest;
  /// Ask for the enumerations (`$EA` …) where the controller has them.
  bool enumerate = true;
  /// Of a serial port; empty where the rate means nothing.
  std::optional<int> baud{};
};

/// The state machine. Told of every byte, every message and of the snapshot after it; says what to do in `take_orders`.
class Handshake {
 public:
  explicit Handshake(HandshakeOptions options) : options_(options), interview_(options.enumerate) {}

  void on_open(Instant now, const LinkOpening& opening);
  void on_closed(Instant now);
  /// Before the messages that these bytes complete.
  void on_bytes(std::string_view bytes);
  void on_message(Instant now, const protocol::Message& message, std::string_view raw, const Snapshot& after);
  /// The answer to the question asked last; `error_code` 0 is ok.
  void on_answer(Instant now, int error_code);
  /// The operator has sent a soft reset.
  void on_operator_reset(Instant now);
  /// A welcome after Ready. With `asked`, only what a reset changes is asked for again.
  void restart(Instant now, bool asked);
  void advance_to(Instant now, const Snapshot& snapshot);

  [[nodiscard]] Instant next_deadline() const { return deadline_; }
  [[nodiscard]] HandshakeStage stage() const { return stage_; }
  [[nodiscard]] std::vector<HandshakeOrder> take_orders();
  [[nodiscard]] const Capabilities& capabilities() const { return capabilities_; }
  /// What this firmware said about itself at another time, which it is not asked for again; words of another firmware
  /// are passed over.
  void recall(const Words& words);
  /// Settings were listed again after Ready: what is told by capabilities() follows.
  void refresh();
  /// A setting was written by hand.
  void learn(const protocol::SettingValue& setting);
  [[nodiscard]] const CapabilityCollector& collector() const { return collector_; }

 private:
  struct Why {
    HandshakeCause cause{};
    std::string evidence{};
  };

  void enter(Instant now, HandshakeStage stage, Instant deadline, Why why);
  void send(vocabulary::Realtime byte);
  void ask_status(Instant now, Duration patience);

  void on_welcome(Instant now, const protocol::Welcome& welcome);
  void on_report(Instant now, const protocol::StatusReport& report, const Snapshot& after);
  void on_unrecognized(Instant now, std::string_view raw);
  void listen_after_welcome(Instant now, std::string_view line);
  void begin_asking(Instant now, Why why);
  void ask_again(Instant now);
  void judge(Instant now, const Snapshot& snapshot);
  void wait_for_pendant(Instant now, const Snapshot& snapshot);
  void wait_while_busy(Instant now, const Snapshot& snapshot);
  void empty_line_buffer(Instant now, const Snapshot& snapshot);
  void reset(Instant now, std::string reason);
  void clear(Instant now, std::string line, Why why);
  void send_line(Instant now, std::string line);
  /// Sends it at once if the machine is known to rest, else asks first.
  void ask_line(Instant now, std::string line);
  void ask_in_vain(Instant now);
  void begin_questions(Instant now);
  void ask_next(Instant now);
  void finish(Instant now, bool complete);
  void give_up(Instant now);
  void give_up_for_good(Instant now, const Verdict& verdict);
  void fail(Instant now, HandshakeFailure failure, std::string sentence, Why why);
  void time_out_clearing(Instant now, const Snapshot& snapshot);
  void time_out_question(Instant now);
  [[nodiscard]] bool is_under_way() const;
  [[nodiscard]] bool may_reset_at_rest() const { return options_.reset_policy != ResetPolicy::Never && !reset_done_; }

  HandshakeOptions options_;
  HandshakeStage stage_ = HandshakeStage::Closed;
  Instant deadline_ = kNever;
  std::vector<HandshakeOrder> orders_;
  CapabilityCollector collector_;
  Capabilities capabilities_;
  Interview interview_;
  Overheard overheard_;
  /// Realtime bytes sent since the link was opened, for comparison with an echo.
  std::string sent_;
  std::string last_line_;

  Instant asking_since_{};
  /// A plain report was asked for since the asking began: only those tell of a file that runs (protocol.md 9.3).
  bool plain_asked_ = false;
  /// A welcome came and nothing was sent since: no half line can be in the controller's buffer.
  bool fresh_ = false;
  bool reset_done_ = false;
  bool reported_ = false;
  bool quick_ = false;
  bool latch_clearing_ = false;
  /// The empty line was sent again: it can get lost.
  bool cleared_twice_ = false;
  /// The same for a question.
  bool question_repeated_ = false;
  bool identity_told_ = false;
  int restarts_ = 0;
  int boots_ = 0;
  /// It failed, and nothing that comes can change that.
  bool is_final_ = false;
  /// In an alarm in which no line is read; only the operator may reset it.
  bool deaf_in_alarm_ = false;
  /// What the machine was last seen doing that Kerf did not start.
  vocabulary::MachineState busy_told_ = vocabulary::MachineState::Unknown;
  /// A busy machine was seen at rest since then.
  std::optional<Instant> resting_since_;
  /// The last report that said that lines may be sent, or rather when it was asked for.
  std::optional<Instant> rest_known_at_;
  std::optional<Instant> asked_at_;
  /// Leaves as soon as a report says that the machine still rests.
  std::optional<std::string> waiting_line_;
  int asked_in_vain_ = 0;
  Snapshot last_;
};

}  // namespace kerf::machine
