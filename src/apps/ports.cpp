#include "io/ports.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/vocabulary/dialect.hpp"
#include "io/discovery.hpp"
#include "io/event_loop.hpp"
#include "io/json.hpp"
#include "io/port_watch.hpp"

namespace kerf::apps {

/// An address that somebody has to fill in, or a machine that is always there.
struct Candidate {
  std::string url;
  std::string description;
};
BOOST_DESCRIBE_STRUCT(Candidate, (), (url, description))

struct PortList {
  std::vector<io::SerialPort> serial;
  /// Machines that announce themselves; null if nobody listened.
  std::optional<std::vector<io::NetworkMachine>> announced;
  /// Why nothing was heard of them, as a sentence.
  std::optional<std::string> not_listening;
  std::vector<Candidate> network;
  std::vector<Candidate> virtual_machines;
};
BOOST_DESCRIBE_STRUCT(PortList, (), (serial, announced, not_listening, network, virtual_machines))

namespace {

using namespace std::chrono_literals;

/// What is on the network says so within a second.
constexpr Duration kListening = 1500ms;
constexpr Duration kListenEvery = 10s;

void listen(PortList& list) {
  const auto heard = io::listen_to_announcements(kListening);
  if (heard) {
    list.announced = io::machines_among(*heard);
  } else {
    list.not_listening = io::explain(heard.error());
  }
}

PortList find_ports(bool network) {
  PortList list;
  list.serial = io::list_serial_ports();
  if (network) listen(list);
  for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
    if (dialect->ports.telnet != 0) {
      list.network.push_back({.url = fmt::format("tcp://ADDRESS:{}", dialect->ports.telnet),
                              .description = fmt::format("{} on the network, at its usual port", dialect->name)});
    }
    if (dialect->ports.websocket != 0) {
      list.network.push_back({.url = fmt::format("ws://ADDRESS:{}", dialect->ports.websocket),
                              .description = fmt::format("{} by WebSocket, at its usual port", dialect->name)});
    }
    list.virtual_machines.push_back(
        {.url = fmt::format("virtual:{}", dialect->key), .description = fmt::format("{} inside Kerf", dialect->name)});
  }
  return list;
}

std::string description_of(const io::SerialPort& port) {
  std::string text = port.maker;
  if (!port.name.empty()) text += (text.empty() ? "" : " ") + port.name;
  if (text.empty()) text = port.vendor.empty() ? "built-in serial port" : "USB serial port";
  if (!port.vendor.empty()) text += fmt::format(" ({}:{})", port.vendor, port.product);
  if (!port.serial_number.empty()) text += ", serial number " + port.serial_number;
  return text;
}

std::string row(std::string_view url, std::string_view description) {
  return fmt::format("  {:<28} {}\n", url, description);
}

std::string description_of(const io::NetworkMachine& machine) {
  const std::string firmware = machine.firmware.empty() ? "a machine, perhaps" : machine.firmware;
  return fmt::format("{}: '{}' at {}", firmware, machine.name, machine.host);
}

std::string text_of(const PortList& list) {
  std::string text = "Serial ports\n";
  for (const io::SerialPort& port : list.serial) {
    text += row(port.path, description_of(port));
    if (!port.lasting_url.empty()) text += row("", "always " + port.lasting_url);
    if (!port.by_id.empty()) text += row("", "always " + port.by_id);
  }
  if (list.serial.empty()) text += "  none: plug the machine in, switch it on and look again\n";
  text += "\nNetwork\n";
  for (const io::NetworkMachine& machine : list.announced.value_or(std::vector<io::NetworkMachine>{})) {
    text += row(machine.url, description_of(machine));
  }
  if (list.announced && list.announced->empty()) text += "  none announces itself\n";
  if (list.not_listening) text += "  " + *list.not_listening + "\n";
  for (const Candidate& candidate : list.network) text += row(candidate.url, candidate.description);
  text += "\nVirtual machines, always there\n";
  for (const Candidate& candidate : list.virtual_machines) text += row(candidate.url, candidate.description);
  return text;
}

std::string print(const PortList& list, const PortsOptions& options) {
  if (options.json) return io::print(io::to_json(list), options.watch ? -1 : 2) + "\n";
  return text_of(list);
}

/// Prints the list whenever it has changed, until Ctrl-C.
class Watch {
 public:
  explicit Watch(const PortsOptions& options)
      : options_(options), ports_(loop_, [this] { look(); }), listen_again_(loop_) {}

  void run() {
    constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};
    const io::SignalWatch signals(loop_, kSignals, [this](int) { loop_.stop(); });
    look();
    loop_.run();
  }

 private:
  void look() {
    std::string now = print(find_ports(options_.network), options_);
    if (now != shown_) put("{}{}", shown_.empty() || options_.json ? "" : "\n", now);
    std::fflush(stdout);
    shown_ = std::move(now);
    // udev says when a serial port changes; nobody says when a machine leaves the network.
    if (options_.network) listen_again_.arm(loop_.now() + kListenEvery, [this] { look(); });
  }

  const PortsOptions& options_;
  io::EventLoop loop_;
  io::PortWatch ports_;
  io::Timer listen_again_;
  std::string shown_;
};

}  // namespace

ExitStatus list_ports(const PortsOptions& options) {
  if (options.watch) {
    Watch(options).run();
    return ExitStatus::Done;
  }
  put("{}", print(find_ports(options.network), options));
  if (!options.json) {
    put("\nAny of these is what --machine takes, for example: kerf info --machine virtual:grblhal\n");
  }
  return ExitStatus::Done;
}

}  // namespace kerf::apps
