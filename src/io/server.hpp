#pragma once
// The two ways in which a virtual controller can be reached from outside. Threads: the event loop's only.

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "io/event_loop.hpp"
#include "io/machine_url.hpp"

namespace kerf::io {

enum class ListenFault { AddressUnknown, AddressInUse, NoPermission, PathTaken, PathRefused, Failed };

struct ListenError {
  ListenFault fault{};
  std::string system_text;
};

/// One sentence for people; `place` is the address or the path.
[[nodiscard]] std::string explain(const ListenError& error, std::string_view place);

/// A TCP port, for raw bytes or WebSockets, for one client at a time, as a controller has one input buffer. While one
/// is connected, another is turned away at once: two senders would mix their lines, and the second must not ruin the
/// first one's job (protocol.md 1.3).
class TcpServer {
 public:
  struct Callbacks {
    std::function<void(std::string_view bytes)> received;
    std::function<void(std::string_view peer)> connected;
    std::function<void(std::string_view peer)> disconnected;
    std::function<void(std::string_view peer)> turned_away;
    /// Bytes that the controller takes now; what does not fit waits in the network.
    std::function<std::size_t()> room;
  };

  TcpServer(EventLoop& loop, Callbacks callbacks);
  ~TcpServer();

  /// The address with the real port, where 0 was asked for.
  [[nodiscard]] std::expected<ServeAddress, ListenError> listen(const ServeAddress& address);
  /// Without a client the bytes are gone, as they would be on a wire that ends nowhere.
  void write(std::string_view bytes);
  /// There may be room again.
  void go_on();
  /// While the cable is out nobody gets in, and who was in is out.
  void set_cable(bool connected);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// A pseudo-terminal with a name of its own, for programs that know only serial ports. Nobody can see whether it is in
/// use.
class PtyServer {
 public:
  PtyServer(EventLoop& loop, std::function<void(std::string_view bytes)> received);
  ~PtyServer();

  /// Makes `path` a link to the terminal's device, in place of a link that an earlier run left. The link goes with the
  /// server.
  [[nodiscard]] std::expected<void, ListenError> open(const std::string& path);
  /// Bytes that nobody reads are kept up to a limit, then dropped.
  void write(std::string_view bytes);
  /// While the cable is out there is no terminal: who has it open reads its end, as of a USB port that is pulled.
  [[nodiscard]] std::expected<void, ListenError> set_cable(bool connected);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::io
