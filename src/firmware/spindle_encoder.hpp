#pragma once
// The encoder on the spindle: how often it has turned, and when its index comes (grblHAL).

#include <cmath>
#include <cstdint>
#include <optional>

#include "common/base/time.hpp"

namespace kerf::firmware {

/// Counts turns. The spindle comes to each new speed at once; which way it turns makes no difference.
class SpindleEncoder {
 public:
  /// From `now` on it turns with this speed.
  void turn(Instant now, double rpm) {
    turns_ = turns_at(now);
    since_ = now;
    rpm_ = rpm;
  }
  [[nodiscard]] double rpm() const { return rpm_; }
  [[nodiscard]] double turns_at(Instant now) const {
    return turns_ + base::to_seconds(now - since_) * rpm_ / kSecondsPerMinute;
  }
  /// How long until the index has passed `times` more; none while it stands.
  [[nodiscard]] std::optional<Duration> until_index(Instant now, int times) const {
    if (rpm_ <= 0) return std::nullopt;
    const double turns = turns_at(now);
    return base::from_seconds((std::floor(turns) + times - turns) * kSecondsPerMinute / rpm_);
  }

 private:
  static constexpr double kSecondsPerMinute = 60;

  double turns_ = 0;
  double rpm_ = 0;
  Instant since_{};
};

}  // namespace kerf::firmware
