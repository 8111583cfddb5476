#include "io/event_loop.hpp"

#include <chrono>
#include <cstdint>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

namespace kerf::io {

namespace asio = boost::asio;
using SteadyClock = std::chrono::steady_clock;

struct EventLoop::State {
  asio::io_context context{1};  // one thread: Asio leaves its locks out
  SteadyClock::time_point began = SteadyClock::now();
};

EventLoop::EventLoop() : state_(std::make_unique<State>()) {}
EventLoop::~EventLoop() = default;

Instant EventLoop::now() const {
  return Instant{SteadyClock::now() - state_->began};
}

void EventLoop::run() {
  const auto keep_running = asio::make_work_guard(state_->context);
  state_->context.restart();
  state_->context.run();
}

void EventLoop::stop() {
  state_->context.stop();
}

void EventLoop::post(std::function<void()> callback) {
  asio::post(state_->context, std::move(callback));
}

asio::io_context& EventLoop::context() {
  return state_->context;
}

/// A stream of bytes arms its timer anew thousands of times a second, mostly for the same or a later moment. The system
/// is told only of an earlier one: a wait that ends too early begins anew.
struct Timer::State : std::enable_shared_from_this<Timer::State> {
  explicit State(EventLoop& owner) : loop(owner), timer(owner.context()) {}

  void wait_until(Instant at) {
    waits_until = at;
    timer.expires_after(at - loop.now());
    timer.async_wait([self = shared_from_this(), mine = ++waits](boost::system::error_code) {
      // One that was replaced may be queued already.
      if (self->waits == mine) self->wake();
    });
  }

  void wake() {
    waits_until = kNever;
    if (wanted_at == kNever) return;
    if (loop.now() < wanted_at) return wait_until(wanted_at);
    wanted_at = kNever;
    const auto running = std::exchange(callback, nullptr);
    running();
  }

  EventLoop& loop;
  asio::steady_timer timer;
  std::function<void()> callback;
  Instant wanted_at = kNever;
  Instant waits_until = kNever;
  std::uint64_t waits = 0;
};

Timer::Timer(EventLoop& loop) : state_(std::make_shared<State>(loop)) {}
Timer::~Timer() {
  disarm();
  state_->timer.cancel();
}

void Timer::arm(Instant at, std::function<void()> callback) {
  if (at == kNever) return disarm();
  state_->wanted_at = at;
  state_->callback = std::move(callback);
  if (at < state_->waits_until) state_->wait_until(at);
}

void Timer::disarm() {
  state_->wanted_at = kNever;
  state_->callback = nullptr;
}

struct SignalWatch::State : std::enable_shared_from_this<SignalWatch::State> {
  State(EventLoop& loop, std::function<void(int)> on_signal)
      : signals(loop.context()), callback(std::move(on_signal)) {}

  void wait() {
    signals.async_wait([self = shared_from_this()](boost::system::error_code fault, int signal) {
      if (fault || !self->callback) return;
      self->callback(signal);
      self->wait();
    });
  }

  asio::signal_set signals;
  std::function<void(int)> callback;
};

SignalWatch::SignalWatch(EventLoop& loop, std::span<const int> signals, std::function<void(int)> callback)
    : state_(std::make_shared<State>(loop, std::move(callback))) {
  for (const int signal : signals) state_->signals.add(signal);
  state_->wait();
}

SignalWatch::~SignalWatch() {
  state_->callback = nullptr;
  boost::system::error_code ignored;
  state_->signals.cancel(ignored);
}

struct ReadableWatch::State : std::enable_shared_from_this<ReadableWatch::State> {
  State(EventLoop& owner, int fd, std::function<void()> on_readable)
      : loop(owner), descriptor(owner.context()), readable(std::move(on_readable)) {
    boost::system::error_code fault;
    descriptor.assign(fd, fault);
    can_watch = !fault;
  }

  void wait() {
    if (!can_watch) {
      loop.post([self = shared_from_this()] { self->call(); });
      return;
    }
    descriptor.async_wait(asio::posix::stream_descriptor::wait_read,
                          [self = shared_from_this()](boost::system::error_code fault) {
                            if (fault == asio::error::operation_aborted) return;
                            if (fault) self->can_watch = false;
                            self->call();
                          });
  }

  void call() {
    if (!readable) return;
    // The callback may destroy the watch, and with it the function that is running.
    const auto running = readable;
    running();
    if (readable) wait();
  }

  EventLoop& loop;
  asio::posix::stream_descriptor descriptor;
  std::function<void()> readable;
  bool can_watch = true;
};

ReadableWatch::ReadableWatch(EventLoop& loop, int descriptor, std::function<void()> readable)
    : state_(std::make_shared<State>(loop, descriptor, std::move(readable))) {
  state_->wait();
}

ReadableWatch::~ReadableWatch() {
  state_->readable = nullptr;
  if (state_->descriptor.is_open()) state_->descriptor.release();
}

}  // namespace kerf::io
