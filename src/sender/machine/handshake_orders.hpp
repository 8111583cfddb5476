#pragma once
// What a handshake says: where it stands, why it moved on, and what it wants done (docs/handshake.md).

#include <cstdint>
#include <string>
#include <variant>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/vocabulary/machine_state.hpp"

namespace kerf::machine {

enum class HandshakeFailure {
  Silent,           ///< not a byte came
  NotGrbl,          ///< something else answers: another firmware, a modem
  Noise,            ///< bytes that mean nothing: another baud rate, a bad cable
  Bootloader,       ///< the controller waits for a firmware, or starts again and again without reaching one
  LinesUnanswered,  ///< reports come, but no line is answered
  Restarting,       ///< the controller restarts again and again
  LinkLost,         ///< closed before it was done
};
BOOST_DESCRIBE_ENUM(HandshakeFailure, Silent, NotGrbl, Noise, Bootloader, LinesUnanswered, Restarting, LinkLost)

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
  Failed,  ///< a welcome or a report that comes all the same begins again
};
BOOST_DESCRIBE_ENUM(HandshakeStage, Closed, Listening, Asking, PendantWait, BusyWait, ResetWait, Clearing, Questioning,
                    Ready, Failed)

/// Why it moved from one stage to the next.
enum class HandshakeCause {
  LinkOpened,
  LinkClosed,
  WelcomeCame,
  ReportCame,
  PendantTook,
  PendantReleased,
  MachineBusy,    ///< a report tells of something that Kerf did not start
  MachineAtRest,  ///< a report tells that lines may be sent
  LineAnswered,
  NothingCame,    ///< a time was over
  StrangerHeard,  ///< bytes that no Grbl sends
  ResetNeeded,    ///< Kerf resets of its own accord
  OperatorReset,
};
BOOST_DESCRIBE_ENUM(HandshakeCause, LinkOpened, LinkClosed, WelcomeCame, ReportCame, PendantTook, PendantReleased,
                    MachineBusy, MachineAtRest, LineAnswered, NothingCame, StrangerHeard, ResetNeeded, OperatorReset)

/// One step of the state machine. `evidence` is what it was seen from: the line that came, escaped and shortened, or
/// what did not come.
struct StageChange {
  Instant at{};
  HandshakeStage from{};
  HandshakeStage to{};
  HandshakeCause cause{};
  std::string evidence;
  bool operator==(const StageChange&) const = default;
};
BOOST_DESCRIBE_STRUCT(StageChange, (), (at, from, to, cause, evidence))

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
/// What firmware it is has been told; its enumerations come next.
struct Identified {
  std::string identity;
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
using HandshakeOrder = std::variant<StageChange, SendByte, AskLine, ForgetQuestions, Remark, ResetNotice, Identified,
                                    BusyNotice, Success, Failure>;

}  // namespace kerf::machine
