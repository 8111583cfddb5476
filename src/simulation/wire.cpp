#include "simulation/wire.hpp"

#include <algorithm>
#include <cstdint>

namespace kerf::simulation {
namespace {

constexpr std::int64_t kBitsPerByte = 10;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

void Wire::add(Instant arrives_at, char byte, bool may_join) {
  ++bytes_;
  if (may_join && !packets_.empty()) {
    packets_.back().arrives_at = arrives_at;
    packets_.back().bytes += byte;
    return;
  }
  packets_.push_back({.arrives_at = arrives_at, .bytes = std::string(1, byte)});
}

void Wire::send(Instant now, std::string_view bytes) {
  const Duration byte_time{timing_.baud ? kBitsPerByte * kNanosecondsPerSecond / *timing_.baud : 0};
  bool first = true;
  for (const char byte : bytes) {
    free_at_ = std::max(free_at_, now) + byte_time;
    const bool same_write = !first && byte_time == Duration{};
    const bool same_line = grain_ == WireGrain::Line && !packets_.empty() && !packets_.back().bytes.ends_with('\n');
    add(free_at_ + timing_.latency, byte, same_write || same_line);
    first = false;
  }
}

std::string Wire::take_arrived(Instant now) {
  std::string arrived;
  while (!packets_.empty() && packets_.front().arrives_at <= now) {
    arrived += packets_.front().bytes;
    packets_.pop_front();
  }
  bytes_ -= arrived.size();
  return arrived;
}

void Wire::cut() {
  packets_.clear();
  bytes_ = 0;
}

}  // namespace kerf::simulation
