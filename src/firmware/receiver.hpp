#pragma once
// The receive side of the wire: realtime bytes are picked out as they arrive, the rest waits in the receive buffer.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/ring.hpp"
#include "firmware/personality.hpp"
#include "firmware/port.hpp"

namespace kerf::firmware {

/// The receive buffer of each wire with its overflow policy. What does not fit is lost (protocol.md 1.3). Everything is
/// about the wire in command, unless a port is named.
class Receiver {
 public:
  /// grblHAL's mark for a cancelled buffer: it takes a place in the buffer until the reader comes to it.
  static constexpr char kCancelMark = '\x18';

  explicit Receiver(const Personality& personality)
      : personality_(personality), rings_{new_ring(personality), new_ring(personality)} {}

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

  [[nodiscard]] bool empty() const { return ring(in_command_).empty(); }
  [[nodiscard]] bool full() const { return ring(in_command_).full(); }
  [[nodiscard]] std::size_t free() const { return free(in_command_); }
  [[nodiscard]] std::size_t free(Port port) const { return ring(port).free(); }
  [[nodiscard]] char pop() { return ring().pop_front(); }
  void clear() { ring().clear(); }
  /// From now on lines come from there; the other wire is deaf, and keeps what it had.
  void put_in_command(Port port) { in_command_ = port; }
  /// Empties the buffer and leaves the cancel mark in it.
  void cancel();
  /// Puts the unread bytes aside (grblHAL 0xA3) until restore().
  void set_aside();
  void restore();
  void forget_aside() { aside_.reset(); }

 private:
  using Ring = base::Ring<char>;

  [[nodiscard]] static Ring new_ring(const Personality& personality) {
    return Ring(static_cast<std::size_t>(personality.dialect().rx_bytes.usable));
  }
  [[nodiscard]] Ring& ring() { return rings_.at(static_cast<std::size_t>(in_command_)); }
  [[nodiscard]] const Ring& ring(Port port) const { return rings_.at(static_cast<std::size_t>(port)); }

  const Personality& personality_;
  std::array<Ring, kPorts> rings_;
  Port in_command_ = Port::Main;
  std::optional<std::string> aside_;
};

}  // namespace kerf::firmware
