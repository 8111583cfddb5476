#pragma once
// Threads for slow pure work: reading, checking, rehearsing, drawing. What they find comes back to the loop's thread.

#include <functional>
#include <memory>

#include "io/event_loop.hpp"

namespace kerf::io {

/// Made, used and destroyed on the loop's thread. The destructor waits for what is being worked on, and forgets what
/// was not begun.
class WorkerPool {
 public:
  /// As many threads as the computer has cores, but at least one and at most four.
  explicit WorkerPool(EventLoop& loop);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Runs `work` on a thread, and what it returns on the loop's. An empty function ends there.
  void run(std::function<std::function<void()>()> work);

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace kerf::io
