#pragma once
// A connection that became a WebSocket.

#include <memory>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "io/web/web_server.hpp"

namespace kerf::io::web {

/// Something that lives as long as its connection, and can be told to end.
class Connection {
 public:
  Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual ~Connection() = default;
  virtual void end() = 0;
};

/// Shakes hands and then serves; it keeps itself alive until it is closed.
[[nodiscard]] std::shared_ptr<Connection> open_channel(boost::asio::ip::tcp::socket socket,
                                                       boost::beast::http::request<boost::beast::http::empty_body> head,
                                                       ChannelOpener opener);

}  // namespace kerf::io::web
