#pragma once
// Translating, rotating, mirroring and scaling, as one map of the program's coordinates.

#include <array>
#include <cstddef>

#include "rehearsal/program_reading.hpp"

namespace kerf::rehearsal {

/// x' = linear * x + constant, in mm, for X, Y and Z; other axes stay.
struct Affine {
  static constexpr std::size_t kAxes = 3;
  using Vector = std::array<double, kAxes>;

  std::array<Vector, kAxes> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vector constant{};

  /// The new coordinate `axis` depends on the old `other`.
  [[nodiscard]] bool uses(std::size_t axis, std::size_t other) const {
    return axis < kAxes && other < kAxes ? linear.at(axis).at(other) != 0.0 : axis == other;
  }
  /// Distances along this axis stay what they are.
  [[nodiscard]] bool keeps_distance(std::size_t axis) const;
  [[nodiscard]] bool moves(std::size_t axis) const { return axis < kAxes && constant.at(axis) != 0.0; }
  [[nodiscard]] bool keeps(std::size_t axis) const { return keeps_distance(axis) && !moves(axis); }
  /// New coordinates that depend on any of `axes`.
  [[nodiscard]] AxisMask dependents_of(AxisMask axes) const;
  /// Old coordinates that the new `axis` depends on.
  [[nodiscard]] AxisMask inputs_of(std::size_t axis) const;
  [[nodiscard]] double value(std::size_t axis, const ExactValues& place) const;
  [[nodiscard]] double distance(std::size_t axis, const ExactValues& way) const;
};

/// How a map treats circles of a plane.
struct PlaneMap {
  /// Circles stay circles, in the same plane.
  bool keeps_circles = false;
  double factor = 1.0;
  /// Clockwise becomes counterclockwise.
  bool turns_over = false;
};

[[nodiscard]] PlaneMap map_of_plane(const Affine& map, gcode::Plane plane);

[[nodiscard]] Affine translation(double x_mm, double y_mm, double z_mm);
/// Counterclockwise, seen from above; right angles are exact.
[[nodiscard]] Affine rotation(double degrees, double about_x_mm, double about_y_mm);
/// The axis changes its sign about `at_mm`.
[[nodiscard]] Affine mirror(std::size_t axis, double at_mm);
[[nodiscard]] Affine scaling(double x, double y, double z);

}  // namespace kerf::rehearsal
