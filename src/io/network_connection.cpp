#include "io/network_connection.hpp"

#include <chrono>
#include <string>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>

#include "io/tcp_options.hpp"

namespace kerf::io {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::seconds kConnectLimit{5};

TransportFault fault_of(boost::system::error_code fault) {
  if (fault.category() == asio::error::get_netdb_category() ||
      fault.category() == asio::error::get_addrinfo_category()) {
    return TransportFault::HostUnknown;
  }
  if (fault == asio::error::connection_refused) return TransportFault::Refused;
  if (fault == asio::error::timed_out) return TransportFault::TimedOut;
  if (fault == asio::error::host_unreachable || fault == asio::error::network_unreachable ||
      fault == asio::error::network_down) {
    return TransportFault::Unreachable;
  }
  if (fault == boost::system::errc::protocol_error) return TransportFault::NotAWebSocket;
  if (fault == asio::error::eof || fault == asio::error::connection_reset || fault == asio::error::broken_pipe) {
    return TransportFault::ClosedByPeer;
  }
  return TransportFault::Failed;
}

/// The connection from its first try to its end. Handlers hold it by shared_ptr; `callbacks` is empty once nobody
/// listens.
class NetworkConnection : public std::enable_shared_from_this<NetworkConnection> {
 public:
  NetworkConnection(EventLoop& loop, LinkCallbacks callbacks, LinkMaker make_link)
      : loop_(loop),
        resolver_(loop.context()),
        socket_(loop.context()),
        limit_(loop),
        callbacks_(std::move(callbacks)),
        make_link_(std::move(make_link)) {}

  void connect(const TcpAddress& address) {
    limit_.arm(loop_.now() + kConnectLimit, [self = shared_from_this()] { self->fail(asio::error::timed_out); });
    resolver_.async_resolve(address.host, std::to_string(address.port), tcp::resolver::numeric_service,
                            [self = shared_from_this()](boost::system::error_code fault, const auto& endpoints) {
                              if (fault) return self->fail(fault);
                              if (self->callbacks_.lost) self->connect(endpoints);
                            });
  }

  void close() {
    callbacks_ = {};
    limit_.disarm();
    resolver_.cancel();
    boost::system::error_code ignored;
    socket_.close(ignored);
    if (link_) link_->close();
  }

  [[nodiscard]] ByteLink* link() const { return link_.get(); }

 private:
  void connect(const tcp::resolver::results_type& endpoints) {
    asio::async_connect(socket_, endpoints,
                        [self = shared_from_this()](boost::system::error_code fault, const tcp::endpoint&) {
                          if (fault) return self->fail(fault);
                          if (self->callbacks_.lost) self->begin();
                        });
  }

  void begin() {
    prepare_tcp(socket_);
    link_ = make_link_(std::move(socket_), {.received = callbacks_.received,
                                            .lost =
                                                [self = weak_from_this()](boost::system::error_code fault) {
                                                  if (const auto alive = self.lock()) alive->fail(fault);
                                                },
                                            .room = {},
                                            .opened =
                                                [self = weak_from_this()] {
                                                  if (const auto alive = self.lock()) alive->on_opened();
                                                }});
    link_->start();
  }

  void on_opened() {
    limit_.disarm();
    const auto opened = callbacks_.opened;
    opened();
  }

  void fail(boost::system::error_code fault) {
    const auto lost = callbacks_.lost;
    if (!lost) return;
    close();
    lost({.fault = fault_of(fault), .system_text = fault.message()});
  }

  EventLoop& loop_;
  tcp::resolver resolver_;
  tcp::socket socket_;
  Timer limit_;
  LinkCallbacks callbacks_;
  LinkMaker make_link_;
  std::shared_ptr<ByteLink> link_;
};

class NetworkTransport final : public Transport {
 public:
  NetworkTransport(EventLoop& loop, const TcpAddress& address, LinkCallbacks callbacks, LinkMaker make_link)
      : connection_(std::make_shared<NetworkConnection>(loop, std::move(callbacks), std::move(make_link))) {
    connection_->connect(address);
  }

  ~NetworkTransport() override { connection_->close(); }

  void write_realtime(std::string_view bytes) override {
    if (auto* link = connection_->link()) link->write_realtime(bytes);
  }

  void write_lines(std::string_view bytes) override {
    if (auto* link = connection_->link()) link->write_lines(bytes);
  }

 private:
  std::shared_ptr<NetworkConnection> connection_;
};

}  // namespace

std::unique_ptr<Transport> connect_over_network(EventLoop& loop, const TcpAddress& address, LinkCallbacks callbacks,
                                                LinkMaker make_link) {
  return std::make_unique<NetworkTransport>(loop, address, std::move(callbacks), std::move(make_link));
}

}  // namespace kerf::io
