#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "io/listening.hpp"
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
  const auto port = listen_at(state_->acceptor, serve.tcp);
  if (!port) return std::unexpected(port.error());
  state_->is_websocket = serve.websocket;
  state_->accept();
  return ServeAddress{.tcp = {.host = serve.tcp.host, .port = *port}, .websocket = serve.websocket};
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
