#pragma once
// A link to a machine, whatever it is made of. One URL scheme a file; the list of schemes is in transport.cpp.
//
// Threads: a transport belongs to its event loop's thread, and calls back on it.

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "sender/machine/link_opening.hpp"

namespace kerf::io {

enum class TransportFault {
  NotFound,  ///< no such port or path
  NoPermission,
  Busy,      ///< another program has the port
  NotAPort,  ///< the path is something else: a directory, a file, a disk
  BaudRefused,
  HostUnknown,
  Refused,        ///< nobody listens there
  NotAWebSocket,  ///< somebody answers there, and means something else
  Unreachable,
  TimedOut,
  Unplugged,  ///< a port that was open is gone
  ClosedByPeer,
  Failed,  ///< anything else; the system's own words say what
};

struct TransportError {
  TransportFault fault{};
  std::string system_text;  ///< the operating system's message, may be empty
};

/// What the owner of a link hears. Nothing is called inside open_transport(), nor after the transport is destroyed, nor
/// after `lost`.
struct LinkCallbacks {
  std::function<void()> opened;
  std::function<void(std::string_view bytes)> received;
  /// The link could not be opened, or was open and is gone.
  std::function<void(const TransportError&)> lost;
};

class Transport {
 public:
  Transport() = default;
  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// Realtime bytes: they go out before every line byte that the operating system does not have yet.
  virtual void write_realtime(std::string_view bytes) = 0;
  virtual void write_lines(std::string_view bytes) = 0;
  /// What was done to open it; said from `opened` on.
  [[nodiscard]] virtual machine::LinkOpening opening() const { return {}; }
};

/// Starts to open the link; the outcome comes by a callback. A TCP connection gives up after 5 s.
[[nodiscard]] std::unique_ptr<Transport> open_transport(EventLoop& loop, const MachineUrl& url,
                                                        LinkCallbacks callbacks);

/// One sentence for people: what happened, where, and what to do.
[[nodiscard]] std::string explain(const MachineUrl& url, const TransportError& error);

/// One opener a scheme.
[[nodiscard]] std::unique_ptr<Transport> open_serial(EventLoop& loop, const SerialAddress& address,
                                                     LinkCallbacks callbacks);
[[nodiscard]] std::unique_ptr<Transport> open_pty(EventLoop& loop, const PtyAddress& address, LinkCallbacks callbacks);
[[nodiscard]] std::unique_ptr<Transport> open_tcp(EventLoop& loop, const TcpAddress& address, LinkCallbacks callbacks);
[[nodiscard]] std::unique_ptr<Transport> open_websocket(EventLoop& loop, const WebSocketAddress& address,
                                                        LinkCallbacks callbacks);
[[nodiscard]] std::unique_ptr<Transport> open_virtual(EventLoop& loop, const VirtualAddress& address,
                                                      LinkCallbacks callbacks);

}  // namespace kerf::io
