#include "io/control_port.hpp"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <utility>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/text.hpp"
#include "io/stream_link.hpp"

namespace kerf::io {

namespace asio = boost::asio;
using asio::ip::tcp;
using Local = asio::local::stream_protocol;
using Socket = asio::generic::stream_protocol::socket;
using firmware::RigRecordKind;

namespace {

/// Longer lines than anybody types.
constexpr std::size_t kMostLineBytes = 4096;

ListenError error_of(boost::system::error_code fault) {
  ListenFault kind = ListenFault::Failed;
  if (fault == asio::error::address_in_use) kind = ListenFault::AddressInUse;
  if (fault == asio::error::access_denied) kind = ListenFault::NoPermission;
  if (fault == boost::system::errc::address_not_available) kind = ListenFault::AddressUnknown;
  if (fault == boost::system::errc::no_such_file_or_directory) kind = ListenFault::PathRefused;
  return {.fault = kind, .system_text = fault.message()};
}

bool is_socket(const std::string& path) {
  struct stat status{};
  return ::stat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
}

std::string state_text(const ControllerHost& machine) {
  if (!machine.rig().is_powered()) return "no power";
  std::string text{name_of(machine.controller().state())};
  if (const auto substate = machine.controller().substate()) text += fmt::format(":{}", *substate);
  return text;
}

/// What a question is answered; none if it is no question.
std::optional<std::string> answer_to(std::string_view question, const ControllerHost& machine) {
  if (question == "state") return "ok " + state_text(machine);
  if (question == "position") {
    return fmt::format("ok {:.3f}", fmt::join(machine.controller().position_mm(), " "));
  }
  if (question == "time") return fmt::format("ok {:.6f}", base::to_seconds(machine.virtual_now()));
  if (question == "help") {
    return fmt::format("ok state; position; time; at TIME …; after TIME …; when state NAME …; when line N …; {}",
                       fmt::join(firmware::script_usage(), "; "));
  }
  return std::nullopt;
}

}  // namespace

struct ControlPort::State : std::enable_shared_from_this<State> {
  using Link = StreamLink<Socket>;

  struct Client {
    std::shared_ptr<Link> link;
    std::string partial_line;
    std::deque<std::string> lines;
    std::map<ControllerHost*, firmware::Rig::PlayerId> players;
    /// Whom the line in execution waits for.
    ControllerHost* waits_for = nullptr;
    bool is_working = false;
  };

  State(EventLoop& owner, std::vector<ControllerHost*> served)
      : loop(owner), machines(std::move(served)), tcp_acceptor(loop.context()), local_acceptor(loop.context()) {}

  template <typename Acceptor>
  void accept(Acceptor& acceptor) {
    acceptor.async_accept([self = shared_from_this(), &acceptor](boost::system::error_code fault, auto socket) {
      if (!acceptor.is_open()) return;
      if (!fault) self->welcome(Socket(std::move(socket)));
      self->accept(acceptor);
    });
  }

  void welcome(Socket socket) {
    clients.emplace_back();
    const auto client = std::prev(clients.end());
    const auto self = weak_from_this();
    client->link =
        std::make_shared<Link>(std::move(socket), Link::Callbacks{.received =
                                                                      [self, client](std::string_view bytes) {
                                                                        if (const auto alive = self.lock()) {
                                                                          alive->hear(*client, bytes);
                                                                        }
                                                                      },
                                                                  .lost =
                                                                      [self, client](boost::system::error_code) {
                                                                        if (const auto alive = self.lock()) {
                                                                          alive->forget(client);
                                                                        }
                                                                      }});
    client->link->start();
  }

  void hear(Client& client, std::string_view bytes) {
    for (const char byte : bytes) {
      if (byte != '\n') {
        if (client.partial_line.size() < kMostLineBytes) client.partial_line += byte;
        continue;
      }
      client.lines.push_back(std::exchange(client.partial_line, {}));
    }
    work(client);
  }

  /// One line after the other, as far as none has to wait.
  void work(Client& client) {
    if (std::exchange(client.is_working, true)) return;
    while (client.waits_for == nullptr && !client.lines.empty()) {
      const std::string line = std::move(client.lines.front());
      client.lines.pop_front();
      obey(client, base::trim(line));
    }
    client.is_working = false;
  }

