#pragma once
// Memory that takes milliseconds a byte, during which the controller is deaf.

#include <algorithm>

#include "common/base/time.hpp"

namespace kerf::firmware {

/// The EEPROM of an AVR: each byte that changes is written with interrupts off, so what arrives meanwhile is lost, but
/// for the bytes that the UART itself holds (protocol.md 10 row 31; gnea/grbl eeprom.c).
class SlowMemory {
 public:
  /// A `byte_time` of zero is memory that is written in no time.
  explicit SlowMemory(Duration byte_time) : byte_time_(byte_time) {}

  void write(Instant now, int bytes) {
    if (byte_time_ > Duration::zero()) busy_until_ = std::max(now, busy_until_) + bytes * byte_time_;
  }
  [[nodiscard]] bool is_busy(Instant now) const { return now < busy_until_; }
  [[nodiscard]] Instant busy_until() const { return busy_until_; }

  /// A byte arrives: false if it is lost.
  [[nodiscard]] bool hears(Instant now) {
    if (!is_busy(now)) return true;
    const auto left = (busy_until_ - now - Duration{1}) / byte_time_;
    if (left != slot_) held_ = 0;
    slot_ = left;
    return ++held_ <= kHeldByUart;
  }

 private:
  static constexpr int kHeldByUart = 2;

  Duration byte_time_;
  Instant busy_until_{};
  Duration::rep slot_ = -1;
  int held_ = 0;
};

}  // namespace kerf::firmware
