#pragma once
// The name of a machine: where it is and how it is reached.
//
//   url     := serial | tcp | ws | pty | virtual | shorthand
//   serial  := "serial://" PATH ["?baud=" N]           serial:///dev/ttyUSB0?baud=115200, serial://COM3
//   tcp     := "tcp://" HOST ":" PORT                  tcp://192.168.4.1:5001, tcp://[::1]:23
//   ws      := "ws://" HOST ":" PORT ["/" PATH] ["?protocol=" NAME|none]  ws://fluidnc.local:81/
//   pty     := "pty://" PATH                           pty:///tmp/kerf-grblhal
//   virtual := "virtual:" PERSONALITY ["?speed=" N|max]  virtual:grblhal?speed=max
//   shorthand: /dev/ttyUSB0 and COM3 are serial, other absolute paths are ptys, host:port is tcp, "virtual" is grblHAL.
//
// Percent escapes are not decoded: device paths and host names never need them, and a path copied from a shell stays as
// it is.

#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <variant>

#include "firmware/personality.hpp"
#include "io/speed.hpp"

namespace kerf::io {

struct SerialAddress {
  std::string path;
  int baud = 115200;
  bool operator==(const SerialAddress&) const = default;
};

/// `host` is a name or a numeric address, IPv6 without its brackets.
struct TcpAddress {
  std::string host;
  std::uint16_t port = 0;
  bool operator==(const TcpAddress&) const = default;
};

/// A WebSocket. Both grblHAL and FluidNC answer in binary frames to who offers the subprotocol "arduino", and FluidNC 4
/// turns others away; an empty `protocol` offers none.
struct WebSocketAddress {
  std::string host;
  std::uint16_t port = 0;
  std::string path = "/";
  std::string protocol = "arduino";
  bool operator==(const WebSocketAddress&) const = default;
};

struct PtyAddress {
  std::string path;
  bool operator==(const PtyAddress&) const = default;
};

/// A virtual controller inside this process.
struct VirtualAddress {
  const firmware::Personality* personality = &firmware::personality_of(vocabulary::Firmware::GrblHal);
  Speed speed;
  bool operator==(const VirtualAddress&) const = default;
};

using MachineUrl = std::variant<SerialAddress, TcpAddress, PtyAddress, VirtualAddress, WebSocketAddress>;

enum class UrlFault {
  Empty,
  UnknownScheme,
  NoHost,
  NoPort,
  NoWebSocketPort,
  BadPort,
  NoPath,
  RelativePath,
  BadBaud,
  UnknownPersonality,
  BadSpeed,
  BadProtocol,
  UnknownOption,
  NotAnAddress,
};

/// `part` is the piece of the text that is wrong, as it was typed.
struct UrlError {
  UrlFault fault{};
  std::string part;
  bool operator==(const UrlError&) const = default;
};

[[nodiscard]] std::expected<MachineUrl, UrlError> parse_machine_url(std::string_view text);

/// Where a virtual controller listens: `tcp://ADDRESS:PORT` or `ADDRESS:PORT`; port 0 lets the system choose one.
[[nodiscard]] std::expected<TcpAddress, UrlError> parse_listen_url(std::string_view text);

/// Where a virtual controller serves senders: as parse_listen_url(), or `ws://ADDRESS:PORT` for WebSockets.
struct ServeAddress {
  TcpAddress tcp;
  bool websocket = false;
  bool operator==(const ServeAddress&) const = default;
};
[[nodiscard]] std::expected<ServeAddress, UrlError> parse_serve_url(std::string_view text);

/// The personality with that key, in any case; never null.
[[nodiscard]] std::expected<const firmware::Personality*, UrlError> parse_personality(std::string_view text);

/// One sentence for people: what is wrong, and what to write instead.
[[nodiscard]] std::string explain(const UrlError& error);

/// "host:23", "[::1]:23"
[[nodiscard]] std::string host_and_port(const std::string& host, std::uint16_t port);

/// The full form, which parse_machine_url() reads back to the same value.
[[nodiscard]] std::string to_string(const MachineUrl& url);
[[nodiscard]] std::string to_string(const TcpAddress& address);
[[nodiscard]] std::string to_string(const ServeAddress& address);

}  // namespace kerf::io
