#include "io/web/http_connection.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/version.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace kerf::io::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::seconds;

constexpr std::uint32_t kLongestHeaders = 16U << 10U;
constexpr std::size_t kLongestHeldBody = std::size_t{1} << 20U;
constexpr std::uint64_t kLongestUpload = std::uint64_t{2} << 30U;
constexpr std::size_t kPiece = std::size_t{64} << 10U;
constexpr auto kHeadLimit = seconds(10);
constexpr auto kPieceLimit = seconds(30);
constexpr auto kIdleLimit = seconds(60);
constexpr auto kPartingLimit = seconds(2);

HttpReply refusal(int status, std::string_view code, std::string_view sentence) {
  return {.status = status,
          .body = R"({"error":{"code":")" + std::string(code) + R"(","sentence":")" + std::string(sentence) + "\"}}"};
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char letter) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  });
  return lower;
}

class HttpConnection final : public Connection, public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, std::string peer, std::shared_ptr<const HttpSurroundings> around)
      : stream_(std::move(socket)), peer_(std::move(peer)), around_(std::move(around)) {}

  void read_head(seconds limit) {
    parser_.emplace();
    parser_->header_limit(kLongestHeaders);
    parser_->body_limit(boost::none);  // each kind of body has its own
    sink_.reset();
    body_.clear();
    body_bytes_ = 0;
    stream_.expires_after(limit);
    http::async_read_header(stream_, incoming_, *parser_, [self = shared_from_this()](error_code fault, std::size_t) {
      if (!fault) return self->on_head();
      if (fault == http::error::header_limit) {
        return self->refuse(431, "HeadersTooLong", "The headers of a request may have 16 kB.");
      }
      const bool is_broken = fault.category() == make_error_code(http::error::bad_method).category() &&
                             fault != http::error::end_of_stream && fault != http::error::partial_message;
      if (is_broken) return self->refuse(400, "NotHttp", "This is not an HTTP request.");
      self->end();
    });
  }

  void end() override {
    sink_.reset();
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_both, ignored);
    stream_.close();
  }

 private:
  void on_head() {
    // A slow client gets time for each piece, not for all of them.
    stream_.expires_after(kPieceLimit);
    if (!take_head()) return refuse(400, "BadPath", "The address is not one that exists here.");
    if (beast::websocket::is_upgrade(parser_->get())) return upgrade();
    const bool has_body = parser_->chunked() || parser_->content_length().value_or(0) > 0;
    if (!has_body) return ask();
    auto how = around_->handler->on_body(request_);
    if (auto* reply = std::get_if<HttpReply>(&how)) return refuse(std::move(*reply));
    sink_ = std::move(std::get<std::unique_ptr<BodySink>>(how));
    most_bytes_ = sink_ ? kLongestUpload : kLongestHeldBody;
    if (parser_->content_length().value_or(0) > most_bytes_) return refuse_length();
    if (lower_case(request_.header("expect")) != "100-continue") return read_body();
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(stream_, asio::buffer(kContinue), [self = shared_from_this()](error_code fault, std::size_t) {
      fault ? self->end() : self->read_body();
    });
  }

  bool take_head() {
    const auto& head = parser_->get();
    auto target = parse_target({head.target().data(), head.target().size()});
    if (!target) return false;
    request_ = {.method = std::string(head.method_string()),
                .path = std::move(target->path),
                .query = std::move(target->query),
                .headers = {},
                .body = {},
                .peer = peer_};
    for (const auto& field : head) {
      request_.headers.insert_or_assign(lower_case(std::string(field.name_string())), std::string(field.value()));
    }
    return true;
  }

  void upgrade() {
    auto how = around_->handler->on_upgrade(request_);
    if (auto* reply = std::get_if<HttpReply>(&how)) return refuse(std::move(*reply));
    http::request<http::empty_body> head{http::request_header<>(parser_->get().base())};
    stream_.expires_never();
    around_->upgraded(open_channel(stream_.release_socket(), std::move(head), std::move(std::get<ChannelOpener>(how))));
  }

  void read_body() {
    auto& body = parser_->get().body();
    body.data = piece_.data();
    body.size = piece_.size();
    stream_.expires_after(kPieceLimit);
    http::async_read_some(stream_, incoming_, *parser_, [self = shared_from_this()](error_code fault, std::size_t) {
      if (fault && fault != http::error::need_buffer) return self->end();
      self->take_piece(self->piece_.size() - self->parser_->get().body().size);
    });
  }

  void take_piece(std::size_t bytes) {
    body_bytes_ += bytes;
    if (body_bytes_ > most_bytes_) return refuse_length();
    const std::string_view piece(piece_.data(), bytes);
    if (sink_) {
      if (auto reply = sink_->append(piece)) return refuse(*std::move(reply));
    } else {
      body_ += piece;
    }
    if (!parser_->is_done()) return read_body();
    if (!sink_) return ask();
    stream_.expires_never();
    sink_->finish(answer());
  }

  void ask() {
    request_.body = std::move(body_);
    stream_.expires_never();
    around_->handler->on_request(std::move(request_), answer());
  }

  Answer answer() {
    return [self = shared_from_this()](HttpReply reply) { self->reply(std::move(reply), self->parser_->keep_alive()); };
  }

  void refuse_length() {
    refuse(413, "TooLong", sink_ ? "A program may have 2 GB." : "What is sent here may have 1 MB.");
  }
  void refuse(int status, std::string_view code, std::string_view sentence) { refuse(refusal(status, code, sentence)); }
  /// The rest of the request is not read, so the connection ends behind it.
  void refuse(HttpReply reply) { this->reply(std::move(reply), false); }

  void reply(HttpReply reply, bool keep_alive) {
    sink_.reset();
    reply_ = std::move(reply);
    keep_alive_ = keep_alive;
    if (auto* source = std::get_if<std::shared_ptr<BodySource>>(&reply_.body)) return reply_from(*source);
    const std::string_view body = std::visit(
        [](const auto& text) -> std::string_view {
          if constexpr (std::is_convertible_v<decltype(text), std::string_view>) return text;
          return {};
        },
        reply_.body);
    response_.emplace();
    fill(*response_);
    response_->content_length(body.size());
    if (!is_head()) response_->body() = {body.data(), body.size()};
    stream_.expires_after(kPieceLimit);
    http::async_write(stream_, *response_,
                      [self = shared_from_this()](error_code fault, std::size_t) { self->on_replied(fault); });
  }

  template <typename Body>
  void fill(http::response<Body>& response) {
    response.version(parser_->get().version() == 10 ? 10 : 11);
    response.result(static_cast<unsigned>(reply_.status));
    response.set(http::field::server, "Kerf");
    if (!reply_.content_type.empty()) response.set(http::field::content_type, reply_.content_type);
    for (const auto& [name, value] : reply_.headers) response.set(name, value);
    response.keep_alive(keep_alive_);
  }

  [[nodiscard]] bool is_head() const { return parser_->get().method() == http::verb::head; }

  void reply_from(const std::shared_ptr<BodySource>& source) {
    chunked_.emplace();
    fill(*chunked_);
    chunked_->chunked(true);
    serializer_.emplace(*chunked_);
    stream_.expires_after(kPieceLimit);
    http::async_write_header(stream_, *serializer_, [self = shared_from_this(), source](error_code fault, std::size_t) {
      if (fault && fault != http::error::end_of_stream) return self->end();
      if (self->is_head()) return self->on_replied({});
      self->next_piece(source);
    });
  }

  void next_piece(const std::shared_ptr<BodySource>& source) {
    stream_.expires_never();
    around_->pool->run([self = shared_from_this(), source]() -> std::function<void()> {
      auto piece = source->next();
      return [self, source, piece = std::move(piece)]() mutable { self->write_piece(source, std::move(piece)); };
    });
  }

  void write_piece(const std::shared_ptr<BodySource>& source, std::optional<std::string> piece) {
    stream_.expires_after(kPieceLimit);
    if (!piece) {
      asio::async_write(stream_, http::make_chunk_last(),
                        [self = shared_from_this()](error_code fault, std::size_t) { self->on_replied(fault); });
      return;
    }
    outgoing_ = *std::move(piece);
    asio::async_write(stream_, http::make_chunk(asio::buffer(outgoing_)),
                      [self = shared_from_this(), source](error_code fault, std::size_t) {
                        fault ? self->end() : self->next_piece(source);
                      });
  }

  void on_replied(error_code fault) {
    reply_ = {};
    if (fault) return end();
    if (keep_alive_) return read_head(kIdleLimit);
    // To close on what was not read would reset the connection, and the reply might never arrive.
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(kPartingLimit);
    discard();
  }

  void discard() {
    stream_.async_read_some(asio::buffer(piece_), [self = shared_from_this()](error_code fault, std::size_t) {
      fault ? self->end() : self->discard();
    });
  }

  beast::tcp_stream stream_;
  const std::string peer_;
  const std::shared_ptr<const HttpSurroundings> around_;
  beast::flat_buffer incoming_;
  std::optional<http::request_parser<http::buffer_body>> parser_;
  HttpRequest request_;
  std::array<char, kPiece> piece_{};
  std::string body_;
  std::uint64_t body_bytes_ = 0;
  std::uint64_t most_bytes_ = 0;
  std::unique_ptr<BodySink> sink_;
  HttpReply reply_;
  bool keep_alive_ = false;
  std::optional<http::response<http::span_body<const char>>> response_;
  std::optional<http::response<http::empty_body>> chunked_;
  std::optional<http::response_serializer<http::empty_body>> serializer_;
  std::string outgoing_;
};

}  // namespace

std::shared_ptr<Connection> serve_http(tcp::socket socket, std::string peer,
                                       std::shared_ptr<const HttpSurroundings> around) {
  auto connection = std::make_shared<HttpConnection>(std::move(socket), std::move(peer), std::move(around));
  connection->read_head(kHeadLimit);
  return connection;
}

}  // namespace kerf::io::web
