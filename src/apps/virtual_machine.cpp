#include "apps/virtual_machine.hpp"

#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "firmware/stored_state.hpp"
#include "io/json.hpp"
#include "io/text_file.hpp"

namespace kerf::apps {

using firmware::LinkState;
using firmware::RigRecord;
using firmware::RigRecordKind;

EventLog::~EventLog() {
  if (file_ != nullptr && file_ != stderr) std::fclose(file_);
}

std::expected<void, std::string> EventLog::open(const std::string& file) {
  file_ = file == "-" ? stderr : std::fopen(file.c_str(), "we");
  if (file_ == nullptr) return std::unexpected(std::generic_category().message(errno));
  return {};
}

void EventLog::write(std::size_t machine, const RigRecord& record) {
  if (file_ == nullptr) return;
  io::Json entry = io::Json::object();
  // Whole microseconds: nothing that happens is more exact, and a double prints the rest as noise.
  entry["at"] = std::round(base::to_seconds(record.at) * 1e6) / 1e6;
  entry["machine"] = machine;
  entry["kind"] = io::to_json(record.kind);
  if (!record.from.empty()) entry["from"] = record.from;
  entry["what"] = record.what;
  put_to(file_, "{}\n", io::print(entry));
  std::fflush(file_);
}

WireServer::WireServer(io::EventLoop& loop, std::string_view who, Callbacks callbacks)
    : tcp_(loop, {.received = callbacks.received,
                  .connected =
                      [callbacks](std::string_view peer) {
                        callbacks.told(fmt::format("{} connected.", peer));
                        if (callbacks.connected) callbacks.connected();
                      },
                  .disconnected =
                      [told = callbacks.told](std::string_view peer) { told(fmt::format("{} went away.", peer)); },
                  .turned_away =
                      [told = callbacks.told, who](std::string_view peer) {
                        told(fmt::format("{} was turned away: another {} is connected.", peer, who));
                      },
                  .room = callbacks.room}),
      pty_(loop, callbacks.received) {}

std::expected<std::string, std::string> WireServer::listen(const io::ServeAddress& address) {
  const auto listening = tcp_.listen(address);
  if (!listening) return std::unexpected(io::explain(listening.error(), io::to_string(address)));
  return io::to_string(*listening);
}

std::expected<std::string, std::string> WireServer::open(const std::string& path) {
  pty_path_ = path;
  const auto opened = pty_.open(path);
  if (!opened) return std::unexpected(io::explain(opened.error(), path));
  return path;
}

void WireServer::write(std::string_view bytes) {
  tcp_.write(bytes);
  pty_.write(bytes);
}

void WireServer::greet(std::string_view greeting, std::string_view notice) {
  tcp_.write(greeting);
  pty_.write(notice);
}

std::string WireServer::set_cable(bool connected) {
  tcp_.set_cable(connected);
  const auto plugged = pty_.set_cable(connected);
  return plugged ? std::string{} : io::explain(plugged.error(), pty_path_);
}

VirtualMachine::VirtualMachine(io::EventLoop& loop, firmware::VirtualController controller, MachineSetup setup,
                               EventLog& log)
    : setup_(std::move(setup)),
      log_(log),
      host_(loop, std::move(controller), setup_.speed),
      sender_(loop, "sender",
              {.received = [this](std::string_view bytes) { host_.receive(bytes); },
               .told = [this](std::string sentence) { note_link(std::move(sentence)); },
               .connected = [this] { greet(); },
               .room = [this] { return host_.network_room(); }}),
      pendant_(loop, "pendant",
               {.received = [this](std::string_view bytes) { host_.receive_from_pendant(bytes); },
                .told = [this](std::string sentence) { note_link(std::move(sentence)); },
                .connected = {},
                .room = {}}) {
  host_.on_output([this](std::string_view bytes) { sender_.write(bytes); });
  host_.on_pendant_output([this](std::string_view bytes) { pendant_.write(bytes); });
  host_.on_stored([this](const firmware::StoredState& state) { save(state); });
  host_.on_link([this](LinkState link) { set_cable(link); });
  host_.on_turn([this] { sender_.go_on(); });
  host_.on_record([this](const RigRecord& record) {
    log_.write(setup_.number, record);
    if (record.kind == RigRecordKind::Script || record.kind == RigRecordKind::Order) {
      say(fmt::format("{:.3f} s  {}  {}", base::to_seconds(record.at), record.from, record.what));
    }
  });
}

std::expected<std::vector<std::string>, std::string> VirtualMachine::open() {
  std::vector<std::string> places;
  if (setup_.address) {
    auto place = sender_.listen(*setup_.address);
    if (!place) return std::unexpected(std::move(place).error());
    places.push_back(*std::move(place));
  }
  if (!setup_.pty.empty()) {
    auto place = sender_.open(setup_.pty);
    if (!place) return std::unexpected(std::move(place).error());
    places.push_back(*std::move(place));
  }
  if (!setup_.pendant.empty()) {
    auto place = open_pendant();
    if (!place) return std::unexpected(std::move(place).error());
    places.push_back("its pendant at " + *place);
  }
  return places;
}

std::expected<std::string, std::string> VirtualMachine::open_pendant() {
  std::string_view url = setup_.pendant;
  constexpr std::string_view kPty = "pty:";
  if (url.starts_with(kPty)) {
    url.remove_prefix(kPty.size());
    if (url.starts_with("//")) url.remove_prefix(2);
    return pendant_.open(std::string(url));
  }
  const auto address = io::parse_serve_url(url);
  if (!address) return std::unexpected(io::explain(address.error()));
  return pendant_.listen(*address);
}

void VirtualMachine::power_on() {
  if (!setup_.state_file.empty()) save(host_.controller().stored());
  host_.power_on();
}

void VirtualMachine::say(std::string_view sentence) const {
  put("{}{}\n", setup_.label, sentence);
  std::fflush(stdout);
}

void VirtualMachine::note_link(std::string sentence) {
  say(sentence);
  sentence.pop_back();
  log_.write(setup_.number,
             {.at = host_.virtual_now(), .kind = RigRecordKind::Link, .from = {}, .what = std::move(sentence)});
}

// grblHAL stream.c stream_select: what a network stream that comes up says.
void VirtualMachine::greet() {
  if (!setup_.greets || !host_.rig().is_powered()) return;
  const std::string_view welcome = host_.controller().personality().dialect().welcome;
  const std::string_view kind = setup_.address && setup_.address->websocket ? "WEBSOCKET" : "TELNET";
  sender_.greet(fmt::format("\r\n{}\r\n", welcome), fmt::format("[MSG:{} STREAM ACTIVE]\r\n", kind));
}

void VirtualMachine::set_cable(LinkState link) {
  if (const std::string fault = sender_.set_cable(link != LinkState::Cut); !fault.empty()) complain(fault);
}

void VirtualMachine::save(const firmware::StoredState& state) const {
  if (setup_.state_file.empty()) return;
  const auto saved = io::replace_text_file(setup_.state_file, firmware::print(state));
  if (!saved) complain(io::explain(saved.error(), setup_.state_file));
}

}  // namespace kerf::apps
