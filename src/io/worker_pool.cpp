#include "io/worker_pool.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>

namespace kerf::io {
namespace {

constexpr unsigned kMostThreads = 4;

}  // namespace

struct WorkerPool::State {
  explicit State(EventLoop& owner)
      : loop(owner), threads(std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads)) {}

  EventLoop& loop;
  /// Only touched on the loop's thread: what comes back later is dropped there.
  bool is_open = true;
  boost::asio::thread_pool threads;
};

WorkerPool::WorkerPool(EventLoop& loop) : state_(std::make_shared<State>(loop)) {}

WorkerPool::~WorkerPool() {
  state_->is_open = false;
  state_->threads.stop();
  state_->threads.join();
}

void WorkerPool::run(std::function<std::function<void()>()> work) {
  boost::asio::post(state_->threads, [state = std::weak_ptr(state_), &loop = state_->loop, work = std::move(work)] {
    loop.post([state, found = work()] {
      const auto pool = state.lock();
      if (pool && pool->is_open && found) found();
    });
  });
}

}  // namespace kerf::io
