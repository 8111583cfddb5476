#include "rehearsal/affine.hpp"

#include <cmath>
#include <numbers>

namespace kerf::rehearsal {

bool Affine::keeps_distance(std::size_t axis) const {
  if (axis >= kAxes) return true;
  for (std::size_t other = 0; other < kAxes; ++other) {
    if (linear.at(axis).at(other) != (axis == other ? 1.0 : 0.0)) return false;
  }
  return true;
}

AxisMask Affine::dependents_of(AxisMask axes) const {
  AxisMask found = 0;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if ((inputs_of(axis) & axes) != 0) found |= mask_of_axis(axis);
  }
  return found;
}

AxisMask Affine::inputs_of(std::size_t axis) const {
  AxisMask found = 0;
  for (std::size_t other = 0; other < kAxes; ++other) {
    if (uses(axis, other)) found |= mask_of_axis(other);
  }
  return found;
}

double Affine::value(std::size_t axis, const ExactValues& place) const {
  return distance(axis, place) + constant.at(axis);
}

double Affine::distance(std::size_t axis, const ExactValues& way) const {
  double sum = 0;
  for (std::size_t other = 0; other < kAxes; ++other) sum += linear.at(axis).at(other) * way.at(other);
  return sum;
}

PlaneMap map_of_plane(const Affine& map, gcode::Plane plane) {
  constexpr double kSame = 1e-9;
  const gcode::PlaneAxes axes = gcode::axes_of(plane);
  const auto at = [&map](std::size_t row, std::size_t column) { return map.linear.at(row).at(column); };
  if (at(axes.first, axes.linear) != 0 || at(axes.second, axes.linear) != 0 || at(axes.linear, axes.first) != 0 ||
      at(axes.linear, axes.second) != 0) {
    return {};
  }
  const double a = at(axes.first, axes.first);
  const double b = at(axes.first, axes.second);
  const double c = at(axes.second, axes.first);
  const double d = at(axes.second, axes.second);
  const double one = std::hypot(a, c);
  const double other = std::hypot(b, d);
  const bool is_square = std::abs(a * b + c * d) <= kSame * one * other;
  const bool is_even = std::abs(one - other) <= kSame * one;
  return {.keeps_circles = is_square && is_even && one > 0, .factor = one, .turns_over = a * d - b * c < 0};
}

Affine translation(double x_mm, double y_mm, double z_mm) {
  Affine map;
  map.constant = {x_mm, y_mm, z_mm};
  return map;
}

Affine rotation(double degrees, double about_x_mm, double about_y_mm) {
  constexpr double kRightAngle = 90.0;
  const double quarters = degrees / kRightAngle;
  double cosine = std::cos(degrees * std::numbers::pi / 180.0);
  double sine = std::sin(degrees * std::numbers::pi / 180.0);
  if (quarters == std::round(quarters)) {
    cosine = std::round(cosine);
    sine = std::round(sine);
  }
  Affine map;
  map.linear[0] = {cosine, -sine, 0};
  map.linear[1] = {sine, cosine, 0};
  map.constant = {about_x_mm - cosine * about_x_mm + sine * about_y_mm,
                  about_y_mm - sine * about_x_mm - cosine * about_y_mm, 0};
  return map;
}

Affine mirror(std::size_t axis, double at_mm) {
  Affine map;
  map.linear.at(axis).at(axis) = -1.0;
  map.constant.at(axis) = 2.0 * at_mm;
  return map;
}

Affine scaling(double x, double y, double z) {
  Affine map;
  map.linear[0][0] = x;
  map.linear[1][1] = y;
  map.linear[2][2] = z;
  return map;
}

}  // namespace kerf::rehearsal
