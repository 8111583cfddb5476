#pragma once
// Controllers that announce themselves on the local network (mDNS), as the Avahi daemon of this computer knows them.

#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"

namespace kerf::io {

/// One announced service. grblHAL announces `_telnet`, `_websocket` and `_http` with `model=grblHAL` (enet.c), FluidNC
/// `_telnet` and `_http` without any text.
struct Announcement {
  std::string service;  ///< "_telnet._tcp"
  std::string name;     ///< "Grbl", chosen by who announces
  std::string host;     ///< "grblhal.local"
  std::string address;  ///< "192.168.5.1"
  std::uint16_t port = 0;
  std::vector<std::string> texts;  ///< "model=grblHAL"
  bool operator==(const Announcement&) const = default;
};

struct NetworkMachine {
  std::string url;  ///< what `--machine` takes
  std::string host;
  std::string name;
  std::string firmware;  ///< empty if it does not say
};
BOOST_DESCRIBE_STRUCT(NetworkMachine, (), (url, host, name, firmware))

/// How the machines among them can be reached. A telnet or WebSocket service may be a machine; a web page is one only
/// if its name says so, and only if the host announces nothing better.
[[nodiscard]] std::vector<NetworkMachine> machines_among(std::span<const Announcement> announcements);

/// Why nobody was asked, in the library's words.
struct DiscoveryError {
  bool no_daemon = false;
  std::string text;
};
/// One sentence for people.
[[nodiscard]] std::string explain(const DiscoveryError& error);

/// Everything that is announced and known within `limit`, which it waits for unless the daemon has told all sooner. Any
/// thread.
[[nodiscard]] std::expected<std::vector<Announcement>, DiscoveryError> listen_to_announcements(Duration limit);

}  // namespace kerf::io
