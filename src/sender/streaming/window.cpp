#include "sender/streaming/window.hpp"

#include <algorithm>

namespace kerf::streaming {

std::size_t window_bytes(std::size_t rx_usable, const LinkPace& pace) {
  // A full buffer may keep out realtime bytes (Rabbit GRBL): if a hold then also keeps the lines in it, nothing is
  // heard any more, not even a reset.
  std::size_t window = std::max<std::size_t>(rx_usable, 2) - 1;
  if (pace.network) window = std::min(window, kNetworkWindowBytes);
  if (pace.baud) {
    const double bytes = *pace.baud / 10.0 * base::to_seconds(kMostAheadOfHold);
    window = std::min(window, static_cast<std::size_t>(std::max(bytes, 1.0)));
  }
  return window;
}

}  // namespace kerf::streaming
