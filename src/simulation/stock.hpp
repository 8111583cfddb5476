#pragma once
// What a milling tool leaves of its workpiece, as a map of depths.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kerf::simulation {

/// Millimetres from work zero, which lies on the stock's top.
struct Point {
  double x = 0;
  double y = 0;
  double z = 0;
};

[[nodiscard]] std::string text_of(const Point& point);

struct CutDifference;

/// Stock without end below Z0. Its map has a cell of kCellMm for each place, and in each cell the lowest place of the
/// tool's point: an upright tool takes everything above its point away. Tools are as thin as a cell, so that each pass
/// counts on its own.
class Stock {
 public:
  static constexpr double kCellMm = 0.25;
  /// A path may be one cell beside another, or this much higher, and be the same.
  static constexpr double kDepthToleranceMm = 0.06;

  Stock();

  /// The tool goes straight from one point to the other and takes away what is in its way.
  void cut(const Point& from, const Point& to);
  /// Whether the tool's point would be in what has not been taken away.
  [[nodiscard]] bool is_uncut(const Point& at) const;

 private:
  friend CutDifference compare(const Stock& wanted, const Stock& is, double allowed_mm);

  static constexpr double kFirstMm = -20;
  static constexpr int kCells = 320;

  [[nodiscard]] static std::optional<std::size_t> cell_of(const Point& at);
  [[nodiscard]] static Point middle_of(std::size_t cell);
  [[nodiscard]] float lowest_around(std::size_t cell, int cells) const;

  std::vector<float> depth_;
  /// Where something was cut beside the map.
  std::optional<Point> beside_;
};

/// How one workpiece differs from another.
struct CutDifference {
  std::size_t missing_cells = 0;
  std::size_t excess_cells = 0;
  Point missing{};  ///< one of them
  Point excess{};   ///< one of them
  [[nodiscard]] bool none() const { return missing_cells == 0 && excess_cells == 0; }
};

/// What of `wanted` is missing in `is`, and what `is` has in excess further than `allowed_mm` from anything wanted.
[[nodiscard]] CutDifference compare(const Stock& wanted, const Stock& is, double allowed_mm = 0);

}  // namespace kerf::simulation
