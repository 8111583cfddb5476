#include "io/machine_url.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace kerf::io {
namespace {

/// Rates that Linux can name stop at 4 Mbaud; USB bridges go a little further.
constexpr int kLeastBaud = 300;
constexpr int kMostBaud = 12'000'000;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::unexpected<UrlError> wrong(UrlFault fault, std::string_view part) {
  return std::unexpected(UrlError{.fault = fault, .part = std::string(part)});
}

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, value);
  if (fault != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// What stands before and behind the first `?`.
struct Parts {
  std::string_view address;
  std::string_view option_name;
  std::string_view option_value;
};

Parts split_option(std::string_view text) {
  const auto question = text.find('?');
  if (question == std::string_view::npos) return {.address = text, .option_name = {}, .option_value = {}};
  const std::string_view option = text.substr(question + 1);
  const auto equals = std::min(option.find('='), option.size());
  return {.address = text.substr(0, question),
          .option_name = option.substr(0, equals),
          .option_value = option.substr(std::min(equals + 1, option.size()))};
}

std::expected<MachineUrl, UrlError> parse_serial(std::string_view text) {
  const Parts parts = split_option(text);
  if (parts.address.empty()) return wrong(UrlFault::NoPath, "serial");
  SerialAddress serial{.path = std::string(parts.address)};
  if (parts.option_name.empty()) return serial;
  if (parts.option_name != "baud") return wrong(UrlFault::UnknownOption, parts.option_name);
  const auto baud = whole_number<int>(parts.option_value);
  if (!baud || *baud < kLeastBaud || *baud > kMostBaud) return wrong(UrlFault::BadBaud, parts.option_value);
  serial.baud = *baud;
  return serial;
}

std::expected<TcpAddress, UrlError> parse_host_port(std::string_view text) {
  std::string_view host = text;
  std::string_view port;
  if (text.starts_with('[')) {
    const auto bracket = text.find(']');
    if (bracket == std::string_view::npos) return wrong(UrlFault::NotAnAddress, text);
    host = text.substr(1, bracket - 1);
    const std::string_view rest = text.substr(bracket + 1);
    if (!rest.empty() && !rest.starts_with(':')) return wrong(UrlFault::NotAnAddress, text);
    port = rest.empty() ? rest : rest.substr(1);
  } else if (const auto colon = text.find(':'); colon != std::string_view::npos) {
    // An IPv6 address without brackets has several colons, and nobody can tell its end from the port.
    if (text.find(':', colon + 1) != std::string_view::npos) return wrong(UrlFault::NotAnAddress, text);
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
  }
  if (host.empty()) return wrong(UrlFault::NoHost, text);
  if (host.find_first_of(" \t/@") != std::string_view::npos) return wrong(UrlFault::NotAnAddress, text);
  if (port.empty()) return wrong(UrlFault::NoPort, host);
  const auto number = whole_number<std::uint16_t>(port);
  if (!number) return wrong(UrlFault::BadPort, port);
  return TcpAddress{.host = std::string(host), .port = *number};
}

std::expected<MachineUrl, UrlError> parse_tcp(std::string_view text) {
  const Parts parts = split_option(text);
  if (!parts.option_name.empty()) return wrong(UrlFault::UnknownOption, parts.option_name);
  std::string_view address = parts.address;
  if (address.ends_with('/')) address.remove_suffix(1);
  auto tcp = parse_host_port(address);
  if (!tcp) return std::unexpected(std::move(tcp.error()));
  if (tcp->port == 0) return wrong(UrlFault::BadPort, "0");
  return *std::move(tcp);
}

/// RFC 6455 takes any HTTP token; this is less, and enough for every name that was ever seen.
bool is_protocol_name(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '.' || c == '_';
  });
}

std::expected<MachineUrl, UrlError> parse_websocket(std::string_view text) {
  const Parts parts = split_option(text);
  const auto slash = std::min(parts.address.find('/'), parts.address.size());
  auto host = parse_host_port(parts.address.substr(0, slash));
  if (!host && host.error().fault == UrlFault::NoPort) return wrong(UrlFault::NoWebSocketPort, host.error().part);
  if (!host) return std::unexpected(std::move(host.error()));
  if (host->port == 0) return wrong(UrlFault::BadPort, "0");
  WebSocketAddress address{.host = std::move(host->host), .port = host->port};
  if (slash < parts.address.size()) address.path = parts.address.substr(slash);
  // The path goes into a line of HTTP.
  const auto is_visible = [](unsigned char c) { return c > ' ' && c < 0x7f; };
  if (!std::ranges::all_of(address.path, is_visible)) return wrong(UrlFault::NotAnAddress, text);
  if (parts.option_name.empty()) return address;
  if (parts.option_name != "protocol") return wrong(UrlFault::UnknownOption, parts.option_name);
  if (!is_protocol_name(parts.option_value)) return wrong(UrlFault::BadProtocol, parts.option_value);
  address.protocol = parts.option_value == "none" ? std::string_view{} : parts.option_value;
  return address;
}

