#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "apps/virtual_hardware.hpp"
#include "apps/virtual_machine.hpp"
#include "firmware/personality.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/virtual_controller.hpp"
#include "firmware/workcell_script.hpp"
#include "io/control_port.hpp"
#include "io/controller_host.hpp"
#include "io/machine_url.hpp"
#include "io/text_file.hpp"

namespace kerf::apps {
namespace {

using firmware::StoredState;

/// A complaint that has been said; what is left is to end.
struct Complained {};

template <typename T>
using OrComplained = std::expected<T, Complained>;

std::unexpected<Complained> said(const std::string& sentence) {
  complain(sentence);
  return std::unexpected(Complained{});
}

std::string explain(const firmware::StoredStateError& error, const std::string& file) {
  using Reason = firmware::StoredStateError::Reason;
  std::string what;
  switch (error.reason) {
    case Reason::NotAState:
      what = "this is no state of a virtual controller; name another file, or delete this one";
      break;
    case Reason::NotASetting: what = "this is no setting; write one '$n=value' a line, such as '$110=500'"; break;
    case Reason::UnknownLine: what = "this line is none of a state file; delete it"; break;
    case Reason::BadNumber: what = "a number is malformed; write it like 12.5"; break;
  }
  return fmt::format("{}, line {}: {}.", file, error.line, what);
}

OrComplained<StoredState> stored_state_for(const VirtualOptions& options, const std::string& state_file) {
  StoredState state;
  if (!state_file.empty()) {
    const auto text = io::read_text_file(state_file);
    if (!text && text.error().fault != io::FileFault::NotFound) return said(io::explain(text.error(), state_file));
    if (text) {
      auto parsed = firmware::parse_stored_state(*text);
      if (!parsed) return said(explain(parsed.error(), state_file));
      state = *std::move(parsed);
    }
  }
  if (!options.settings_file.empty()) {
    const auto text = io::read_text_file(options.settings_file);
    if (!text) return said(io::explain(text.error(), options.settings_file));
    const auto applied = firmware::apply_settings_text(state, *text);
    if (!applied) return said(explain(applied.error(), options.settings_file));
  }
  return state;
}

std::string pace_text(const io::Speed& speed) {
  if (speed.is_max()) return "as fast as it can";
  return *speed.factor == 1.0 ? "in real time" : fmt::format("{} times as fast as a real one", *speed.factor);
}

/// The scripts of the command line, each under its file's name.
struct NamedScript {
  std::string name;
  std::vector<firmware::ScriptLine> lines;
};

OrComplained<std::vector<NamedScript>> scripts_of(const VirtualOptions& options) {
  std::vector<NamedScript> scripts;
  for (const std::string& file : options.scripts) {
    const auto text = io::read_text_file(file);
    if (!text) return said(io::explain(text.error(), file));
    auto lines = firmware::parse_script(*text);
    if (!lines) {
      return said(fmt::format("{}:{}: {}.", file, lines.error().line, firmware::explain(lines.error())));
    }
    scripts.push_back({.name = file, .lines = *std::move(lines)});
  }
  return scripts;
}

/// `path` of one machine of many: it gets the machine's number.
std::string numbered(const std::string& path, std::size_t number, bool is_one_of_many) {
  return path.empty() || !is_one_of_many ? path : fmt::format("{}-{}", path, number);
}

/// Where each machine serves.
OrComplained<std::vector<MachineSetup>> setups_of(const VirtualOptions& options, io::Speed speed) {
  const std::size_t machines = std::max({options.count, options.listen.size(), options.ptys.size()});
  const bool is_many = machines > 1;
  if (options.listen.empty() && options.ptys.empty()) {
    return said("Say where to serve: --listen tcp://127.0.0.1:5001, or --pty /tmp/kerf-grblhal, or both.");
  }
  if (is_many && !options.pendant.empty() && options.pendant != kPendantOfScripts) {
    return said("One pendant cannot serve several machines: leave --pendant out, or --count.");
  }
  for (const auto& [option, given] : {std::pair{"--listen", options.listen.size()}, {"--pty", options.ptys.size()}}) {
    if (given > 1 && given < machines) {
      return said(fmt::format("{} is given {} times for {} machines: give it once, or once for each machine.", option,
                              given, machines));
    }
  }
  std::vector<MachineSetup> setups;
  for (std::size_t index = 0; index < machines; ++index) {
    MachineSetup setup{.number = index + 1,
                       .label = is_many ? fmt::format("@{}: ", index + 1) : std::string{},
                       .speed = speed,
                       .address = std::nullopt,
                       .pty = {},
                       .pendant = options.pendant == kPendantOfScripts ? std::string{} : options.pendant,
                       .greets = options.welcome_on_connect,
                       .state_file = numbered(options.state_file, index + 1, is_many)};
    if (!options.listen.empty()) {
      auto address = io::parse_serve_url(options.listen[std::min(index, options.listen.size() - 1)]);
      if (!address) return said(io::explain(address.error()));
      const bool counts = options.listen.size() == 1 && address->tcp.port != 0;
      const std::size_t port = address->tcp.port + (counts ? index : 0);
      if (port > std::numeric_limits<std::uint16_t>::max()) {
        return said(fmt::format("{} machines from port {} on need ports beyond 65535: begin lower, or use port 0.",
                                machines, address->tcp.port));
      }
      address->tcp.port = static_cast<std::uint16_t>(port);
      setup.address = *std::move(address);
    }
    if (!options.ptys.empty()) {
      setup.pty = options.ptys.size() == 1 ? numbered(options.ptys.front(), index + 1, is_many) : options.ptys[index];
    }
    setups.push_back(std::move(setup));
  }
  return setups;
}

OrComplained<firmware::VirtualController> controller_for(const VirtualOptions& options,
                                                         const firmware::Personality& personality,
                                                         const std::string& state_file) {
  auto state = stored_state_for(options, state_file);
  if (!state) return std::unexpected(state.error());
  auto equipment = equipment_of(options, personality);
  if (!equipment) return said(equipment.error());
  firmware::VirtualController controller(personality, *std::move(state), *std::move(equipment));
  const auto& rejected = controller.rejected_settings();
  if (rejected.empty()) return controller;
  return said(fmt::format("{} refuses the setting{} ${}: correct {} or leave {} out.", personality.dialect().name,
                          rejected.size() == 1 ? "" : "s", fmt::join(rejected, ", $"),
                          rejected.size() == 1 ? "its value" : "their values", rejected.size() == 1 ? "it" : "them"));
}

/// All machines of one process, on one event loop.
class Fleet {
 public:
  explicit Fleet(EventLog& log) : log_(log) {}

