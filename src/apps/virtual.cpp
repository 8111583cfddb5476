#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "firmware/personality.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/virtual_controller.hpp"
#include "io/card_folder.hpp"
#include "io/controller_host.hpp"
#include "io/machine_url.hpp"
#include "io/server.hpp"
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

OrComplained<StoredState> stored_state_for(const VirtualOptions& options) {
  StoredState state;
  if (!options.state_file.empty()) {
    const auto text = io::read_text_file(options.state_file);
    if (!text && text.error().fault != io::FileFault::NotFound) {
      return said(io::explain(text.error(), options.state_file));
    }
    if (text) {
      auto parsed = firmware::parse_stored_state(*text);
      if (!parsed) return said(explain(parsed.error(), options.state_file));
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

/// What the options plug into the machine.
OrComplained<firmware::Equipment> equipment_for(const VirtualOptions& options, vocabulary::Firmware personality) {
  firmware::Equipment equipment;
  if (options.card_folder.empty()) return equipment;
  if (!firmware::personality_of(personality).has_plugins) {
    return said(
        fmt::format("{} has no card slot: leave --card out, or choose --personality grblhal.", name_of(personality)));
  }
  std::error_code fault;
  if (!std::filesystem::is_directory(options.card_folder, fault)) {
    return said(
        fmt::format("{} is no folder that could be a card: make it, or name another one.", options.card_folder));
  }
  equipment.card = std::make_shared<io::CardFolder>(options.card_folder);
  return equipment;
}

/// Everything that serves one controller. Lives on the event loop's thread.
class VirtualMachine {
 public:
  VirtualMachine(io::EventLoop& loop, firmware::VirtualController controller, io::Speed speed, std::string state_file)
      : state_file_(std::move(state_file)),
        host_(loop, std::move(controller), speed),
        tcp_(loop, {.received = [this](std::string_view bytes) { host_.receive(bytes); },
                    .connected = [](std::string_view peer) { say(fmt::format("{} connected.", peer)); },
                    .disconnected = [](std::string_view peer) { say(fmt::format("{} went away.", peer)); },
                    .turned_away =
                        [](std::string_view peer) {
                          say(fmt::format("{} was turned away: another sender is connected.", peer));
                        }}),
        pty_(loop, [this](std::string_view bytes) { host_.receive(bytes); }) {
    host_.on_output([this](std::string_view bytes) {
      tcp_.write(bytes);
      pty_.write(bytes);
    });
    host_.on_stored([this](const StoredState& state) { save(state); });
  }

  OrComplained<std::vector<std::string>> open(const std::optional<io::TcpAddress>& address, const std::string& pty) {
    std::vector<std::string> places;
    if (address) {
      const auto listening = tcp_.listen(*address);
      if (!listening) return said(io::explain(listening.error(), io::to_string(*address)));
      places.push_back(io::to_string(*listening));
    }
    if (!pty.empty()) {
      const auto opened = pty_.open(pty);
      if (!opened) return said(io::explain(opened.error(), pty));
      places.push_back(pty);
    }
    return places;
  }

  void power_on() {
    if (!state_file_.empty()) save(host_.controller().stored());
    host_.power_on();
  }

 private:
  static void say(std::string_view sentence) {
    put("{}\n", sentence);
    std::fflush(stdout);
  }

  void save(const StoredState& state) {
    if (state_file_.empty()) return;
    const auto saved = io::replace_text_file(state_file_, firmware::print(state));
    if (!saved) complain(io::explain(saved.error(), state_file_));
  }

  const std::string state_file_;
  io::ControllerHost host_;
  io::TcpServer tcp_;
  io::PtyServer pty_;
};

std::string pace_text(const io::Speed& speed) {
  if (speed.is_max()) return "as fast as it can";
  return *speed.factor == 1.0 ? "in real time" : fmt::format("{} times as fast as a real one", *speed.factor);
}

ExitStatus serve(const VirtualOptions& options, vocabulary::Firmware personality, io::Speed speed,
                 const std::optional<io::TcpAddress>& address) {
  auto state = stored_state_for(options);
  if (!state) return ExitStatus::Usage;
  const auto equipment = equipment_for(options, personality);
  if (!equipment) return ExitStatus::Usage;
  firmware::VirtualController controller(firmware::personality_of(personality), *std::move(state), *equipment);
  if (const auto& rejected = controller.rejected_settings(); !rejected.empty()) {
    complain(fmt::format("{} refuses the setting{} ${}: correct {} or leave {} out.", name_of(personality),
                         rejected.size() == 1 ? "" : "s", fmt::join(rejected, ", $"),
                         rejected.size() == 1 ? "its value" : "their values", rejected.size() == 1 ? "it" : "them"));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  VirtualMachine machine(loop, std::move(controller), speed, options.state_file);
  const auto places = machine.open(address, options.pty);
  if (!places) return ExitStatus::Usage;
  constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  const io::SignalWatch signals(loop, kSignals, [&](int) { loop.stop(); });
  machine.power_on();
  put("A virtual {} runs {} at {}.\nTry: kerf run examples/coaster.nc --machine {}\nCtrl-C ends it.\n",
      name_of(personality), pace_text(speed), fmt::join(*places, " and "), places->front());
  std::fflush(stdout);
  loop.run();
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
  if (options.listen.empty() && options.pty.empty()) {
    return refuse("Say where to serve: --listen tcp://127.0.0.1:5001, or --pty /tmp/kerf-grblhal, or both.");
  }
  std::optional<io::TcpAddress> address;
  if (!options.listen.empty()) {
    auto listen = io::parse_listen_url(options.listen);
    if (!listen) return refuse(io::explain(listen.error()));
    address = *std::move(listen);
  }
  return serve(options, *personality, *speed, address);
}

}  // namespace kerf::apps
