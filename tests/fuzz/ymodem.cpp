// Whatever bytes come, and whatever pauses are between them, a YModem receiver writes no more than it was sent, stays
// on the card, and ends.

#include "firmware/ymodem.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

// The byte 0xFE stands for half a second of silence, so that small inputs reach the time-outs too; 0xFD makes a block
// of what follows, with its right CRC, as chance does not find one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto card = std::make_shared<firmware::MemoryCard>();
  firmware::YModem receiver;
  Instant now{};
  std::uint8_t number = 0;
  std::size_t sent = 0;
  const auto take = [&](std::uint8_t byte) {
    if (!receiver.is_receiving()) receiver.begin(now, card, "/jobs");
    ++sent;
    require(receiver.take(now, byte).size() <= 2);
  };
  for (std::size_t at = 0; at < size; ++at) {
    if (bytes[at] == 0xFE) {
      now += std::chrono::milliseconds{500};
      require(receiver.advance(now).size() <= 2);
    } else if (bytes[at] == 0xFD) {
      std::string payload;
      while (payload.size() < 128 && ++at < size) payload += static_cast<char>(bytes[at]);
      payload.resize(128);
      const std::uint16_t crc = firmware::crc16(payload);
      take(0x01);
      take(number);
      take(static_cast<std::uint8_t>(~number++));
      for (const char byte : payload) take(static_cast<std::uint8_t>(byte));
      take(static_cast<std::uint8_t>(crc >> 8U));
      take(static_cast<std::uint8_t>(crc & 0xFFU));
    } else {
      take(bytes[at]);
      if (bytes[at] == 0x04) number = 0;
    }
  }
  for (int turn = 0; turn < 12; ++turn) static_cast<void>(receiver.advance(now += std::chrono::seconds{1}));
  require(!receiver.is_receiving());
  require(card->space().total_bytes - card->space().free_bytes <= sent);
  return 0;
}
