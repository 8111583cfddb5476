#pragma once
// A conversation with one controller, from opening the link to closing it. Sans I/O: bytes, commands and the time go
// in, an outbox and the next deadline come out. The session is a switchboard; the parts it holds decide.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/job/job_state.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/command.hpp"
#include "sender/session/event.hpp"

namespace kerf::session {

/// May the handshake soft-reset a machine that it found at rest?
enum class ResetPolicy {
  WhenSilentOrIdle,  ///< Idle machines are reset too: half a line that an earlier sender left behind must not be
                     ///< completed
  WhenSilent,        ///< only when nothing answers
};
BOOST_DESCRIBE_ENUM(ResetPolicy, WhenSilentOrIdle, WhenSilent)

/// What the host knows about the link.
struct LinkTraits {
  /// Baud rate of a real serial line; empty where the rate means nothing (TCP, native USB, pty).
  std::optional<int> baud;
  /// Bytes wait behind each other in the network, so the window is small (protocol.md 11, rule 12).
  bool network = false;
};

struct SessionOptions {
  LinkTraits link;
  ResetPolicy reset_policy = ResetPolicy::WhenSilentOrIdle;
  /// Ask for the enumerations (`$EA` …) where the controller has them; `false` makes connecting faster.
  bool enumerate = true;
};

/// Why the link went away.
enum class LinkLoss { Closed, Unplugged, TimedOut, Error };
BOOST_DESCRIBE_ENUM(LinkLoss, Closed, Unplugged, TimedOut, Error)

/// Where the conversation stands.
enum class SessionPhase { Closed, Connecting, Waiting, Ready, Failed };
BOOST_DESCRIBE_ENUM(SessionPhase, Closed, Connecting, Waiting, Ready, Failed)

/// What has to leave the session. Realtime bytes must reach the wire before the lines.
struct Outbox {
  std::string realtime;
  std::string lines;
  std::vector<Event> events;
  [[nodiscard]] bool empty() const { return realtime.empty() && lines.empty() && events.empty(); }
};

/// One owner calls in, then empties the outbox. Not thread-safe. Never throws on anything that a wire or an operator
/// can do.
class Session {
 public:
  explicit Session(SessionOptions options = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  void on_open(Instant now);
  void on_bytes(Instant now, std::string_view bytes);
  void on_closed(Instant now, LinkLoss loss);
  void submit(Instant now, const Command& command);
  void advance_to(Instant now);
  /// When the session next needs `advance_to`; kNever when it only waits for bytes.
  [[nodiscard]] Instant next_deadline() const;
  [[nodiscard]] Outbox take_outbox();

  [[nodiscard]] SessionPhase phase() const;
  [[nodiscard]] const machine::Snapshot& snapshot() const;
  [[nodiscard]] const machine::Capabilities& capabilities() const;
  /// The job under way, or the last one; empty before the first.
  [[nodiscard]] const std::optional<job::JobState>& job() const;
  /// Bytes sent that the controller has not answered for, and the most that may be.
  [[nodiscard]] std::size_t bytes_in_flight() const;
  [[nodiscard]] std::size_t window_bytes() const;

 private:
  class Switchboard;
  std::unique_ptr<Switchboard> board_;
};

}  // namespace kerf::session
