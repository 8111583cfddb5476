#pragma once
// HTTP and WebSockets on one port (Boost.Beast). Loop's thread only; bodies that are made piece by piece are made on
// the pool.
//
// What a client may cost is limited: headers 16 kB, bodies that are held 1 MB, uploads 2 GB; the head of a request has
// 10 s, each further piece 30 s, an idle connection 60 s; so many connections at a time, and what a WebSocket
// sends at once 64 kB.

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/server.hpp"
#include "io/web/http.hpp"
#include "io/worker_pool.hpp"

namespace kerf::io::web {

/// One WebSocket, as its server sees it. Text frames.
class Channel {
 public:
  Channel() = default;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;
  virtual ~Channel() = default;
  /// Queued; frames that many clients get are shared.
  virtual void send(std::shared_ptr<const std::string> text) = 0;
  /// What the client has not taken yet.
  [[nodiscard]] virtual std::size_t waiting_bytes() const = 0;
  virtual void close() = 0;
};

/// Who uses a channel. Destroyed when it is closed, from either end.
class ChannelUser {
 public:
  ChannelUser() = default;
  ChannelUser(const ChannelUser&) = delete;
  ChannelUser& operator=(const ChannelUser&) = delete;
  virtual ~ChannelUser() = default;
  virtual void on_text(std::string_view text) = 0;
  /// Everything that was queued is out.
  virtual void on_drained() = 0;
};

/// Makes the user of a channel that was opened; the channel lives longer than its user.
using ChannelOpener = std::function<std::unique_ptr<ChannelUser>(Channel&)>;

/// Who answers. Called on the loop's thread.
class WebHandler {
 public:
  WebHandler() = default;
  WebHandler(const WebHandler&) = delete;
  WebHandler& operator=(const WebHandler&) = delete;
  virtual ~WebHandler() = default;
  /// `answer` may be called later, once; where it never is, the client waits for nothing.
  virtual void on_request(HttpRequest request, Answer answer) = 0;
  /// Asked with the head of each request that has a body: a reply refuses it, a sink takes it; null: on_request() does.
  [[nodiscard]] virtual std::variant<std::unique_ptr<BodySink>, HttpReply> on_body(const HttpRequest& head) = 0;
  [[nodiscard]] virtual std::variant<ChannelOpener, HttpReply> on_upgrade(const HttpRequest& head) = 0;
};

class WebServer {
 public:
  /// `handler` and `pool` live longer than the server.
  WebServer(EventLoop& loop, WorkerPool& pool, WebHandler& handler);
  /// Closes every connection.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Listens; the port is filled in where it was 0.
  [[nodiscard]] std::expected<TcpAddress, ListenError> listen(const TcpAddress& address);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::io::web
