#include "firmware/ymodem.hpp"

#include <chrono>

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

constexpr std::uint8_t kStartOfHeading = 0x01;
constexpr std::uint8_t kStartOfText = 0x02;
constexpr std::uint8_t kEndOfTransmission = 0x04;
constexpr std::uint8_t kCancel = 0x18;
constexpr std::string_view kAcknowledged = "\x06";
constexpr std::string_view kAcknowledgedNext =
    "\x06"
    "C";
constexpr std::string_view kRefused = "\x15";
constexpr std::string_view kCancelled = "\x18\x18";

constexpr std::size_t kShortBlock = 128;
constexpr std::size_t kLongBlock = 1024;
/// A longer name does not fit into ymodem.c's memory.
constexpr std::size_t kLongestName = 31;
constexpr int kMostErrors = 10;
constexpr std::chrono::seconds kSilence{1};

}  // namespace

std::uint16_t crc16(std::string_view bytes) {
  constexpr unsigned kPolynomial = 0x1021;
  constexpr unsigned kTopBit = 0x8000;
  constexpr int kBitsInByte = 8;
  unsigned crc = 0;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned>(static_cast<std::uint8_t>(byte)) << 8U;
    for (int bit = 0; bit < kBitsInByte; ++bit) crc = (crc & kTopBit) != 0 ? (crc << 1U) ^ kPolynomial : crc << 1U;
  }
  return static_cast<std::uint16_t>(crc & 0xFFFFU);
}

bool YModem::begins(std::uint8_t byte) {
  return byte == kStartOfHeading || byte == kStartOfText;
}

void YModem::begin(Instant now, std::shared_ptr<Card> card, std::string folder) {
  *this = {};
  card_ = std::move(card);
  folder_ = std::move(folder);
  silent_until_ = now + kSilence;
  is_receiving_ = true;
}

std::string YModem::take(Instant now, std::uint8_t byte) {
  silent_until_ = now + kSilence;
  switch (stage_) {
    case Stage::Head: return take_head(byte);
    case Stage::Number:
    case Stage::NumberInverted: return take_number(byte);
    case Stage::Payload:
      payload_ += static_cast<char>(byte);
      if (payload_.size() == block_bytes_) stage_ = Stage::CrcHigh;
      return {};
    case Stage::CrcHigh:
      crc_ = static_cast<std::uint16_t>(byte << 8U);
      stage_ = Stage::CrcLow;
      return {};
    case Stage::CrcLow:
      crc_ = static_cast<std::uint16_t>(crc_ | byte);
      stage_ = Stage::Head;
      return take_block();
    case Stage::SecondCancel:
      if (byte == kCancel) is_receiving_ = false;
      stage_ = Stage::Head;
      return {};
    case Stage::EndOfFile: return byte == kEndOfTransmission ? take_head(byte) : std::string{};
    case Stage::Purge: return {};
  }
  return {};
}

std::string YModem::take_head(std::uint8_t byte) {
  switch (byte) {
    case kStartOfHeading:
    case kStartOfText:
      block_bytes_ = byte == kStartOfHeading ? kShortBlock : kLongBlock;
      payload_.clear();
      stage_ = Stage::Number;
      return {};
    case kEndOfTransmission: is_receiving_ = false; return std::string{kAcknowledgedNext};
    case kCancel: stage_ = Stage::SecondCancel; return {};
    default: return purge();
  }
}

std::string YModem::take_number(std::uint8_t byte) {
  if (stage_ == Stage::Number) {
    // ymodem.c lets one number too many pass here, for a repeated block; the inverse then refuses it.
    if (byte != number_ && byte != number_ + 1) return purge();
    stage_ = Stage::NumberInverted;
    return {};
  }
  if (static_cast<std::uint8_t>(~byte) != number_) return purge();
  stage_ = Stage::Payload;
  return {};
}

std::string YModem::take_block() {
  if (crc16(payload_) != crc_) return purge();
  const bool is_header = number_ == 0 && path_.empty();
  ++number_;
  return is_header ? open_file() : write_block();
}

std::string YModem::open_file() {
  const std::size_t name_ends = payload_.find('\0');
  if (name_ends == 0) {
    is_receiving_ = false;
    return std::string{kAcknowledged};
  }
  if (name_ends == std::string::npos || name_ends > kLongestName) return refuse();
  std::size_t digits = name_ends + 1;
  while (digits < payload_.size() && base::is_digit(payload_[digits])) ++digits;
  length_ = base::parse_int<std::uint64_t>(std::string_view{payload_}.substr(name_ends + 1, digits - name_ends - 1))
                .value_or(0);
  path_ = card_path(folder_, std::string_view{payload_}.substr(0, name_ends));
  if (card_ == nullptr || !card_->create(path_)) return refuse();
  errors_ = 0;
  return std::string{kAcknowledgedNext};
}

std::string YModem::write_block() {
  std::string_view bytes = payload_;
  received_ += bytes.size();
  const bool is_complete = length_ != 0 && received_ > length_;
  if (is_complete) {
    const std::uint64_t excess = received_ - length_;
    if (excess >= bytes.size()) return refuse();
    bytes.remove_suffix(static_cast<std::size_t>(excess));
  }
  if (!card_->append(path_, bytes)) return refuse();
  if (is_complete) stage_ = Stage::EndOfFile;
  errors_ = 0;
  return std::string{kAcknowledged};
}

std::string YModem::purge() {
  ++errors_;
  stage_ = Stage::Purge;
  is_purged_ = true;
  return {};
}

std::string YModem::refuse() {
  is_receiving_ = false;
  return std::string{kCancelled};
}

std::string YModem::advance(Instant now) {
  if (!is_receiving_ || now < silent_until_) return {};
  silent_until_ = now + kSilence;
  ++errors_;
  if (errors_ > kMostErrors) {
    is_receiving_ = false;
    return {};
  }
  stage_ = Stage::Head;
  return std::string{kRefused};
}

std::string YModem::abort() {
  return is_receiving_ ? refuse() : std::string{};
}

}  // namespace kerf::firmware
