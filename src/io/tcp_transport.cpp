// tcp://: a raw byte stream, as grblHAL's telnet port and Rabbit GRBL's port 5001 speak it.

#include <utility>

#include "io/network_connection.hpp"
#include "io/stream_link.hpp"
#include "io/transport.hpp"

namespace kerf::io {

std::unique_ptr<Transport> open_tcp(EventLoop& loop, const TcpAddress& address, LinkCallbacks callbacks) {
  return connect_over_network(
      loop, address, std::move(callbacks), [](boost::asio::ip::tcp::socket socket, ByteLink::Callbacks heard) {
        return std::make_shared<StreamLink<boost::asio::ip::tcp::socket>>(std::move(socket), std::move(heard));
      });
}

}  // namespace kerf::io
