#include "io/web/web_server.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "io/listening.hpp"
#include "io/tcp_options.hpp"
#include "io/web/http_connection.hpp"

namespace kerf::io::web {

using boost::asio::ip::tcp;

namespace {

/// More than any shop has screens; a descriptor each.
constexpr std::size_t kMostConnections = 500;
/// When the system has no descriptors left, it may have some a little later.
constexpr auto kWaitForRoom = std::chrono::milliseconds(100);

}  // namespace

struct WebServer::State : std::enable_shared_from_this<State> {
  State(EventLoop& owner, WorkerPool& pool, WebHandler& handler)
      : loop(owner), acceptor(owner.context()), again(owner), threads(&pool), answers(&handler) {}

  void start() {
    around = std::make_shared<const HttpSurroundings>(
        HttpSurroundings{.pool = threads,
                         .handler = answers,
                         .loop = &loop,
                         .upgraded = [self = weak_from_this()](std::shared_ptr<Connection> connection) {
                           if (const auto alive = self.lock()) return alive->connections.push_back(connection);
                           connection->end();
                         }});
    accept();
  }

  void accept() {
    acceptor.async_accept([self = shared_from_this()](boost::system::error_code fault, tcp::socket socket) {
      if (!self->acceptor.is_open()) return;
      if (fault) return self->again.arm(self->loop.now() + kWaitForRoom, [self] { self->accept(); });
      self->welcome(std::move(socket));
      self->accept();
    });
  }

  void welcome(tcp::socket socket) {
    std::erase_if(connections, [](const auto& connection) { return connection.expired(); });
    boost::system::error_code gone;
    const tcp::endpoint endpoint = socket.remote_endpoint(gone);
    if (gone || connections.size() >= kMostConnections) return;
    prepare_tcp(socket);
    connections.push_back(
        serve_http(std::move(socket),
                   to_string(TcpAddress{.host = endpoint.address().to_string(), .port = endpoint.port()}), around));
  }

  EventLoop& loop;
  tcp::acceptor acceptor;
  Timer again;
  WorkerPool* threads;
  WebHandler* answers;
  std::shared_ptr<const HttpSurroundings> around;
  std::vector<std::weak_ptr<Connection>> connections;
};

WebServer::WebServer(EventLoop& loop, WorkerPool& pool, WebHandler& handler)
    : state_(std::make_shared<State>(loop, pool, handler)) {}

WebServer::~WebServer() {
  boost::system::error_code ignored;
  state_->acceptor.close(ignored);
  state_->again.disarm();
  for (const auto& weak : state_->connections) {
    if (const auto connection = weak.lock()) connection->end();
  }
}

std::expected<TcpAddress, ListenError> WebServer::listen(const TcpAddress& address) {
  const auto port = listen_at(state_->acceptor, address);
  if (!port) return std::unexpected(port.error());
  state_->start();
  return TcpAddress{.host = address.host, .port = *port};
}

}  // namespace kerf::io::web