  /// False when that has been complained about.
  bool add(firmware::VirtualController controller, const MachineSetup& setup) {
    machines_.push_back(std::make_unique<VirtualMachine>(loop_, std::move(controller), setup, log_));
    auto places = machines_.back()->open();
    if (!places) {
      complain(places.error());
      return false;
    }
    places_.push_back(*std::move(places));
    return true;
  }

  bool open_control(const io::ControlAddress& address) {
    std::vector<io::ControllerHost*> hosts;
    for (const auto& machine : machines_) hosts.push_back(&machine->host());
    control_ = std::make_unique<io::ControlPort>(loop_, hosts);
    const auto listening = control_->listen(address);
    if (!listening) {
      complain(io::explain(listening.error(), io::to_string(address)));
      return false;
    }
    for (io::ControllerHost* host : hosts) {
      host->on_line_done([this, host](const auto& done) { control_->on_line_done(*host, done); });
    }
    put("Switches, faults and questions at {}: see 'help' there.\n", io::to_string(*listening));
    return true;
  }

  void power_on(const std::vector<NamedScript>& scripts) {
    for (const auto& machine : machines_) {
      machine->power_on();
      for (const NamedScript& script : scripts) {
        machine->host().play(firmware::RigRecordKind::Script, script.name, script.lines);
      }
    }
  }

  void run() {
    constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
    const io::SignalWatch signals(loop_, kSignals, [&](int) { loop_.stop(); });
    loop_.run();
  }

  [[nodiscard]] const std::vector<std::vector<std::string>>& places() const { return places_; }

 private:
  EventLog& log_;
  io::EventLoop loop_;
  std::vector<std::unique_ptr<VirtualMachine>> machines_;
  std::vector<std::vector<std::string>> places_;
  std::unique_ptr<io::ControlPort> control_;
};

void introduce(const Fleet& fleet, const firmware::Personality& personality, const io::Speed& speed) {
  const auto& places = fleet.places();
  const std::string_view name = personality.dialect().name;
  if (places.size() == 1) {
    put("A virtual {} runs {} at {}.\n", name, pace_text(speed), fmt::join(places.front(), " and "));
  } else {
    put("{} virtual machines with {} run {}:\n", places.size(), name, pace_text(speed));
    for (std::size_t index = 0; index < places.size(); ++index) {
      put("  @{} at {}\n", index + 1, fmt::join(places[index], " and "));
    }
  }
  put("Try: kerf run examples/coaster.nc --machine {}\nCtrl-C ends it.\n", places.front().front());
  std::fflush(stdout);
}

ExitStatus serve(const VirtualOptions& options, const firmware::Personality& personality, io::Speed speed,
                 const std::optional<io::ControlAddress>& control) {
  const auto setups = setups_of(options, speed);
  if (!setups) return ExitStatus::Usage;
  const auto scripts = scripts_of(options);
  if (!scripts) return ExitStatus::Usage;
  EventLog log;
  if (!options.log_file.empty()) {
    const auto opened = log.open(options.log_file);
    if (!opened) {
      complain(
          fmt::format("{} cannot be written ({}): choose another file for --log.", options.log_file, opened.error()));
      return ExitStatus::Usage;
    }
  }
  Fleet fleet(log);
  for (const MachineSetup& setup : *setups) {
    auto controller = controller_for(options, personality, setup.state_file);
    if (!controller || !fleet.add(*std::move(controller), setup)) return ExitStatus::Usage;
  }
  if (control && !fleet.open_control(*control)) return ExitStatus::Usage;
  fleet.power_on(*scripts);
  introduce(fleet, personality, speed);
  fleet.run();
  return ExitStatus::Done;
}

}  // namespace

ExitStatus serve_virtual(const VirtualOptions& options) {
  const auto refuse = [](const std::string& sentence) {
    complain(sentence);
    return ExitStatus::Usage;
  };
  const auto personality = io::parse_personality(options.personality);
  if (!personality) return refuse(io::explain(personality.error()));
  const auto speed = io::parse_speed(options.speed);
  if (!speed) return refuse(io::explain(io::UrlError{.fault = io::UrlFault::BadSpeed, .part = options.speed}));
  std::optional<io::ControlAddress> control;
  if (!options.control.empty()) {
    auto address = io::parse_control_address(options.control);
    if (!address) {
      return refuse(
          fmt::format("'{}' is no place for a control socket: write unix:/tmp/kerf-control or "
                      "tcp://127.0.0.1:5100.",
                      options.control));
    }
    control = *std::move(address);
  }
  const auto build = build_of(options, **personality);
  if (!build) return refuse(build.error());
  return serve(options, *build, *speed, control);
}

}  // namespace kerf::apps
