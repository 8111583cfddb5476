// The rule about rapids and the stock: how high it is, nobody says, but what was cut stood there before.

#include <algorithm>
#include <cmath>
#include <limits>

#include "rehearsal/check_rules.hpp"

namespace kerf::rehearsal {
namespace {

constexpr float kFieldMm = 2.0F;
/// Fields in a row of the grid, a power of two: 512 mm, then it begins again.
constexpr std::size_t kFields = 256;
constexpr std::size_t kMostSuspects = 16;
/// Cuts that are longer are marked in steps of this many fields.
constexpr int kMostSteps = 4096;

std::size_t field_at(float x_mm, float y_mm) {
  const auto wrapped = [](float mm) -> std::size_t {
    constexpr auto kRow = static_cast<float>(kFields);
    const float field = std::fmod(std::floor(mm / kFieldMm), kRow);
    // Numbers without end have no place.
    if (!std::isfinite(field)) return 0;
    return static_cast<std::size_t>(field < 0 ? field + kRow : field);
  };
  return wrapped(y_mm) * kFields + wrapped(x_mm);
}

/// Fields along a way, as far as they are marked.
int steps_along(float mm) {
  const float fields = mm / kFieldMm;
  return fields < static_cast<float>(kMostSteps) ? static_cast<int>(fields) : kMostSteps;
}

}  // namespace

HeightRule::HeightRule(const CheckMachine& machine)
    : is_on_(!machine.is_laser && !machine.reader.settings().lathe_mode) {
  if (is_on_) deepest_mm_.resize(kFields * kFields, std::numeric_limits<float>::max());
}

void HeightRule::forget() {
  highest_cut_mm_.reset();
  suspects_.clear();
  is_in_cut_ = false;
  std::ranges::fill(deepest_mm_, std::numeric_limits<float>::max());
}

void HeightRule::mark(float x_mm, float y_mm, float z_mm) {
  float& deepest = deepest_mm_[field_at(x_mm, y_mm)];
  deepest = std::min(deepest, z_mm);
}

/// Along the straight way; of an arc also along its circle.
void HeightRule::mark_cut(const CheckedMove& move) {
  const AxisValues& from = move.from_mm;
  const AxisValues& to = move.to_mm;
  const float deepest = std::min(from[kZ], to[kZ]);
  if (move.arc != nullptr && move.arc->plane == gcode::Plane::XY) {
    const float center_x = from[0] + move.arc->center_offset_mm[0];
    const float center_y = from[1] + move.arc->center_offset_mm[1];
    const float radius = std::hypot(move.arc->center_offset_mm[0], move.arc->center_offset_mm[1]);
    constexpr float kTurn = 6.2831853F;
    const int steps = std::max(steps_along(radius * kTurn), 1);
    // The rest of the circle is marked too where less than a turn is cut: then a finding may be missed.
    for (int step = 0; step < steps; ++step) {
      const float angle = kTurn * static_cast<float>(step) / static_cast<float>(steps);
      mark(center_x + radius * std::cos(angle), center_y + radius * std::sin(angle), deepest);
    }
  }
  const float length = std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
  const int steps = steps_along(length);
  for (int step = 1; step <= steps; ++step) {
    const float share = static_cast<float>(step) / static_cast<float>(steps + 1);
    mark(from[0] + (to[0] - from[0]) * share, from[1] + (to[1] - from[1]) * share,
         from[kZ] + (to[kZ] - from[kZ]) * share);
  }
  mark(to[0], to[1], to[kZ]);
}

bool HeightRule::is_cut(const AxisValues& place_mm) const {
  for (const float y : {-kFieldMm, 0.0F, kFieldMm}) {
    for (const float x : {-kFieldMm, 0.0F, kFieldMm}) {
      if (deepest_mm_[field_at(place_mm[0] + x, place_mm[1] + y)] <= place_mm[kZ] + kSameHeightMm) return true;
    }
  }
  return false;
}

bool HeightRule::goes_sideways_in_stock(const CheckedMove& move, float height_mm) const {
  if (is_in_cut_) return true;
  if (highest_cut_mm_ && height_mm <= *highest_cut_mm_ + kSameHeightMm) return true;
  const bool knows_zero = has_axis(move.known_from, kZ) && has_axis(move.known_to, kZ);
  return knows_zero && has_moved_z_ && height_mm - move.work_offset_mm[kZ] < -kSameHeightMm;
}

/// Where nothing has been cut yet, only a later cut shows what stood in the way; the lowest rapids tell.
void HeightRule::suspect(const CheckedMove& move, float height_mm) {
  const float work_mm = height_mm - move.work_offset_mm[kZ];
  // The tool stands on the work, as it was left when its zero was set, and goes across before it goes up.
  if (!has_moved_z_ && !first_across_ && has_axis(move.known_from, kZ) && work_mm <= kSameHeightMm) {
    first_across_ = Suspect{.line = RememberedLine(move.line), .height_mm = height_mm, .work_mm = work_mm};
    return;
  }
  if (suspects_.size() >= kMostSuspects || (!suspects_.empty() && suspects_.back().height_mm <= height_mm)) return;
  suspects_.push_back({.line = RememberedLine(move.line), .height_mm = height_mm, .work_mm = work_mm});
}

void HeightRule::on_rapid(const CheckedMove& move, Findings& findings) {
  const float from = move.from_mm[kZ];
  const float to = move.to_mm[kZ];
  const float zero = move.work_offset_mm[kZ];
  if (move.goes_sideways()) {
    const float height = std::min(from, to);
    if (!goes_sideways_in_stock(move, height)) {
      suspect(move, height);
    } else {
      findings.add(FindingKind::RapidBelowCut, move.line.number, move.line.text, [&] {
        const std::string at = "It goes across at " + place_on(kZ, height - zero);
        if (!highest_cut_mm_) return at + ", below the work zero.";
        return at + "; the highest cut so far is at " + place_on(kZ, *highest_cut_mm_ - zero) + ".";
      });
    }
  } else if (to < from - kSameHeightMm) {
    check_descent(move, findings);
  }
}

void HeightRule::check_descent(const CheckedMove& move, Findings& findings) const {
  const float to = move.to_mm[kZ];
  const float zero = move.work_offset_mm[kZ];
  const bool is_below_cut = highest_cut_mm_ && to < *highest_cut_mm_ - kSameHeightMm;
  const bool is_below_zero = has_axis(move.known_to, kZ) && to - zero < -kSameHeightMm;
  if ((!is_below_cut && !is_below_zero) || is_cut(move.to_mm)) return;
  findings.add(FindingKind::RapidIntoStock, move.line.number, move.line.text, [&] {
    return "It goes down to " + place_on(kZ, to - zero) +
           (is_below_zero ? ", below the work zero." : ", below the highest cut so far.");
  });
}

void HeightRule::on_feed(const CheckedMove& move) {
  if (move.kind == MoveKind::Cut) {
    const float height = std::min(move.from_mm[kZ], move.to_mm[kZ]);
    highest_cut_mm_ = std::max(highest_cut_mm_.value_or(height), height);
  }
  if (move.kind != MoveKind::Air) mark_cut(move);
}

void HeightRule::on_move(const CheckedMove& move, Findings& findings) {
  if (!is_on_) return;
  if (move.frame != frame_) forget();
  frame_ = move.frame;
  const bool becomes_known = has_axis(move.known_to, kZ) && !has_axis(move.known_from, kZ);
  if (becomes_known && !has_axis(move.lost_from, kZ)) forget();
  if (becomes_known || has_axis(move.lost_to, kZ) || has_axis(move.lost_from, kZ)) {
    is_in_cut_ = false;
    has_moved_z_ = has_moved_z_ || becomes_known;
    if (becomes_known && move.kind == MoveKind::Rapid) check_descent(move, findings);
    return;
  }
  has_moved_z_ = has_moved_z_ || move.to_mm[kZ] != move.from_mm[kZ];
  if (move.kind == MoveKind::Rapid) {
    on_rapid(move, findings);
  } else {
    on_feed(move);
  }
  const bool cuts = move.kind == MoveKind::Cut || move.kind == MoveKind::Plunge;
  is_in_cut_ = cuts || (is_in_cut_ && move.to_mm[kZ] <= move.from_mm[kZ] + kSameHeightMm);
}

void HeightRule::at_end(Findings& findings) {
  if (!highest_cut_mm_) return;
  if (first_across_) {
    findings.add(FindingKind::RapidBelowCut, first_across_->line.number, first_across_->line.text, [&] {
      return "The tool stands at " + place_on(kZ, first_across_->work_mm) + ", and goes across before it goes up.";
    });
  }
  for (const Suspect& suspect : suspects_) {
    const float below_mm = *highest_cut_mm_ - suspect.height_mm;
    if (below_mm < -kSameHeightMm) continue;
    findings.add(FindingKind::RapidBelowCut, suspect.line.number, suspect.line.text, [&] {
      return "It goes across at " + place_on(kZ, suspect.work_mm) + ", and what is cut later reaches up to " +
             place_on(kZ, suspect.work_mm + below_mm) + ".";
    });
  }
}

}  // namespace kerf::rehearsal
