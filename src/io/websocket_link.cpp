#include "io/websocket_link.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace kerf::io {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

/// A controller's frame holds at most its output buffer; this is what nothing but a mistake exceeds.
constexpr std::size_t kLongestMessage = std::size_t{1} << 20;
constexpr std::string_view kBinaryProtocol = "arduino";

/// In the words that a plain TCP link uses.
error_code plain(error_code fault, bool is_open) {
  if (fault == websocket::error::closed || fault == http::error::end_of_stream) return asio::error::eof;
  if (fault == beast::error::timeout) return asio::error::timed_out;
  const bool is_foreign = fault.category() != boost::system::system_category() && fault != asio::error::eof;
  if (!is_open && is_foreign) return make_error_code(boost::system::errc::protocol_error);
  return fault;
}

/// Both ends after the handshake.
class WebSocketLink : public ByteLink, public std::enable_shared_from_this<WebSocketLink> {
 public:
  WebSocketLink(tcp::socket socket, Callbacks callbacks)
      : stream_(std::move(socket)), callbacks_(std::make_shared<const Callbacks>(std::move(callbacks))) {
    stream_.binary(true);
    stream_.auto_fragment(false);
    stream_.read_message_max(kLongestMessage);
  }

  void go_on() override {
    if (callbacks_ && std::exchange(waits_for_room_, false)) deliver();
  }

  void close() override {
    callbacks_.reset();
    close_socket();
  }

 protected:
  void write() override {
    if (!is_open_ || is_writing_ || waiting_bytes() == 0) return;
    is_writing_ = true;
    outgoing_ = take_piece();
    stream_.async_write(asio::buffer(outgoing_), [self = shared_from_this()](error_code fault, std::size_t) {
      self->is_writing_ = false;
      if (fault) return self->lose(fault);
      self->write();
    });
  }

  using Stream = websocket::stream<tcp::socket, false>;

  /// The handshake is over.
  void on_shaken(error_code fault) {
    if (fault) return lose(fault);
    const auto callbacks = callbacks_;
    if (!callbacks) return;
    is_open_ = true;
    if (callbacks->opened) callbacks->opened();
    if (!callbacks_) return;
    write();
    read();
  }

  void lose(error_code fault) {
    const auto callbacks = std::exchange(callbacks_, nullptr);
    if (!callbacks) return;
    close_socket();
    callbacks->lost(plain(fault, is_open_));
  }

  [[nodiscard]] Stream& stream() { return stream_; }
  [[nodiscard]] beast::flat_buffer& incoming() { return incoming_; }
  [[nodiscard]] bool is_closed() const { return !callbacks_; }

 private:
  /// Whether the message that was read is to be passed on.
  [[nodiscard]] virtual bool is_for_us(bool is_text, std::string_view message) = 0;

  void read() {
    incoming_.clear();
    stream_.async_read(incoming_, [self = shared_from_this()](error_code fault, std::size_t) {
      if (fault) return self->lose(fault);
      if (!self->is_for_us(self->stream_.got_text(), self->waiting())) return self->read();
      self->deliver();
    });
  }

  [[nodiscard]] std::string_view waiting() const {
    const auto bytes = incoming_.data();
    return {static_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// Hands over what was read, as much as there is room for, and reads on when that is all.
  void deliver() {
    while (callbacks_ && incoming_.size() > 0) {
      const auto callbacks = callbacks_;  // the owner may close() in there
      const std::size_t room = callbacks->room ? callbacks->room() : incoming_.size();
      waits_for_room_ = room == 0;
      if (waits_for_room_) return;
      const std::string piece(waiting().substr(0, room));
      incoming_.consume(piece.size());
      callbacks->received(piece);
    }
    if (callbacks_) read();
  }

  void close_socket() {
    error_code ignored;
    stream_.next_layer().close(ignored);
  }

  Stream stream_;
  std::shared_ptr<const Callbacks> callbacks_;
  beast::flat_buffer incoming_;
  std::string outgoing_;
  bool is_open_ = false;
  bool is_writing_ = false;
  bool waits_for_room_ = false;
};

class WebSocketClient final : public WebSocketLink {
 public:
  WebSocketClient(tcp::socket socket, WebSocketAddress address, Callbacks callbacks)
      : WebSocketLink(std::move(socket), std::move(callbacks)), address_(std::move(address)) {}

  void start() override {
    stream().set_option(
        websocket::stream_base::decorator([protocol = address_.protocol](websocket::request_type& request) {
          if (!protocol.empty()) request.set(http::field::sec_websocket_protocol, protocol);
        }));
    stream().async_handshake(host_and_port(address_.host, address_.port), address_.path,
                             [self = shared_from_this(), this](error_code fault) { on_shaken(fault); });
  }

 private:
  [[nodiscard]] bool is_for_us(bool is_text, std::string_view message) override {
    if (!is_text) speaks_binary_ = true;
    // A server whose machine speaks in binary frames has only web pages to write text to.
    return !is_text || (!speaks_binary_ && !is_web_page_talk(message));
  }

  const WebSocketAddress address_;
  bool speaks_binary_ = false;
};

class WebSocketServer final : public WebSocketLink {
 public:
  using WebSocketLink::WebSocketLink;

  void start() override {
    http::async_read(
        stream().next_layer(), incoming(), request_,
        [self = shared_from_this(), this](error_code fault, std::size_t) { fault ? lose(fault) : accept(); });
  }

 private:
  void accept() {
    if (is_closed()) return;
    std::string protocol(request_[http::field::sec_websocket_protocol]);
    protocol.erase(std::min(protocol.find(','), protocol.size()));
    stream().binary(protocol == kBinaryProtocol);
    stream().set_option(websocket::stream_base::decorator([protocol](websocket::response_type& response) {
      if (!protocol.empty()) response.set(http::field::sec_websocket_protocol, protocol);
    }));
    // It pings after 3 s and gives up after three that were not answered; Beast pings at half of its limit.
    using std::chrono::seconds;
    stream().set_option(websocket::stream_base::timeout{
        .handshake_timeout = seconds(5), .idle_timeout = seconds(9), .keep_alive_pings = true});
    stream().async_accept(request_, [self = shared_from_this(), this](error_code fault) { on_shaken(fault); });
  }

  [[nodiscard]] bool is_for_us(bool, std::string_view) override { return true; }

  http::request<http::empty_body> request_;
};

}  // namespace

std::shared_ptr<ByteLink> make_websocket_client(tcp::socket socket, const WebSocketAddress& address,
                                                ByteLink::Callbacks callbacks) {
  return std::make_shared<WebSocketClient>(std::move(socket), address, std::move(callbacks));
}

std::shared_ptr<ByteLink> make_websocket_server(tcp::socket socket, ByteLink::Callbacks callbacks) {
  return std::make_shared<WebSocketServer>(std::move(socket), std::move(callbacks));
}

bool is_web_page_talk(std::string_view text) {
  constexpr std::array<std::string_view, 5> kWords{"currentID:", "CURRENT_ID:", "activeID:", "ACTIVE_ID:", "PING"};
  return std::ranges::any_of(kWords, [&](std::string_view word) { return text.starts_with(word); });
}

}  // namespace kerf::io
