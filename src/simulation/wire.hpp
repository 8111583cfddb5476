#pragma once
// One direction of a link in virtual time: what goes in comes out later, in order and unchanged.

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/time.hpp"

namespace kerf::simulation {

/// How bytes travel. A serial line takes ten bits a byte; a network carries what was written together, after its
/// latency.
struct WireTiming {
  /// Empty: no pacing.
  std::optional<int> baud{};
  Duration latency{};
};

/// How what arrives is cut into deliveries. The content and its order are the same either way.
enum class WireGrain {
  Byte,  ///< every byte at its own instant
  Line,  ///< up to a line end at the instant of its last byte; for a reader that acts on whole lines only
};

/// A first-in, first-out pipe with a schedule. Deterministic: the instants follow from what was sent and when.
class Wire {
 public:
  Wire(WireTiming timing, WireGrain grain) : timing_(timing), grain_(grain) {}

  void send(Instant now, std::string_view bytes);
  /// Everything that has arrived at `now`.
  [[nodiscard]] std::string take_arrived(Instant now);
  /// The next arrival; kNever when the wire is empty.
  [[nodiscard]] Instant next_deadline() const { return packets_.empty() ? kNever : packets_.front().arrives_at; }
  /// Everything on its way is gone.
  void cut();
  [[nodiscard]] std::size_t bytes_on_the_way() const { return bytes_; }

 private:
  struct Packet {
    Instant arrives_at;
    std::string bytes;
  };

  void add(Instant arrives_at, char byte, bool may_join);

  WireTiming timing_;
  WireGrain grain_;
  std::deque<Packet> packets_;
  std::size_t bytes_ = 0;
  /// The line is busy until then.
  Instant free_at_{Instant::min()};
};

}  // namespace kerf::simulation
