#pragma once
// A surface that was measured on a grid.

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::rehearsal {

/// Heights over a rectangle, in work coordinates, mm; bilinear between the points of the grid.
struct HeightMap {
  /// Ascending.
  std::vector<double> x_mm;
  std::vector<double> y_mm;
  /// Row by row along X.
  std::vector<double> z_mm;

  /// Lines of `x,y,z` (commas, semicolons, blanks or tabs between) in any order; a heading and lines with `#` are
  /// passed over. Every point of the grid has to be there once. Fails with a sentence.
  [[nodiscard]] static std::expected<HeightMap, std::string> parse(std::string_view text);

  [[nodiscard]] double at(std::size_t column, std::size_t row) const { return z_mm[row * x_mm.size() + column]; }
  /// Outside, the height of the edge.
  [[nodiscard]] double height_mm(double x, double y) const;
  [[nodiscard]] bool covers(double x, double y) const;
  /// Where the way from one place to another, seen as 0 to 1, has to be cut so that straight pieces follow the surface
  /// within `tolerance_mm`; 1 is the last.
  [[nodiscard]] std::vector<double> cuts(double x0, double y0, double x1, double y1, double tolerance_mm) const;
};
BOOST_DESCRIBE_STRUCT(HeightMap, (), (x_mm, y_mm, z_mm))

}  // namespace kerf::rehearsal
