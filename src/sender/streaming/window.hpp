#pragma once
// How many bytes may be on their way at once.

#include <cstddef>
#include <optional>

#include <boost/describe.hpp>

#include "common/base/time.hpp"

namespace kerf::streaming {

/// What limits a link besides the controller's buffer.
struct LinkPace {
  /// Bits a second of a real serial line, ten of which make a byte; empty where the rate means nothing.
  std::optional<int> baud{};
  /// Realtime bytes wait behind everything sent before them (protocol.md 2 and 11, rule 12).
  bool network = false;
};
BOOST_DESCRIBE_STRUCT(LinkPace, (), (baud, network))

/// Bytes given to the kernel cannot be overtaken: no more than this may lie ahead of a feed hold on a serial line.
inline constexpr Duration kMostAheadOfHold = std::chrono::milliseconds{25};
inline constexpr std::size_t kNetworkWindowBytes = 256;

/// The window for a controller that can take `rx_usable` unanswered bytes. The streamer sends a single line that is
/// longer than the window when nothing else is on its way, so a slow line never blocks.
[[nodiscard]] std::size_t window_bytes(std::size_t rx_usable, const LinkPace& pace);

}  // namespace kerf::streaming