  void obey(Client& client, std::string_view line) {
    ControllerHost* machine = machines.front();
    if (line.starts_with('@')) {
      const auto parts = base::split_at_most(line.substr(1), ' ', 2);
      const auto number = base::parse_int<std::size_t>(parts[0]);
      if (!number || *number < 1 || *number > machines.size()) {
        return answer(client,
                      fmt::format("error: '@{}' is no machine; accepted: @1 to @{}", parts[0], machines.size()));
      }
      machine = machines[*number - 1];
      line = parts.size() > 1 ? base::trim(parts[1]) : std::string_view{};
    }
    if (const auto told = answer_to(line, *machine)) return answer(client, *told);
    auto parsed = firmware::parse_script_line(line);
    if (!parsed) return answer(client, "error: " + explain(parsed.error()));
    if (!*parsed) return answer(client, "ok");
    auto found = client.players.find(machine);
    if (found == client.players.end()) {
      found = client.players.emplace(machine, machine->play(RigRecordKind::Order, "control", {})).first;
    }
    client.waits_for = machine;
    machine->add(found->second, **std::move(parsed));
  }

  static void answer(Client& client, std::string_view text) { client.link->write_lines(std::string(text) + "\n"); }

  void forget(std::list<Client>::iterator client) {
    for (const auto& [machine, player] : client->players) machine->stop(player);
    clients.erase(client);
  }

  void close() {
    boost::system::error_code ignored;
    tcp_acceptor.close(ignored);
    local_acceptor.close(ignored);
    for (Client& client : clients) client.link->close();
    if (!path.empty()) ::unlink(path.c_str());
  }

  std::expected<ControlAddress, ListenError> listen(const UnixAddress& address) {
    boost::system::error_code fault;
    if (is_socket(address.path)) {
      Local::socket probe(loop.context());
      probe.connect(Local::endpoint(address.path), fault);
      if (!fault) return std::unexpected(ListenError{.fault = ListenFault::AddressInUse, .system_text = {}});
      ::unlink(address.path.c_str());
      fault.clear();
    } else if (std::filesystem::exists(address.path)) {
      return std::unexpected(ListenError{.fault = ListenFault::PathTaken, .system_text = {}});
    }
    local_acceptor.open(Local{}, fault);
    if (!fault) local_acceptor.bind(Local::endpoint(address.path), fault);
    if (!fault) local_acceptor.listen(asio::socket_base::max_listen_connections, fault);
    if (fault) return std::unexpected(error_of(fault));
    path = address.path;
    accept(local_acceptor);
    return address;
  }

  std::expected<ControlAddress, ListenError> listen(const TcpAddress& address) {
    boost::system::error_code fault;
    tcp::resolver resolver(loop.context());
    const auto found = resolver.resolve(address.host, std::to_string(address.port), tcp::resolver::passive, fault);
    if (fault || found.empty()) {
      return std::unexpected(ListenError{.fault = ListenFault::AddressUnknown, .system_text = fault.message()});
    }
    const tcp::endpoint endpoint = found.begin()->endpoint();
    tcp_acceptor.open(endpoint.protocol(), fault);
    if (!fault) tcp_acceptor.set_option(tcp::acceptor::reuse_address(true), fault);
    if (!fault) tcp_acceptor.bind(endpoint, fault);
    if (!fault) tcp_acceptor.listen(asio::socket_base::max_listen_connections, fault);
    if (fault) return std::unexpected(error_of(fault));
    accept(tcp_acceptor);
    return TcpAddress{.host = address.host, .port = tcp_acceptor.local_endpoint(fault).port()};
  }

  EventLoop& loop;
  const std::vector<ControllerHost*> machines;
  tcp::acceptor tcp_acceptor;
  Local::acceptor local_acceptor;
  std::string path;
  std::list<Client> clients;
};

ControlPort::ControlPort(EventLoop& loop, std::vector<ControllerHost*> machines)
    : state_(std::make_shared<State>(loop, std::move(machines))) {}

ControlPort::~ControlPort() {
  state_->close();
}

std::expected<ControlAddress, ListenError> ControlPort::listen(const ControlAddress& address) {
  return std::visit([this](const auto& place) { return state_->listen(place); }, address);
}

void ControlPort::on_line_done(const ControllerHost& machine, const firmware::Rig::LineDone& done) {
  for (State::Client& client : state_->clients) {
    if (client.waits_for != &machine || client.players.at(client.waits_for) != done.player) continue;
    client.waits_for = nullptr;
    State::answer(client, "ok");
    state_->work(client);
    return;
  }
}

std::expected<ControlAddress, UrlError> parse_control_address(std::string_view text) {
  constexpr std::string_view kUnix = "unix:";
  if (!text.starts_with(kUnix)) {
    auto address = parse_listen_url(text);
    if (!address) return std::unexpected(std::move(address).error());
    return *std::move(address);
  }
  std::string_view path = text.substr(kUnix.size());
  if (path.starts_with("//")) path.remove_prefix(2);
  if (path.empty()) return std::unexpected(UrlError{.fault = UrlFault::NoPath, .part = "unix"});
  return UnixAddress{std::string(path)};
}

std::string to_string(const ControlAddress& address) {
  if (const auto* local = std::get_if<UnixAddress>(&address)) return "unix:" + local->path;
  return to_string(std::get<TcpAddress>(address));
}

}  // namespace kerf::io
