#pragma once
// From an open link to a controller that is known: asks before it resets, and never sends a line to a machine that is
// doing something (protocol.md 1.6).

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/protocol/message.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/capability_collector.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

/// May the handshake soft-reset a machine that it found at rest?
enum class ResetPolicy {
  /// Idle machines are reset too, where the half line that an earlier sender may have left behind cannot be dropped
  /// otherwise:
  /// completing it could move the machine.
  WhenSilentOrIdle,
  WhenSilent,  ///< only when nothing answers
};
BOOST_DESCRIBE_ENUM(ResetPolicy, WhenSilentOrIdle, WhenSilent)

enum class HandshakeFailure {
  Silent,           ///< not a byte came
  NotGrbl,          ///< bytes came, none of them Grbl's
  LinesUnanswered,  ///< reports come, but no line is answered
  Restarting,       ///< the controller restarts again and again
  LinkLost,         ///< closed before it was done
};
BOOST_DESCRIBE_ENUM(HandshakeFailure, Silent, NotGrbl, LinesUnanswered, Restarting, LinkLost)

/// Where a handshake stands.
enum class HandshakeStage {
  Closed,
  Listening,    ///< something may come by itself: a welcome, reports
  Asking,       ///< 0x87 and `?` are out
  PendantWait,  ///< a pendant has the machine
  BusyWait,     ///< the machine does something that Kerf did not start
  ResetWait,    ///< a soft reset is out
  Clearing,     ///< one empty line is out
  Questioning,  ///< one question after the other
  Ready,
  Failed,
};
BOOST_DESCRIBE_ENUM(HandshakeStage, Closed, Listening, Asking, PendantWait, BusyWait, ResetWait, Clearing, Questioning,
                    Ready, Failed)

struct SendByte {
  std::uint8_t byte = 0;
};
/// A line of which the answer comes back through `on_answer`.
struct AskLine {
  std::string text;
};
/// No answers are expected any more for what was asked.
struct ForgetQuestions {};
/// Something to tell the operator.
struct Remark {
  std::string sentence;
};
/// A reset on the handshake's own account; the byte follows.
struct ResetNotice {
  std::string reason;
};
struct BusyNotice {
  vocabulary::MachineState state{};
  bool pendant = false;
  std::string sentence;
};
struct Success {
  std::string sentence;
};
struct Failure {
  HandshakeFailure failure{};
  std::string sentence;
};
using HandshakeOrder =
    std::variant<SendByte, AskLine, ForgetQuestions, Remark, ResetNotice, BusyNotice, Success, Failure>;

/// The state machine. Told of every message and of the snapshot after it; says what to do in `take_orders`.
class Handshake {
 public:
  Handshake(ResetPolicy policy, bool enumerate) : policy_(policy), enumerate_(enumerate) {}

  void on_open(Instant now);
  void on_closed();
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
  /// Settings were listed again after Ready: what is told by capabilities() follows.
  void refresh();
  /// A setting was written by hand.
  void learn(const protocol::SettingValue& setting);
  [[nodiscard]] const CapabilityCollector& collector() const { return collector_; }

 private:
  void enter(HandshakeStage stage, Instant deadline);
  void listen_after_welcome(Instant now);
  void begin_asking(Instant now);
  void ask_again(Instant now);
  void judge(Instant now, const Snapshot& snapshot);
  void judge_idle(Instant now);
  void wait_while_busy(Instant now, const Snapshot& snapshot);
  void reset(Instant now, std::string reason);
  void clear(Instant now);
  void begin_questions(Instant now);
  void ask_next(Instant now);
  [[nodiscard]] std::vector<std::string> questions() const;
  void finish(bool complete);
  void give_up_silent(Instant now);
  void fail(HandshakeFailure failure, std::string sentence);
  void time_out_clearing(Instant now, const Snapshot& snapshot);
  void time_out_question();

  ResetPolicy policy_;
  bool enumerate_;
  HandshakeStage stage_ = HandshakeStage::Closed;
  Instant deadline_ = kNever;
  Instant asking_since_{};
  std::vector<HandshakeOrder> orders_;
  CapabilityCollector collector_;
  Capabilities capabilities_;
  /// A welcome came and nothing was sent since: no half line can be in the controller's buffer.
  bool fresh_ = false;
  bool reset_done_ = false;
  bool reported_ = false;
  bool quick_ = false;
  bool latch_clearing_ = false;
  /// The empty line was sent again: it can get lost.
  bool cleared_twice_ = false;
  int restarts_ = 0;
  std::vector<std::string> asked_;
  std::string strange_line_;
  vocabulary::MachineState state_ = vocabulary::MachineState::Unknown;
  vocabulary::MachineState busy_told_ = vocabulary::MachineState::Unknown;
};

}  // namespace kerf::machine
