#include "firmware/byte_faults.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kerf::firmware {
namespace {

constexpr int kBits = 8;
/// Longer than any line that firmware takes.
constexpr std::size_t kLongestLine = 256;

}  // namespace

std::uint64_t ByteFaults::draw() {
  // SplitMix64: eight bytes of state, and the same numbers on every platform.
  random_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t mixed = random_;
  mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBULL;
  return mixed ^ (mixed >> 31U);
}

bool ByteFaults::hits(ByteFault kind) {
  ByteFaultOrder& order = orders_.at(static_cast<std::size_t>(kind));
  if (order.next_bytes > 0) {
    --order.next_bytes;
    return true;
  }
  constexpr double kDraws = 1.0 / 9007199254740992.0;  // 2^-53: what a double holds
  return order.rate > 0 && static_cast<double>(draw() >> 11U) * kDraws < order.rate;
}

void ByteFaults::send(Instant now, std::string_view bytes) {
  for (const char byte : bytes) {
    ++bytes_sent_;
    send_byte(now, byte);
    if (byte == '\r' || byte == '\n') {
      line_.clear();
    } else if (line_.size() < kLongestLine) {
      line_ += byte;
    }
  }
}

void ByteFaults::send_byte(Instant now, char byte) {
  if (hits(ByteFault::Drop)) {
    record(now, ByteFault::Drop, byte, byte);
    return;
  }
  char carried = byte;
  if (hits(ByteFault::Corrupt)) {
    carried = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << (draw() % kBits)));
    record(now, ByteFault::Corrupt, byte, carried);
  }
  Instant arrives_at = now;
  if (hits(ByteFault::Delay)) {
    arrives_at += orders_.at(static_cast<std::size_t>(ByteFault::Delay)).delay;
    record(now, ByteFault::Delay, byte, byte);
  }
  carry(arrives_at, carried);
  if (hits(ByteFault::Duplicate)) {
    record(now, ByteFault::Duplicate, byte, byte);
    carry(arrives_at, carried);
  }
}

void ByteFaults::carry(Instant arrives_at, char byte) {
  if (packets_.empty() || packets_.back().arrives_at < arrives_at) {
    packets_.push_back({.arrives_at = arrives_at, .bytes = std::string(1, byte)});
  } else {
    packets_.back().bytes += byte;
  }
}

void ByteFaults::record(Instant now, ByteFault kind, char byte, char became) {
  const auto continues = [&](const ByteFaultRecord& last) {
    return last.kind == kind && last.at == now && last.first + last.bytes.size() == bytes_sent_;
  };
  if (records_.empty() || !continues(records_.back())) {
    records_.push_back(
        {.at = now, .kind = kind, .first = bytes_sent_, .bytes = {}, .became = {}, .line_before = line_});
  }
  records_.back().bytes += byte;
  if (kind == ByteFault::Corrupt) records_.back().became += became;
}

std::string ByteFaults::take_arrived(Instant now) {
  std::string arrived;
  while (!packets_.empty() && packets_.front().arrives_at <= now) {
    arrived += packets_.front().bytes;
    packets_.pop_front();
  }
  return arrived;
}

std::size_t ByteFaults::bytes_on_the_way() const {
  return std::accumulate(packets_.begin(), packets_.end(), std::size_t{0},
                         [](std::size_t sum, const Packet& packet) { return sum + packet.bytes.size(); });
}

std::vector<ByteFaultRecord> ByteFaults::take_records() {
  return std::exchange(records_, {});
}

}  // namespace kerf::firmware
