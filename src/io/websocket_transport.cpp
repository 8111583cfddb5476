// ws://: the same bytes in WebSocket frames, as grblHAL's websocket port and FluidNC serve them.

#include <utility>

#include "io/network_connection.hpp"
#include "io/transport.hpp"
#include "io/websocket_link.hpp"

namespace kerf::io {

std::unique_ptr<Transport> open_websocket(EventLoop& loop, const WebSocketAddress& address, LinkCallbacks callbacks) {
  return connect_over_network(loop, TcpAddress{.host = address.host, .port = address.port}, std::move(callbacks),
                              [address](boost::asio::ip::tcp::socket socket, ByteLink::Callbacks heard) {
                                return make_websocket_client(std::move(socket), address, std::move(heard));
                              });
}

}  // namespace kerf::io
