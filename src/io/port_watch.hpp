#pragma once
// Says when a serial port comes or goes. Loop's thread only.

#include <functional>
#include <memory>

#include "io/event_loop.hpp"

namespace kerf::io {

/// Costs nothing while no port comes or goes. On a computer without udev it stays silent.
class PortWatch {
 public:
  /// `changed` is called after udev has given a port its names and rights, or has taken them away.
  PortWatch(EventLoop& loop, std::function<void()> changed);
  ~PortWatch();
  PortWatch(const PortWatch&) = delete;
  PortWatch& operator=(const PortWatch&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf::io
