#pragma once
// Upload of files to the card by YModem, as a receiver that never asks first (grblHAL ymodem.c; protocol.md 9.3).

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/time.hpp"
#include "firmware/card.hpp"

namespace kerf::firmware {

/// CRC-16 of XModem and YModem: polynomial 0x1021, starting at 0.
[[nodiscard]] std::uint16_t crc16(std::string_view bytes);

/// Takes the bytes of one transfer, writes the file, and says what goes back. Only its time-outs need a clock.
///
///   block   := (SOH 128 bytes | STX 1024 bytes), as HEAD NUMBER ~NUMBER PAYLOAD CRC-HIGH CRC-LOW
///   block 0 := NAME NUL [LENGTH in decimal], or all NUL: there is no (more) file
///
/// A good block is answered by ACK (block 0 of a file by ACK and C), EOT by ACK and C. Anything wrong is followed by a
/// silence of a second, then NAK. CAN CAN ends it from either side. What was written until then stays on the card.
class YModem {
 public:
  /// True if this byte from the stream begins a transfer.
  [[nodiscard]] static bool begins(std::uint8_t byte);

  /// `card` is null while none is mounted; the file goes to `folder` if its name is not absolute.
  void begin(Instant now, std::shared_ptr<Card> card, std::string folder);
  [[nodiscard]] bool is_receiving() const { return is_receiving_; }
  /// The bytes to answer, if any.
  [[nodiscard]] std::string take(Instant now, std::uint8_t byte);
  [[nodiscard]] std::string advance(Instant now);
  [[nodiscard]] Instant next_deadline() const { return is_receiving_ ? silent_until_ : kNever; }
  /// A reset: the bytes to say.
  [[nodiscard]] std::string abort();
  /// True once after input that made no sense: unread input has to go.
  [[nodiscard]] bool take_purged() { return std::exchange(is_purged_, false); }

 private:
  enum class Stage : std::uint8_t {
    Head,
    Number,
    NumberInverted,
    Payload,
    CrcHigh,
    CrcLow,
    SecondCancel,
    EndOfFile,
    Purge,
  };

  std::string take_head(std::uint8_t byte);
  std::string take_number(std::uint8_t byte);
  std::string take_block();
  std::string open_file();
  std::string write_block();
  std::string purge();
  std::string refuse();

  std::shared_ptr<Card> card_;
  std::string folder_;
  std::string path_;
  std::uint64_t length_ = 0;  ///< as told; 0 if it was not
  std::uint64_t received_ = 0;
  std::string payload_;
  std::size_t block_bytes_ = 0;
  std::uint16_t crc_ = 0;
  std::uint8_t number_ = 0;
  int errors_ = 0;
  Stage stage_ = Stage::Head;
  Instant silent_until_{};
  bool is_receiving_ = false;
  bool is_purged_ = false;
};

}  // namespace kerf::firmware
