#include "io/discovery.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "io/machine_url.hpp"

namespace kerf::io {
namespace {

constexpr std::string_view kTelnet = "_telnet._tcp";
constexpr std::string_view kWebSocket = "_websocket._tcp";
constexpr std::string_view kHttp = "_http._tcp";

struct FirmwareWord {
  std::string_view word;  ///< in lower case
  std::string_view firmware;
};
constexpr std::array<FirmwareWord, 3> kFirmwareWords{
    {{"fluidnc", "FluidNC"}, {"grblhal", "grblHAL"}, {"rabbitgrbl", "Rabbit GRBL"}}};

std::string firmware_of(const Announcement& announcement) {
  std::string said = announcement.name + " " + announcement.host;
  for (const std::string& text : announcement.texts) said += " " + text;
  std::ranges::transform(said, said.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found =
      std::ranges::find_if(kFirmwareWords, [&](const FirmwareWord& row) { return said.contains(row.word); });
  return found == kFirmwareWords.end() ? std::string() : std::string(found->firmware);
}

std::optional<std::string> url_of(const Announcement& announcement, std::span<const Announcement> all) {
  if (announcement.service == kTelnet) {
    return to_string(TcpAddress{.host = announcement.address, .port = announcement.port});
  }
  WebSocketAddress page{.host = announcement.address, .port = announcement.port};
  if (announcement.service == kWebSocket) return to_string(MachineUrl(page));
  const auto is_better = [&](const Announcement& other) {
    return other.address == announcement.address && other.service != kHttp;
  };
  if (announcement.service != kHttp || firmware_of(announcement).empty()) return std::nullopt;
  if (std::ranges::any_of(all, is_better)) return std::nullopt;
  // FluidNC 3 and ESP3D serve the WebSocket one port above their page.
  ++page.port;
  return to_string(MachineUrl(page));
}

}  // namespace

std::vector<NetworkMachine> machines_among(std::span<const Announcement> announcements) {
  std::vector<NetworkMachine> machines;
  for (const Announcement& announcement : announcements) {
    auto url = url_of(announcement, announcements);
    const auto is_known = [&](const NetworkMachine& machine) { return machine.url == *url; };
    if (!url || std::ranges::any_of(machines, is_known)) continue;
    machines.push_back({.url = *std::move(url),
                        .host = announcement.host,
                        .name = announcement.name,
                        .firmware = firmware_of(announcement)});
  }
  std::ranges::sort(machines, {}, &NetworkMachine::url);
  return machines;
}

std::string explain(const DiscoveryError& error) {
  if (error.no_daemon) {
    return "Machines in the network cannot be found by name, because the Avahi daemon does not run here: "
           "'sudo apt-get install avahi-daemon' changes that.";
  }
  return fmt::format("Machines in the network cannot be found by name ({}): write their address instead.", error.text);
}

}  // namespace kerf::io
