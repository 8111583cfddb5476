#include "common/motion/arc_extent.hpp"

#include <cmath>
#include <numbers>

namespace kerf::motion {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kQuarter = std::numbers::pi / 2;
/// Ends this close make a full circle (gnea/grbl config.h ARC_ANGULAR_TRAVEL_EPSILON).
constexpr double kSameAngle = 5e-7;

}  // namespace

std::vector<AxisValues> extremes_of(const Arc& arc) {
  const std::size_t first = arc.plane_axes[0];
  const std::size_t second = arc.plane_axes[1];
  const std::size_t linear = arc.plane_axes[2];
  const double center_1 = static_cast<double>(arc.start_mm[first]) + static_cast<double>(arc.center_offset_mm[0]);
  const double center_2 = static_cast<double>(arc.start_mm[second]) + static_cast<double>(arc.center_offset_mm[1]);
  const auto angle_of = [&](const AxisValues& at) {
    return std::atan2(static_cast<double>(at[second]) - center_2, static_cast<double>(at[first]) - center_1);
  };
  const double sign = arc.clockwise ? -1 : 1;
  const double from = angle_of(arc.start_mm);
  double sweep = std::remainder(sign * (angle_of(arc.target_mm) - from), kFullTurn);
  if (sweep <= kSameAngle) sweep += kFullTurn;
  sweep += kFullTurn * (arc.turns > 1 ? arc.turns - 1 : 0);
  const double radius =
      std::hypot(static_cast<double>(arc.center_offset_mm[0]), static_cast<double>(arc.center_offset_mm[1]));
  std::vector<AxisValues> extremes;
  for (int quarter = 0; quarter < 4; ++quarter) {
    double along = std::remainder(sign * (quarter * kQuarter - from), kFullTurn);
    if (along < 0) along += kFullTurn;
    if (along >= sweep) continue;
    AxisValues& at = extremes.emplace_back(arc.start_mm);
    at[first] = static_cast<float>(center_1 + radius * std::cos(quarter * kQuarter));
    at[second] = static_cast<float>(center_2 + radius * std::sin(quarter * kQuarter));
    at[linear] += static_cast<float>(along / sweep) * (arc.target_mm[linear] - arc.start_mm[linear]);
  }
  return extremes;
}

}  // namespace kerf::motion
