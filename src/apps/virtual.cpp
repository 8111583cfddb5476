#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
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
  equipment.pendant = !options.pendant.empty();
  const bool wants_any = equipment.pendant || !options.card_folder.empty();
  if (wants_any && !firmware::personality_of(personality).has_plugins) {
    return said(
        fmt::format("{} has {}, or choose --personality grblhal.", name_of(personality),
                    equipment.pendant ? "no second stream: leave --pendant out" : "no card slot: leave --card out"));
  }
  if (options.card_folder.empty()) return equipment;
  std::error_code fault;
  if (!std::filesystem::is_directory(options.card_folder, fault)) {
    return said(
        fmt::format("{} is no folder that could be a card: make it, or name another one.", options.card_folder));
  }
  equipment.card = std::make_shared<io::CardFolder>(options.card_folder);
  return equipment;
}

/// The terminal that `pty://PATH` or `pty:PATH` names.
std::optional<std::string> pty_path_of(std::string_view url) {
  constexpr std::string_view kScheme = "pty:";
  if (!url.starts_with(kScheme)) return std::nullopt;
  url.remove_prefix(kScheme.size());
  if (url.starts_with("//")) url.remove_prefix(2);
  return std::string{url};
}

/// A place where one wire of the controller can be reached: a TCP port, a pseudo-terminal, or both.
class WireServer {
 public:
  WireServer(io::EventLoop& loop, std::string_view who, std::function<void(std::string_view)> received)
      : tcp_(loop, {.received = received,
                    .connected = [](std::string_view peer) { tell(fmt::format("{} connected.", peer)); },
                    .disconnected = [](std::string_view peer) { tell(fmt::format("{} went away.", peer)); },
                    .turned_away =
                        [who](std::string_view peer) {
                          tell(fmt::format("{} was turned away: another {} is connected.", peer, who));
                        }}),
        pty_(loop, received) {}

  OrComplained<std::string> listen(const io::TcpAddress& address) {
    const auto listening = tcp_.listen(address);
    if (!listening) return said(io::explain(listening.error(), io::to_string(address)));
    return io::to_string(*listening);
  }

  OrComplained<std::string> open(const std::string& path) {
    const auto opened = pty_.open(path);
    if (!opened) return said(io::explain(opened.error(), path));
    return path;
  }

  void write(std::string_view bytes) {
    tcp_.write(bytes);
    pty_.write(bytes);
  }

 private:
  static void tell(std::string_view sentence) {
    put("{}\n", sentence);
    std::fflush(stdout);
  }

  io::TcpServer tcp_;
  io::PtyServer pty_;
};

/// Everything that serves one controller. Lives on the event loop's thread.
class VirtualMachine {
 public:
  VirtualMachine(io::EventLoop& loop, firmware::VirtualController controller, io::Speed speed, std::string state_file)
      : state_file_(std::move(state_file)),
        host_(loop, std::move(controller), speed),
        sender_(loop, "sender", [this](std::string_view bytes) { host_.receive(bytes); }),
        pendant_(loop, "pendant", [this](std::string_view bytes) { host_.receive_from_pendant(bytes); }) {
    host_.on_output([this](std::string_view bytes) { sender_.write(bytes); });
    host_.on_pendant_output([this](std::string_view bytes) { pendant_.write(bytes); });
    host_.on_stored([this](const StoredState& state) { save(state); });
  }

  OrComplained<std::vector<std::string>> open(const std::optional<io::TcpAddress>& address, const std::string& pty) {
    std::vector<std::string> places;
    if (address) {
      auto place = sender_.listen(*address);
      if (!place) return std::unexpected(place.error());
      places.push_back(*std::move(place));
    }
    if (!pty.empty()) {
      auto place = sender_.open(pty);
      if (!place) return std::unexpected(place.error());
      places.push_back(*std::move(place));
    }
    return places;
  }

  /// `url` is an address to listen at, or a `pty:` with the name of a terminal.
  OrComplained<std::string> open_pendant(const std::string& url) {
    if (const auto path = pty_path_of(url)) return pendant_.open(*path);
    const auto address = io::parse_listen_url(url);
    if (!address) return said(io::explain(address.error()));
    return pendant_.listen(*address);
  }

  void power_on() {
    if (!state_file_.empty()) save(host_.controller().stored());
    host_.power_on();
  }

 private:
  void save(const StoredState& state) {
    if (state_file_.empty()) return;
    const auto saved = io::replace_text_file(state_file_, firmware::print(state));
    if (!saved) complain(io::explain(saved.error(), state_file_));
  }

  const std::string state_file_;
  io::ControllerHost host_;
  WireServer sender_;
  WireServer pendant_;
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
  auto places = machine.open(address, options.pty);
  if (!places) return ExitStatus::Usage;
  const std::string first_place = places->front();
  if (!options.pendant.empty()) {
    const auto place = machine.open_pendant(options.pendant);
    if (!place) return ExitStatus::Usage;
    places->back() += fmt::format(", its pendant at {}", *place);
  }
  constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  const io::SignalWatch signals(loop, kSignals, [&](int) { loop.stop(); });
  machine.power_on();
  put("A virtual {} runs {} at {}.\nTry: kerf run examples/coaster.nc --machine {}\nCtrl-C ends it.\n",
      name_of(personality), pace_text(speed), fmt::join(*places, " and "), first_place);
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
