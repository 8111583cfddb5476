// `kerf serve`: machines, a web page and an API in one process.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/vocabulary/dialect.hpp"
#include "daemon/daemon.hpp"
#include "daemon/request_guard.hpp"
#include "io/state_folder.hpp"

namespace kerf::apps {
namespace {

/// What a fresh install offers: one virtual machine of each firmware.
std::vector<daemon::MachineRow> virtual_machines() {
  std::vector<daemon::MachineRow> machines;
  for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
    machines.push_back(
        {.name = fmt::format("Virtual {}", dialect->name), .url = fmt::format("virtual:{}", dialect->key)});
  }
  return machines;
}

/// What people would call it: "ttyUSB0", "Virtual grblHAL", "192.168.1.20:23".
std::string name_of(const std::string& url) {
  const auto address = io::parse_machine_url(url);
  if (!address) return url;
  if (const auto* inside = std::get_if<io::VirtualAddress>(&*address)) {
    return fmt::format("Virtual {}", inside->personality->dialect().name);
  }
  const std::string full = io::to_string(*address);
  const std::string place = full.substr(full.find("//") + 2);
  const bool is_path = place.starts_with('/');
  return place.substr(is_path ? place.rfind('/') + 1 : 0, place.find('?') - (is_path ? place.rfind('/') + 1 : 0));
}

constexpr Duration kFarewell = std::chrono::milliseconds(200);

/// Tells systemd that the loop turns, where it wants to know.
class Watchdog {
 public:
  explicit Watchdog(io::EventLoop& loop) : loop_(loop), timer_(loop) {
    std::uint64_t microseconds = 0;
    if (::sd_watchdog_enabled(0, &microseconds) <= 0) return;
    every_ = std::chrono::microseconds(microseconds / 2);
    beat();
  }

 private:
  void beat() {
    ::sd_notify(0, "WATCHDOG=1");
    timer_.arm(loop_.now() + every_, [this] { beat(); });
  }

  io::EventLoop& loop_;
  io::Timer timer_;
  Duration every_{};
};

}  // namespace

ExitStatus serve(const ServeOptions& options) {
  const auto address = io::parse_listen_url(options.listen);
  if (!address) {
    complain(io::explain(address.error()));
    return ExitStatus::Usage;
  }
  if (!daemon::is_loopback_host(address->host.contains(':') ? "[" + address->host + "]" : address->host)) {
    complain(
        fmt::format("'{}' can be reached from other computers, and everybody there could move the machine: listen "
                    "on 127.0.0.1, and let ssh carry it further (ssh -L 8080:127.0.0.1:8080 HOST).",
                    options.listen));
    return ExitStatus::Usage;
  }
  daemon::DaemonOptions wanted{.listen = *address,
                               .state_folder = options.state_folder.empty() ? io::state_folder() : options.state_folder,
                               .program = options.program,
                               .recording = options.recording};
  if (wanted.state_folder.empty()) {
    complain("There is no home folder to keep programs and jobs in: name one with --state.");
    return ExitStatus::Usage;
  }
  // Also for virtual machines: whoever tries a resume there learns how it works.
  wanted.recording.journal = {.keeps = true, .folder = wanted.state_folder};
  for (const std::string& url : options.machines) wanted.machines.push_back({.name = name_of(url), .url = url});
  if (wanted.machines.empty()) wanted.machines = virtual_machines();

  io::EventLoop loop;
  constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  std::unique_ptr<daemon::Daemon> daemon;
  io::Timer farewell(loop);
  // A job that nobody feeds would run dry in the middle of a cut: it is held, and the hold gets the time to go out.
  const io::SignalWatch signals(loop, kSignals, [&](int) {
    if (daemon == nullptr || !daemon->hold_jobs()) return loop.stop();
    farewell.arm(loop.now() + kFarewell, [&loop] { loop.stop(); });
  });
  auto begun = daemon::Daemon::begin(loop, wanted);
  if (!begun) {
    complain(begun.error());
    return ExitStatus::Usage;
  }
  daemon = *std::move(begun);
  const Watchdog watchdog(loop);
  put("Kerf serves {} machine{} at http://{}\n", daemon->machine_count(), daemon->machine_count() == 1 ? "" : "s",
      io::to_string(daemon->address()).substr(std::string_view("tcp://").size()));
  std::fflush(stdout);
  ::sd_notify(0, "READY=1");
  loop.run();
  ::sd_notify(0, "STOPPING=1");
  return ExitStatus::Done;
}

}  // namespace kerf::apps
