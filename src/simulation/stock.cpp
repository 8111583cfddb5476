#include "simulation/stock.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

constexpr double kSampleMm = 0.1;

}  // namespace

std::string text_of(const Point& point) {
  return "X" + base::to_fixed(point.x, 2) + " Y" + base::to_fixed(point.y, 2) + " Z" + base::to_fixed(point.z, 2);
}

Stock::Stock() : depth_(static_cast<std::size_t>(kCells) * kCells, 0.0F) {}

std::optional<std::size_t> Stock::cell_of(const Point& at) {
  const double column = std::floor((at.x - kFirstMm) / kCellMm);
  const double row = std::floor((at.y - kFirstMm) / kCellMm);
  if (column < 0 || row < 0 || column >= kCells || row >= kCells) return std::nullopt;
  return static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column);
}

Point Stock::middle_of(std::size_t cell) {
  return {.x = kFirstMm + kCellMm * (static_cast<double>(cell % kCells) + 0.5),
          .y = kFirstMm + kCellMm * (static_cast<double>(cell / kCells) + 0.5)};
}

void Stock::cut(const Point& from, const Point& to) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int samples = 1 + static_cast<int>(length / kSampleMm);
  for (int i = 0; i <= samples; ++i) {
    const double share = static_cast<double>(i) / samples;
    const Point at{.x = from.x + share * (to.x - from.x),
                   .y = from.y + share * (to.y - from.y),
                   .z = from.z + share * (to.z - from.z)};
    if (at.z >= 0) continue;
    if (const auto cell = cell_of(at)) {
      depth_[*cell] = std::min(depth_[*cell], static_cast<float>(at.z));
    } else {
      beside_ = at;
    }
  }
}

float Stock::lowest_around(std::size_t cell, int cells) const {
  const int column = static_cast<int>(cell % kCells);
  const int row = static_cast<int>(cell / kCells);
  float lowest = 0;
  for (int y = std::max(row - cells, 0); y <= std::min(row + cells, kCells - 1); ++y) {
    for (int x = std::max(column - cells, 0); x <= std::min(column + cells, kCells - 1); ++x) {
      lowest = std::min(lowest, depth_[static_cast<std::size_t>(y) * kCells + static_cast<std::size_t>(x)]);
    }
  }
  return lowest;
}

bool Stock::is_uncut(const Point& at) const {
  if (at.z > -kDepthToleranceMm) return false;
  const auto cell = cell_of(at);
  return !cell || at.z < static_cast<double>(lowest_around(*cell, 1)) - kDepthToleranceMm;
}

CutDifference compare(const Stock& wanted, const Stock& is, double allowed_mm) {
  CutDifference found;
  const int reach = 1 + static_cast<int>(std::ceil(allowed_mm / Stock::kCellMm));
  const auto tolerance = static_cast<float>(Stock::kDepthToleranceMm + allowed_mm);
  for (std::size_t cell = 0; cell < wanted.depth_.size(); ++cell) {
    const float want = wanted.depth_[cell];
    const float have = is.depth_[cell];
    if (want < have && is.lowest_around(cell, 1) > want + static_cast<float>(Stock::kDepthToleranceMm)) {
      if (found.missing_cells++ == 0) found.missing = Stock::middle_of(cell);
      found.missing.z = std::min(found.missing.z, static_cast<double>(want));
    }
    if (have < want && wanted.lowest_around(cell, reach) > have + tolerance) {
      if (found.excess_cells++ == 0) found.excess = Stock::middle_of(cell);
      found.excess.z = std::min(found.excess.z, static_cast<double>(have));
    }
  }
  if (is.beside_ && !wanted.beside_) {
    ++found.excess_cells;
    found.excess = *is.beside_;
  }
  return found;
}

}  // namespace kerf::simulation
