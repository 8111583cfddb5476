#include "sender/session/jog_lease.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"

namespace kerf::session {
namespace {

/// Shorter ones would be lost in the rounding of steps, and cost a line each.
constexpr double kLeastPieceMm = 0.05;
/// At this pace a piece is a tenth of a second.
constexpr double kPiecesPerMinute = 600;

}  // namespace

bool JogLease::begin(Instant now, const JogWish& wish, const machine::Snapshot& snapshot) {
  double square = 0;
  for (const double part : wish.direction) square += part * part;
  const auto& at = snapshot.machine_position_mm;
  if (!(square > 0) || !std::isfinite(square) || !(wish.feed_mm_per_min > 0) || !at) return false;
  if (!std::isfinite(wish.feed_mm_per_min) || at->size() < wish.axes.size()) return false;
  *this = {};
  wish_ = wish;
  for (double& part : wish_.direction) part /= std::sqrt(square);
  from_mm_ = *at;
  is_held_ = true;
  renew(now);
  return true;
}

void JogLease::renew(Instant now) {
  if (!is_held_) return;
  renewed_at_ = now;
  granted_ = std::min(travelled_ + kGrantedMm, wish_.room_mm.value_or(travelled_ + kGrantedMm));
}

double JogLease::travelled_mm(const machine::Snapshot& snapshot) const {
  double along = 0;
  for (std::size_t axis = 0; axis < wish_.axes.size() && axis < snapshot.machine_position_mm->size(); ++axis) {
    along += ((*snapshot.machine_position_mm)[axis] - from_mm_[axis]) * wish_.direction.at(axis);
  }
  return along;
}

void JogLease::on_report(const machine::Snapshot& snapshot) {
  if (!is_held_ || !snapshot.machine_position_mm) return;
  // Never backwards, and never beyond what was sent: nobody else jogs.
  travelled_ = std::clamp(travelled_mm(snapshot), travelled_, std::max(sent_, travelled_));
}

void JogLease::advance_to(Instant now) {
  if (is_held_ && now >= next_deadline()) is_held_ = false;
}

std::string JogLease::take_words() {
  const double left = granted_ - sent_;
  const bool is_last_bit = wish_.room_mm && granted_ >= *wish_.room_mm;
  if (!is_held_ || left <= 0 || (left < kLeastPieceMm && !is_last_bit)) return {};
  const double piece = std::min(left, std::max(kLeastPieceMm, wish_.feed_mm_per_min / kPiecesPerMinute));
  sent_ += piece;
  std::string words = "G91G21";
  for (std::size_t axis = 0; axis < wish_.axes.size(); ++axis) {
    const double distance = piece * wish_.direction.at(axis);
    if (distance != 0) words += wish_.axes[axis] + base::to_fixed(distance, 4);
  }
  return words + "F" + base::to_fixed(wish_.feed_mm_per_min, 0);
}

}  // namespace kerf::session
