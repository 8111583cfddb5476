#pragma once
// A wire that can be made to misbehave: bytes are lost, doubled, changed or late, as ordered and always in the same
// way.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"

namespace kerf::firmware {

enum class ByteFault : std::uint8_t { Drop, Duplicate, Corrupt, Delay };
inline constexpr std::size_t kByteFaults = 4;

/// What is to happen, to the next bytes or by chance. An order replaces the earlier one of its kind; one with neither
/// bytes nor rate ends it.
struct ByteFaultOrder {
  ByteFault kind{};
  std::size_t next_bytes = 0;
  double rate = 0;   ///< of all bytes from now on: 0.01 is one in a hundred
  Duration delay{};  ///< of ByteFault::Delay; a byte is never overtaken by a later one
};

/// Bytes that one fault hit one after another at one instant.
struct ByteFaultRecord {
  Instant at{};
  ByteFault kind{};
  std::uint64_t first = 0;  ///< the first one's number, counted from 1 in everything that this wire was given
  std::string bytes;        ///< as they were sent
  std::string became;       ///< of ByteFault::Corrupt: as they arrive
  std::string line_before;  ///< what was sent of the same line before the first one
};

/// One direction of a link. Without orders it hands over what it is given, at once. The same seed, orders and bytes
/// give the same faults, on every computer and however the bytes are cut into calls.
class ByteFaults {
 public:
  explicit ByteFaults(std::uint64_t seed) : random_(seed) {}

  void order(const ByteFaultOrder& order) { orders_.at(static_cast<std::size_t>(order.kind)) = order; }
  /// All orders end; bytes that are late still come.
  void end_orders() { orders_ = {}; }
  /// Chance begins again.
  void seed(std::uint64_t seed) { random_ = seed; }

  void send(Instant now, std::string_view bytes);
  [[nodiscard]] std::string take_arrived(Instant now);
  [[nodiscard]] Instant next_deadline() const { return packets_.empty() ? kNever : packets_.front().arrives_at; }
  [[nodiscard]] std::size_t bytes_on_the_way() const;
  /// Everything on its way is gone.
  void cut() { packets_.clear(); }
  [[nodiscard]] std::vector<ByteFaultRecord> take_records();

 private:
  struct Packet {
    Instant arrives_at;
    std::string bytes;
  };

  bool hits(ByteFault kind);
  [[nodiscard]] std::uint64_t draw();
  void send_byte(Instant now, char byte);
  void carry(Instant arrives_at, char byte);
  void record(Instant now, ByteFault kind, char byte, char became);

  std::array<ByteFaultOrder, kByteFaults> orders_{};
  std::uint64_t random_;
  std::uint64_t bytes_sent_ = 0;
  /// The line under way as it was sent, as far as anybody looks at it.
  std::string line_;
  std::deque<Packet> packets_;
  std::vector<ByteFaultRecord> records_;
};

}  // namespace kerf::firmware
