#include "io/listening.hpp"

#include <string>

namespace kerf::io {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

ListenError error_of(boost::system::error_code fault) {
  ListenFault kind = ListenFault::Failed;
  if (fault == asio::error::address_in_use) kind = ListenFault::AddressInUse;
  if (fault == asio::error::access_denied) kind = ListenFault::NoPermission;
  if (fault == boost::system::errc::address_not_available) kind = ListenFault::AddressUnknown;
  return {.fault = kind, .system_text = fault.message()};
}

}  // namespace

std::expected<std::uint16_t, ListenError> listen_at(tcp::acceptor& acceptor, const TcpAddress& address) {
  boost::system::error_code fault;
  tcp::resolver resolver(acceptor.get_executor());
  const auto found = resolver.resolve(address.host, std::to_string(address.port), tcp::resolver::passive, fault);
  if (fault || found.empty()) {
    return std::unexpected(ListenError{.fault = ListenFault::AddressUnknown, .system_text = fault.message()});
  }
  const tcp::endpoint endpoint = found.begin()->endpoint();
  acceptor.open(endpoint.protocol(), fault);
  if (!fault) acceptor.set_option(tcp::acceptor::reuse_address(true), fault);
  if (!fault) acceptor.bind(endpoint, fault);
  if (!fault) acceptor.listen(asio::socket_base::max_listen_connections, fault);
  if (fault) return std::unexpected(error_of(fault));
  return acceptor.local_endpoint(fault).port();
}

}  // namespace kerf::io
