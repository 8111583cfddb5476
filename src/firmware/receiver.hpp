#pragma once
// The receive side of the wire: realtime bytes are picked out as they arrive, the rest waits in the receive buffer.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/ring.hpp"
#include "firmware/personality.hpp"

namespace kerf::firmware {

/// The receive buffer with its overflow policy. What does not fit is lost (protocol.md 1.3).
class Receiver {
 public:
  /// grblHAL's mark for a cancelled buffer: it takes a place in the buffer until the reader comes to it.
  static constexpr char kCancelMark = '\x18';

  explicit Receiver(const Personality& personality)
      : personality_(personality), ring_(static_cast<std::size_t>(personality.dialect().rx_bytes.usable)) {}

  /// How an arriving byte is treated.
  enum class Fate : std::uint8_t { Realtime, Buffered, Lost };

  /// What the line being read does to bytes that are no plain text (grblHAL protocol.c
  /// protocol_enqueue_realtime_command).
  struct LineContext {
    bool keeps_high_bytes = false;          ///< DEL and bytes from 0xC0 are text
    bool keeps_printable_commands = false;  ///< `?!~` are text
    bool drops_text = false;                ///< lines come from elsewhere
  };

  Fate take(std::uint8_t byte, LineContext context);

  [[nodiscard]] bool empty() const { return ring_.empty(); }
  [[nodiscard]] bool full() const { return ring_.full(); }
  [[nodiscard]] std::size_t free() const { return ring_.free(); }
  [[nodiscard]] char pop() { return ring_.pop_front(); }
  void clear() { ring_.clear(); }
  /// Empties the buffer and leaves the cancel mark in it.
  void cancel();
  /// Puts the unread bytes aside (grblHAL 0xA3) until restore().
  void set_aside();
  void restore();
  void forget_aside() { aside_.reset(); }

 private:
  const Personality& personality_;
  base::Ring<char> ring_;
  std::optional<std::string> aside_;
};

}  // namespace kerf::firmware
