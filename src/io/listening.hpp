#pragma once
// Opening a port to listen on.

#include <cstdint>
#include <expected>

#include <boost/asio/ip/tcp.hpp>

#include "io/machine_url.hpp"
#include "io/server.hpp"

namespace kerf::io {

/// The acceptor listens at the address; the real port, where 0 was asked for.
[[nodiscard]] std::expected<std::uint16_t, ListenError> listen_at(boost::asio::ip::tcp::acceptor& acceptor,
                                                                  const TcpAddress& address);

}  // namespace kerf::io
