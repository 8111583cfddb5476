#pragma once
// Time as every part of Kerf knows it: a value that is passed in, never asked for.

#include <chrono>
#include <cmath>
#include <cstdint>

namespace kerf::base {

/// A clock without `now()`, so that the compiler refuses ambient time. Real time enters in `io/`, virtual time in
/// `simulation/`.
struct Clock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<Clock, duration>;
  static constexpr bool is_steady = true;
};

using Duration = Clock::duration;
using Instant = Clock::time_point;

/// The deadline of a part that needs no attention.
inline constexpr Instant kNever = Instant::max();

/// Nearest nanosecond to `seconds`; anything too long to count (about 292 years) becomes the longest duration.
[[nodiscard]] inline Duration from_seconds(double seconds) {
  constexpr double kLongest = 9.2e9;
  if (!(seconds < kLongest)) return Duration::max();
  return Duration{std::llround(seconds * 1e9)};
}

[[nodiscard]] constexpr double to_seconds(Duration duration) {
  return static_cast<double>(duration.count()) * 1e-9;
}

/// Seconds since the epoch of whoever started the clock.
[[nodiscard]] constexpr double to_seconds(Instant instant) {
  return to_seconds(instant.time_since_epoch());
}

}  // namespace kerf::base

namespace kerf {
using base::Duration;
using base::Instant;
using base::kNever;
}  // namespace kerf
