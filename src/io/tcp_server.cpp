#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "io/server.hpp"
#include "io/stream_link.hpp"
#include "io/tcp_options.hpp"
#include "io/websocket_link.hpp"

namespace kerf::io {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

std::string name_of(const tcp::endpoint& endpoint) {
  return to_string(TcpAddress{.host = endpoint.address().to_string(), .port = endpoint.port()});
}

ListenError error_of(boost::system::error_code fault) {
  ListenFault kind = ListenFault::Failed;
  if (fault == asio::error::address_in_use) kind = ListenFault::AddressInUse;
  if (fault == asio::error::access_denied) kind = ListenFault::NoPermission;
  if (fault == boost::system::errc::address_not_available) kind = ListenFault::AddressUnknown;
  return {.fault = kind, .system_text = fault.message()};
}

}  // namespace

struct TcpServer::State : std::enable_shared_from_this<State> {
  State(EventLoop& loop, Callbacks on_what) : acceptor(loop.context()), callbacks(std::move(on_what)) {}

  void accept() {
    acceptor.async_accept([self = shared_from_this()](boost::system::error_code fault, tcp::socket socket) {
      if (!self->acceptor.is_open()) return;
      if (!fault) self->welcome(std::move(socket));
      self->accept();
    });
  }

  void welcome(tcp::socket socket) {
    boost::system::error_code gone;
    const tcp::endpoint endpoint = socket.remote_endpoint(gone);
    if (gone || !has_cable) return;
    const std::string name = name_of(endpoint);
    if (client) {
      callbacks.turned_away(name);
      return;
    }
    prepare_tcp(socket);
    peer = name;
    ByteLink::Callbacks heard{.received = callbacks.received,
                              .lost =
                                  [self = weak_from_this()](boost::system::error_code) {
                                    if (const auto alive = self.lock()) alive->lose_client();
                                  },
                              .room = callbacks.room,
                              .opened =
                                  [self = weak_from_this()] {
                                    if (const auto alive = self.lock()) alive->open_client();
                                  }};
    if (is_websocket) {
      client = make_websocket_server(std::move(socket), std::move(heard));
    } else {
      client = std::make_shared<StreamLink<tcp::socket>>(std::move(socket), std::move(heard));
    }
    client->start();
  }

  void open_client() {
    is_connected = true;
    callbacks.connected(peer);
  }

  void lose_client() {
    client.reset();
    if (std::exchange(is_connected, false)) callbacks.disconnected(peer);
  }

  tcp::acceptor acceptor;
  Callbacks callbacks;
  std::shared_ptr<ByteLink> client;
  std::string peer;
  bool is_websocket = false;
  bool is_connected = false;  ///< a WebSocket has shaken hands; a raw link is connected at once
  bool has_cable = true;
};

TcpServer::TcpServer(EventLoop& loop, Callbacks callbacks)
    : state_(std::make_shared<State>(loop, std::move(callbacks))) {}

TcpServer::~TcpServer() {
  boost::system::error_code ignored;
  state_->acceptor.close(ignored);
  if (state_->client) state_->client->close();
}

std::expected<ServeAddress, ListenError> TcpServer::listen(const ServeAddress& serve) {
  const TcpAddress& address = serve.tcp;
  boost::system::error_code fault;
  tcp::resolver resolver(state_->acceptor.get_executor());
  const auto found = resolver.resolve(address.host, std::to_string(address.port), tcp::resolver::passive, fault);
  if (fault || found.empty()) {
    return std::unexpected(ListenError{.fault = ListenFault::AddressUnknown, .system_text = fault.message()});
  }
  const tcp::endpoint endpoint = found.begin()->endpoint();
  tcp::acceptor& acceptor = state_->acceptor;
  acceptor.open(endpoint.protocol(), fault);
  if (!fault) acceptor.set_option(tcp::acceptor::reuse_address(true), fault);
  if (!fault) acceptor.bind(endpoint, fault);
  if (!fault) acceptor.listen(asio::socket_base::max_listen_connections, fault);
  if (fault) return std::unexpected(error_of(fault));
  state_->is_websocket = serve.websocket;
  state_->accept();
  const std::uint16_t port = acceptor.local_endpoint(fault).port();
  return ServeAddress{.tcp = {.host = address.host, .port = port}, .websocket = serve.websocket};
}

void TcpServer::write(std::string_view bytes) {
  if (state_->is_connected) state_->client->write_lines(bytes);
}

void TcpServer::go_on() {
  if (state_->client) state_->client->go_on();
}

void TcpServer::set_cable(bool connected) {
  state_->has_cable = connected;
  if (connected || !state_->client) return;
  state_->client->close();
  state_->lose_client();
}

}  // namespace kerf::io
