#pragma once
// What every TCP socket of Kerf is told, on both ends.

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/socket_base.hpp>
#include <netinet/tcp.h>

namespace kerf::io {

/// No delay, because a status query is one byte and must not wait for company; keepalive, so that a cable pulled out of
/// an idle machine is noticed within about 20 s. A socket that refuses an option still works, so refusals are ignored.
inline void prepare_tcp(boost::asio::ip::tcp::socket& socket) {
  using Idle = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPIDLE>;
  using Interval = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPINTVL>;
  using Count = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_KEEPCNT>;
  using UserTimeout = boost::asio::detail::socket_option::integer<IPPROTO_TCP, TCP_USER_TIMEOUT>;
  boost::system::error_code ignored;
  socket.set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(boost::asio::socket_base::keep_alive(true), ignored);
  socket.set_option(Idle(10), ignored);
  socket.set_option(Interval(3), ignored);
  socket.set_option(Count(3), ignored);
  socket.set_option(UserTimeout(20000), ignored);
}

}  // namespace kerf::io
