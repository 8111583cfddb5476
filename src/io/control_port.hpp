#pragma once
// A socket on which tests and people press switches, pull cables and ask how things stand, one line each.
//
//   command := ["@" N] (script line | "state" | "position" | "time" | "help")
//   answer  := "ok" [value] | "error: …"
//
// Every command gets one line, in order. A line with a timing is answered when it is done, so `when state Hold` is how
// a test waits; what the connection sends meanwhile waits too. A connection that closes takes its unfinished line
// along.

#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/controller_host.hpp"
#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/server.hpp"

namespace kerf::io {

struct UnixAddress {
  std::string path;
  bool operator==(const UnixAddress&) const = default;
};
using ControlAddress = std::variant<UnixAddress, TcpAddress>;

/// `unix:/run/kerf.sock` or `tcp://127.0.0.1:5100`.
[[nodiscard]] std::expected<ControlAddress, UrlError> parse_control_address(std::string_view text);
[[nodiscard]] std::string to_string(const ControlAddress& address);

/// Serves any number of connections for the controllers of one process. Belongs to the loop's thread.
class ControlPort {
 public:
  /// `machines` are named @1, @2, … and outlive the port. Without a name the first one is meant.
  ControlPort(EventLoop& loop, std::vector<ControllerHost*> machines);
  ~ControlPort();
  ControlPort(const ControlPort&) = delete;
  ControlPort& operator=(const ControlPort&) = delete;

  /// The address with the real port, where 0 was asked for.
  [[nodiscard]] std::expected<ControlAddress, ListenError> listen(const ControlAddress& address);
  /// To be told by the machines' owner.
  void on_line_done(const ControllerHost& machine, const firmware::Rig::LineDone& done);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::io
