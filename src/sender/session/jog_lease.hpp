#pragma once
// Jogging for as long as somebody holds a button, who may vanish at any moment.
//
// A renewal of the lease is worth kGrantedMm: never more than that lies ahead of where the machine was last seen when
// the last renewal came. So a client that is lost moves the machine no further than that, at any speed, even if
// nobody notices; where it is noticed, or the lease runs out, the jog is cancelled on top of that. The price is speed:
// what the machine can do within that distance, and within the time between two reports.

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/axis.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

/// Where to, for each axis -1, 0 or +1 (or a part of it), by the letters of `axes`; and how fast.
struct JogWish {
  std::string axes = "XYZ";
  std::array<double, vocabulary::kMaxAxes> direction{};
  double feed_mm_per_min = 0;
  /// How far it is to the end of the travel in that direction; empty where nobody knows.
  std::optional<double> room_mm{};
};

class JogLease {
 public:
  static constexpr double kGrantedMm = 2.0;
  /// Renewals come every 50 ms.
  static constexpr Duration kRunsOutAfter = std::chrono::milliseconds(200);

  /// False where there is no direction, or the position is not known.
  [[nodiscard]] bool begin(Instant now, const JogWish& wish, const machine::Snapshot& snapshot);
  void renew(Instant now);
  void on_report(const machine::Snapshot& snapshot);
  void end() { is_held_ = false; }
  /// Ends the lease that was not renewed.
  void advance_to(Instant now);
  [[nodiscard]] Instant next_deadline() const { return is_held_ ? renewed_at_ + kRunsOutAfter : kNever; }
  [[nodiscard]] bool is_held() const { return is_held_; }

  /// The words of the next `$J=`, as far as there is something granted that was not sent; empty otherwise.
  [[nodiscard]] std::string take_words();

 private:
  [[nodiscard]] double travelled_mm(const machine::Snapshot& snapshot) const;

  JogWish wish_;
  bool is_held_ = false;
  Instant renewed_at_{};
  std::vector<double> from_mm_;
  double travelled_ = 0;
  double granted_ = 0;
  double sent_ = 0;
};

}  // namespace kerf::session
