#include "firmware/receiver.hpp"

namespace kerf::firmware {

namespace {

constexpr std::uint8_t kDelete = 0x7F;
constexpr std::uint8_t kFirstKeptByte = 0xC0;

bool is_printable_realtime(std::uint8_t byte) {
  return byte == '?' || byte == '!' || byte == '~';
}

}  // namespace

Receiver::Fate Receiver::take(std::uint8_t byte, LineContext context) {
  const bool is_text = (context.keeps_printable_commands && is_printable_realtime(byte)) ||
                       (context.keeps_high_bytes && byte >= kFirstKeptByte);
  if (byte == kDelete && personality_.drops_delete && !context.keeps_high_bytes) return Fate::Lost;
  const bool is_realtime = !is_text && vocabulary::is_realtime(personality_.dialect(), byte);
  if (is_realtime && !(full() && personality_.full_buffer_drops_realtime)) return Fate::Realtime;
  if (is_realtime || context.drops_text || !ring().push_back(static_cast<char>(byte))) return Fate::Lost;
  return Fate::Buffered;
}

void Receiver::cancel() {
  ring().clear();
  static_cast<void>(ring().push_back(kCancelMark));
}

void Receiver::set_aside() {
  std::string bytes;
  while (!ring().empty()) bytes += ring().pop_front();
  aside_ = std::move(bytes);
}

void Receiver::restore() {
  if (!aside_) return;
  ring().clear();
  for (const char byte : *aside_) static_cast<void>(ring().push_back(byte));
  aside_.reset();
}

}  // namespace kerf::firmware