std::expected<MachineUrl, UrlError> parse_pty(std::string_view text) {
  const Parts parts = split_option(text);
  if (!parts.option_name.empty()) return wrong(UrlFault::UnknownOption, parts.option_name);
  if (parts.address.empty()) return wrong(UrlFault::NoPath, "pty");
  if (!parts.address.starts_with('/')) return wrong(UrlFault::RelativePath, parts.address);
  return PtyAddress{.path = std::string(parts.address)};
}

std::expected<MachineUrl, UrlError> parse_virtual(std::string_view text) {
  const Parts parts = split_option(text);
  VirtualAddress machine;
  if (!parts.address.empty()) {
    auto personality = parse_personality(parts.address);
    if (!personality) return std::unexpected(std::move(personality.error()));
    machine.personality = *personality;
  }
  if (parts.option_name.empty()) return machine;
  if (parts.option_name != "speed") return wrong(UrlFault::UnknownOption, parts.option_name);
  const auto speed = parse_speed(parts.option_value);
  if (!speed) return wrong(UrlFault::BadSpeed, parts.option_value);
  machine.speed = *speed;
  return machine;
}

struct SchemeRow {
  std::string_view name;
  std::expected<MachineUrl, UrlError> (*parse)(std::string_view rest);
};

constexpr std::array<SchemeRow, 5> kSchemes{{{"serial", &parse_serial},
                                             {"tcp", &parse_tcp},
                                             {"ws", &parse_websocket},
                                             {"pty", &parse_pty},
                                             {"virtual", &parse_virtual}}};

/// COM1 … COM999, as Windows names serial ports.
bool is_com_port(std::string_view text) {
  return text.size() > 3 && text.size() <= 6 && lower(text.substr(0, 3)) == "com" &&
         text.find_first_not_of("0123456789", 3) == std::string_view::npos;
}

std::expected<MachineUrl, UrlError> parse_shorthand(std::string_view text) {
  const std::string_view name = split_option(text).address;
  if (name.starts_with("/dev/pts/")) return parse_pty(text);
  if (name.starts_with("/dev/") || is_com_port(name)) return parse_serial(text);
  if (name.starts_with('/')) return parse_pty(text);
  if (lower(name) == "virtual") return parse_virtual(text.substr(name.size()));
  return parse_tcp(text);
}

/// The scheme in front of `://` or of the first colon, if what follows is not a port number (`localhost:23` has no
/// scheme).
std::optional<std::string_view> scheme_of(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  const std::string_view name = text.substr(0, colon);
  if (text.substr(colon).starts_with("://")) return name;
  const auto known = [&](const SchemeRow& row) { return row.name == lower(name); };
  if (std::ranges::any_of(kSchemes, known) && !whole_number<int>(text.substr(colon + 1))) return name;
  return std::nullopt;
}

constexpr std::string_view kForms =
    "serial:///dev/ttyUSB0?baud=115200, tcp://HOST:PORT, ws://HOST:PORT, pty:///PATH or virtual:grblhal";

}  // namespace

std::expected<MachineUrl, UrlError> parse_machine_url(std::string_view text) {
  if (text.empty()) return wrong(UrlFault::Empty, text);
  const auto scheme = scheme_of(text);
  if (!scheme) return parse_shorthand(text);
  std::string_view rest = text.substr(scheme->size() + 1);
  if (rest.starts_with("//")) rest.remove_prefix(2);
  for (const SchemeRow& row : kSchemes) {
    if (row.name == lower(*scheme)) return row.parse(rest);
  }
  return wrong(UrlFault::UnknownScheme, *scheme);
}

std::expected<TcpAddress, UrlError> parse_listen_url(std::string_view text) {
  if (text.empty()) return wrong(UrlFault::Empty, text);
  constexpr std::string_view kPrefix = "tcp://";
  const auto colon = text.find("://");
  if (colon != std::string_view::npos && lower(text.substr(0, colon)) != "tcp") {
    return wrong(UrlFault::UnknownScheme, text.substr(0, colon));
  }
  if (colon != std::string_view::npos) text.remove_prefix(kPrefix.size());
  if (text.ends_with('/')) text.remove_suffix(1);
  return parse_host_port(text);
}

