#pragma once
// What tcp:// and ws:// have in common: finding the host, connecting within a limit, and what became of it.

#include <functional>
#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "io/byte_link.hpp"
#include "io/transport.hpp"

namespace kerf::io {

/// Frames the bytes of a connected socket.
using LinkMaker = std::function<std::shared_ptr<ByteLink>(boost::asio::ip::tcp::socket, ByteLink::Callbacks)>;

[[nodiscard]] std::unique_ptr<Transport> connect_over_network(EventLoop& loop, const TcpAddress& address,
                                                              LinkCallbacks callbacks, LinkMaker make_link);

}  // namespace kerf::io
