#include "io/transport.hpp"

#include <utility>

#include <fmt/format.h>

namespace kerf::io {
namespace {

/// The registered schemes: an opener for each kind of address.
struct Openers {
  EventLoop& loop;
  LinkCallbacks callbacks;

  std::unique_ptr<Transport> operator()(const SerialAddress& address) {
    return open_serial(loop, address, std::move(callbacks));
  }
  std::unique_ptr<Transport> operator()(const TcpAddress& address) {
    return open_tcp(loop, address, std::move(callbacks));
  }
  std::unique_ptr<Transport> operator()(const WebSocketAddress& address) {
    return open_websocket(loop, address, std::move(callbacks));
  }
  std::unique_ptr<Transport> operator()(const PtyAddress& address) {
    return open_pty(loop, address, std::move(callbacks));
  }
  std::unique_ptr<Transport> operator()(const VirtualAddress& address) {
    return open_virtual(loop, address, std::move(callbacks));
  }
};

/// "port /dev/ttyUSB0", "rabbit.local:5001", "/tmp/kerf-grblhal", "the virtual grblHAL"
std::string place_of(const MachineUrl& url) {
  struct Printer {
    std::string operator()(const SerialAddress& serial) const { return serial.path; }
    std::string operator()(const TcpAddress& tcp) const { return host_and_port(tcp.host, tcp.port); }
    std::string operator()(const WebSocketAddress& ws) const { return host_and_port(ws.host, ws.port); }
    std::string operator()(const PtyAddress& pty) const { return pty.path; }
    std::string operator()(const VirtualAddress& machine) const {
      return fmt::format("the virtual {}", name_of(machine.personality->firmware));
    }
  };
  return std::visit(Printer{}, url);
}

}  // namespace

std::unique_ptr<Transport> open_transport(EventLoop& loop, const MachineUrl& url, LinkCallbacks callbacks) {
  return std::visit(Openers{.loop = loop, .callbacks = std::move(callbacks)}, url);
}

std::string explain(const MachineUrl& url, const TransportError& error) {
  const std::string place = place_of(url);
  switch (error.fault) {
    case TransportFault::NotFound:
      return fmt::format(
          "There is no {}: plug the machine in and switch it on, then look for its name with 'kerf ports'.", place);
    case TransportFault::NoPermission:
      return fmt::format("You may not open {}: run 'sudo usermod -aG dialout $USER', log out and in again.", place);
    case TransportFault::Busy:
      return fmt::format("{} is in use by another program: close that program (or its tab), then try again.", place);
    case TransportFault::NotAPort:
      return fmt::format("{} is not a port that a machine could be on: look for the right name with 'kerf ports'.",
                         place);
    case TransportFault::BaudRefused:
      return fmt::format("{} cannot run at this baud rate: try 115200, which most controllers use.", place);
    case TransportFault::HostUnknown:
      return fmt::format("No computer called '{}' was found: check the name, or use the machine's IP address.",
                         place.substr(0, place.rfind(':')));
    case TransportFault::Refused:
      return fmt::format(
          "{} refused the connection: check the port number, and that the machine is on and not connected to another "
          "sender.",
          place);
    case TransportFault::NotAWebSocket:
      return fmt::format(
          "{} answers, but not as a WebSocket: check port and path, or try the machine's telnet port with tcp://.",
          place);
    case TransportFault::Unreachable:
      return fmt::format("There is no way through the network to {}: check cable, Wi-Fi and address.", place);
    case TransportFault::TimedOut:
      return fmt::format("{} does not answer: check that the machine is on and the address is right.", place);
    case TransportFault::Unplugged:
      return fmt::format(
          "There is nothing behind {} (any more): check the cable and the machine's power, then try again.", place);
    case TransportFault::ClosedByPeer:
      return fmt::format("{} closed the connection: is another sender connected, or did the machine restart?", place);
    case TransportFault::Failed: break;
  }
  return fmt::format("{} cannot be used ({}): check cable and power, then try again.", place, error.system_text);
}

}  // namespace kerf::io
