#pragma once
// The event loop of a process: one thread, one clock, timers, signals and readable descriptors.
//
// Threads: everything here belongs to the thread that calls EventLoop::run(), except EventLoop::post() and stop(),
// which any thread may call. Callbacks run on the loop's thread, never inside the call that asked for them.

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "common/base/time.hpp"

namespace boost::asio {
class io_context;
}

namespace kerf::io {

class EventLoop {
 public:
  EventLoop();
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// The steady clock as an Instant: 0 is when this loop was made.
  [[nodiscard]] Instant now() const;

  /// Runs callbacks until stop().
  void run();
  void stop();
  /// Runs `callback` on the loop's thread, after what is already waiting.
  void post(std::function<void()> callback);

  /// For the files of io/ that include Asio.
  [[nodiscard]] boost::asio::io_context& context();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Calls back once at a moment; arming again replaces the moment.
class Timer {
 public:
  explicit Timer(EventLoop& loop);
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// A moment in the past calls back as soon as possible; kNever disarms.
  void arm(Instant at, std::function<void()> callback);
  void disarm();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Turns signals of this process into callbacks while it lives.
class SignalWatch {
 public:
  SignalWatch(EventLoop& loop, std::span<const int> signals, std::function<void(int)> callback);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// Says when a descriptor that somebody else owns can be read, or has ended. The descriptor stays in blocking mode,
/// because a terminal is shared with the shell. A regular file, which the kernel cannot watch, is always readable.
class ReadableWatch {
 public:
  ReadableWatch(EventLoop& loop, int descriptor, std::function<void()> readable);
  ~ReadableWatch();
  ReadableWatch(const ReadableWatch&) = delete;
  ReadableWatch& operator=(const ReadableWatch&) = delete;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::io
