#include "io/web/web_channel.hpp"

#include <chrono>
#include <deque>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace kerf::io::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kLongestMessage = std::size_t{64} << 10U;
constexpr auto kHandshakeLimit = std::chrono::seconds(5);
/// Without a word for half of that it is pinged.
constexpr auto kSilenceLimit = std::chrono::seconds(10);

class WebChannel final : public Channel, public Connection, public std::enable_shared_from_this<WebChannel> {
 public:
  WebChannel(tcp::socket socket, http::request<http::empty_body> head, ChannelOpener opener)
      : stream_(std::move(socket)), head_(std::move(head)), opener_(std::move(opener)) {
    stream_.text(true);
    stream_.auto_fragment(false);
    stream_.read_message_max(kLongestMessage);
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = kHandshakeLimit, .idle_timeout = kSilenceLimit, .keep_alive_pings = true});
  }

  void start() {
    stream_.async_accept(head_, [self = shared_from_this()](error_code fault) {
      if (fault || self->is_closed_) return;
      self->user_ = std::exchange(self->opener_, {})(*self);
      self->read();
    });
  }

  void send(std::shared_ptr<const std::string> text) override {
    if (is_closed_) return;
    waiting_bytes_ += text->size();
    outgoing_.push_back(std::move(text));
    if (!is_writing_) write();
  }

  [[nodiscard]] std::size_t waiting_bytes() const override { return waiting_bytes_; }

  void close() override {
    if (std::exchange(is_closed_, true)) return;
    user_.reset();
    error_code ignored;
    stream_.next_layer().close(ignored);
  }

  void end() override { close(); }

 private:
  void read() {
    stream_.async_read(incoming_, [self = shared_from_this()](error_code fault, std::size_t) {
      if (fault || self->is_closed_) return self->close();
      const auto bytes = self->incoming_.cdata();
      if (self->stream_.got_text()) {
        self->user_->on_text({static_cast<const char*>(bytes.data()), bytes.size()});
      }
      self->incoming_.consume(self->incoming_.size());
      if (!self->is_closed_) self->read();
    });
  }

  void write() {
    is_writing_ = true;
    stream_.async_write(asio::buffer(*outgoing_.front()), [self = shared_from_this()](error_code fault, std::size_t) {
      if (fault || self->is_closed_) return self->close();
      self->waiting_bytes_ -= self->outgoing_.front()->size();
      self->outgoing_.pop_front();
      self->is_writing_ = false;
      if (!self->outgoing_.empty()) return self->write();
      self->user_->on_drained();
    });
  }

  websocket::stream<tcp::socket> stream_;
  http::request<http::empty_body> head_;
  ChannelOpener opener_;
  std::unique_ptr<ChannelUser> user_;
  beast::flat_buffer incoming_;
  std::deque<std::shared_ptr<const std::string>> outgoing_;
  std::size_t waiting_bytes_ = 0;
  bool is_closed_ = false;
  bool is_writing_ = false;
};

}  // namespace

std::shared_ptr<Connection> open_channel(tcp::socket socket, http::request<http::empty_body> head,
                                         ChannelOpener opener) {
  auto channel = std::make_shared<WebChannel>(std::move(socket), std::move(head), std::move(opener));
  channel->start();
  return channel;
}

}  // namespace kerf::io::web