std::expected<ServeAddress, UrlError> parse_serve_url(std::string_view text) {
  constexpr std::string_view kPrefix = "ws://";
  const bool is_websocket = lower(text.substr(0, kPrefix.size())) == kPrefix;
  if (is_websocket) text.remove_prefix(kPrefix.size());
  auto tcp = parse_listen_url(text);
  if (!tcp) return std::unexpected(std::move(tcp.error()));
  return ServeAddress{.tcp = *std::move(tcp), .websocket = is_websocket};
}

std::expected<const firmware::Personality*, UrlError> parse_personality(std::string_view text) {
  if (const firmware::Personality* personality = firmware::personality_named(text)) return personality;
  return wrong(UrlFault::UnknownPersonality, text);
}

std::string explain(const UrlError& error) {
  const std::string& part = error.part;
  switch (error.fault) {
    case UrlFault::Empty: return fmt::format("The machine's address is empty: write {}.", kForms);
    case UrlFault::UnknownScheme: return fmt::format("'{}://' is no way to reach a machine: write {}.", part, kForms);
    case UrlFault::NoHost: return fmt::format("'{}' names no host: write tcp://HOST:PORT.", part);
    case UrlFault::NoPort:
      return fmt::format(
          "'{}' has no port: write {}:PORT (often 23 on grblHAL, 5001 on Rabbit GRBL), or a path such as /dev/ttyUSB0.",
          part, part);
    case UrlFault::NoWebSocketPort:
      return fmt::format("'{0}' has no port: write ws://{0}:PORT (often 81 on grblHAL; 80, 81 or 82 on FluidNC).",
                         part);
    case UrlFault::BadProtocol:
      return fmt::format("'{}' is no subprotocol's name: write ?protocol=arduino, or ?protocol=none.", part);
    case UrlFault::BadPort: return fmt::format("'{}' is no TCP port: use a number from 1 to 65535.", part);
    case UrlFault::NoPath: return fmt::format("'{0}://' names no port: write {0}:///PATH.", part);
    case UrlFault::RelativePath: return fmt::format("'{}' is not a full path: write pty:///tmp/NAME.", part);
    case UrlFault::BadBaud:
      return fmt::format("'{}' is no baud rate: use a number from {} to {}, usually 115200.", part, kLeastBaud,
                         kMostBaud);
    case UrlFault::UnknownPersonality:
      return fmt::format("There is no virtual machine '{}': choose {}.", part, firmware::personality_names());
    case UrlFault::BadSpeed:
      return fmt::format("'{}' is no speed: use max, or a factor from {} to {} (1 is real time).", part, kLeastSpeed,
                         kMostSpeed);
    case UrlFault::UnknownOption:
      return fmt::format(
          "'?{}' is no option of this address: serial has ?baud=N, ws has ?protocol=NAME, virtual has ?speed=N or "
          "?speed=max.",
          part);
    case UrlFault::NotAnAddress: return fmt::format("'{}' is no machine's address: write {}.", part, kForms);
  }
  return {};
}

std::string host_and_port(const std::string& host, std::uint16_t port) {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", is_ipv6 ? "[" : "", host, is_ipv6 ? "]" : "", port);
}

std::string to_string(const TcpAddress& address) {
  return "tcp://" + host_and_port(address.host, address.port);
}

std::string to_string(const ServeAddress& address) {
  if (!address.websocket) return to_string(address.tcp);
  return "ws://" + host_and_port(address.tcp.host, address.tcp.port);
}

std::string to_string(const MachineUrl& url) {
  struct Printer {
    std::string operator()(const SerialAddress& serial) const {
      return fmt::format("serial://{}?baud={}", serial.path, serial.baud);
    }
    std::string operator()(const TcpAddress& tcp) const { return to_string(tcp); }
    std::string operator()(const WebSocketAddress& ws) const {
      const std::string text = "ws://" + host_and_port(ws.host, ws.port) + ws.path;
      if (ws.protocol == WebSocketAddress{}.protocol) return text;
      return text + "?protocol=" + (ws.protocol.empty() ? "none" : ws.protocol);
    }
    std::string operator()(const PtyAddress& pty) const { return "pty://" + pty.path; }
    std::string operator()(const VirtualAddress& machine) const {
      return fmt::format("virtual:{}?speed={}", machine.personality->key(), to_string(machine.speed));
    }
  };
  return std::visit(Printer{}, url);
}
}  // namespace kerf::io
