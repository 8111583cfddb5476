#pragma once
// One HTTP connection: requests one after the other, until it ends or becomes a WebSocket.

#include <functional>
#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "io/web/web_channel.hpp"
#include "io/web/web_server.hpp"

namespace kerf::io::web {

/// What a connection needs around it.
struct HttpSurroundings {
  WorkerPool* pool = nullptr;
  WebHandler* handler = nullptr;
  EventLoop* loop = nullptr;
  /// A connection has become a WebSocket.
  std::function<void(std::shared_ptr<Connection>)> upgraded;
};

/// Serves at once; it keeps itself alive until it ends.
[[nodiscard]] std::shared_ptr<Connection> serve_http(boost::asio::ip::tcp::socket socket, std::string peer,
                                                     std::shared_ptr<const HttpSurroundings> around);

}  // namespace kerf::io::web
