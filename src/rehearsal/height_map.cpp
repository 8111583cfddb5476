#include "rehearsal/height_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

/// Points that lie so close to each other are one line of the grid.
constexpr double kSame_mm = 1e-3;
constexpr std::size_t kMostPoints = 1'000'000;

using Point = std::array<double, 3>;

std::optional<Point> point_of(std::string_view line) {
  Point point{};
  std::size_t count = 0;
  for (std::size_t at = 0; at < line.size();) {
    constexpr std::string_view kBetween = ",; \t";
    const std::size_t begin = line.find_first_not_of(kBetween, at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(kBetween, begin), line.size());
    std::string_view digits = line.substr(begin, end - begin);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto value = base::parse_decimal(digits);
    if (!value || count == point.size()) return std::nullopt;
    point.at(count++) = *value;
    at = end;
  }
  return count == point.size() ? std::optional{point} : std::nullopt;
}

/// The lines of the grid along one axis.
std::vector<double> lines_of(const std::vector<Point>& points, std::size_t axis) {
  std::vector<double> places;
  for (const Point& point : points) places.push_back(point.at(axis));
  std::ranges::sort(places);
  std::vector<double> lines;
  for (const double place : places) {
    if (lines.empty() || place - lines.back() > kSame_mm) lines.push_back(place);
  }
  return lines;
}

std::size_t nearest(const std::vector<double>& lines, double place) {
  const auto above = std::ranges::lower_bound(lines, place - kSame_mm);
  return static_cast<std::size_t>(above - lines.begin());
}

/// The cell of the grid that holds `place`.
std::size_t cell_of(const std::vector<double>& lines, double place) {
  const auto above = std::ranges::upper_bound(lines, place);
  const auto index = static_cast<std::size_t>(above - lines.begin());
  return std::clamp<std::size_t>(index, 1, lines.size() - 1) - 1;
}

void add_crossings(const std::vector<double>& lines, double from, double to, std::vector<double>& cuts) {
  if (from == to) return;
  const auto [least, most] = std::minmax(from, to);
  for (auto line = std::ranges::upper_bound(lines, least); line != lines.end() && *line < most; ++line) {
    cuts.push_back((*line - from) / (to - from));
  }
}

std::string place_text(double x, double y) {
  return "X" + base::to_fixed(x, 3) + " Y" + base::to_fixed(y, 3);
}

}  // namespace

std::expected<HeightMap, std::string> HeightMap::parse(std::string_view text) {
  std::vector<Point> points;
  std::size_t number = 0;
  for (const std::string_view raw : base::split(text, '\n')) {
    ++number;
    const std::string_view line = base::trim(raw);
    if (line.empty() || line.starts_with('#')) continue;
    const auto point = point_of(line);
    const bool is_heading = points.empty() && !point && number == 1;
    if (is_heading) continue;
    if (!point) return std::unexpected{"Line " + std::to_string(number) + " is no point: write x,y,z."};
    points.push_back(*point);
    if (points.size() > kMostPoints) return std::unexpected{std::string{"More than a million points are too many."}};
  }
  HeightMap map{.x_mm = lines_of(points, 0), .y_mm = lines_of(points, 1), .z_mm = {}};
  if (map.x_mm.size() < 2 || map.y_mm.size() < 2) {
    return std::unexpected{std::string{"A grid has at least two columns and two rows of points."}};
  }
  if (map.x_mm.size() * map.y_mm.size() > kMostPoints) {
    return std::unexpected{std::string{"The points lie on no grid: hardly two have the same X or the same Y."}};
  }
  map.z_mm.assign(map.x_mm.size() * map.y_mm.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Point& point : points) {
    double& z = map.z_mm[nearest(map.y_mm, point[1]) * map.x_mm.size() + nearest(map.x_mm, point[0])];
    if (!std::isnan(z)) return std::unexpected{place_text(point[0], point[1]) + " was measured twice."};
    z = point[2];
  }
  for (std::size_t at = 0; at < map.z_mm.size(); ++at) {
    if (!std::isnan(map.z_mm[at])) continue;
    return std::unexpected{place_text(map.x_mm[at % map.x_mm.size()], map.y_mm[at / map.x_mm.size()]) +
                           " is missing in the grid."};
  }
  return map;
}

bool HeightMap::covers(double x, double y) const {
  return x >= x_mm.front() - kSame_mm && x <= x_mm.back() + kSame_mm && y >= y_mm.front() - kSame_mm &&
         y <= y_mm.back() + kSame_mm;
}

double HeightMap::height_mm(double x, double y) const {
  x = std::clamp(x, x_mm.front(), x_mm.back());
  y = std::clamp(y, y_mm.front(), y_mm.back());
  const std::size_t column = cell_of(x_mm, x);
  const std::size_t row = cell_of(y_mm, y);
  const double u = (x - x_mm[column]) / (x_mm[column + 1] - x_mm[column]);
  const double v = (y - y_mm[row]) / (y_mm[row + 1] - y_mm[row]);
  return (1 - v) * ((1 - u) * at(column, row) + u * at(column + 1, row)) +
         v * ((1 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
}

std::vector<double> HeightMap::cuts(double x0, double y0, double x1, double y1, double tolerance_mm) const {
  std::vector<double> crossings;
  add_crossings(x_mm, x0, x1, crossings);
  add_crossings(y_mm, y0, y1, crossings);
  crossings.push_back(1.0);
  std::ranges::sort(crossings);
  std::vector<double> result;
  double from = 0;
  for (const double to : crossings) {
    constexpr double kNothing = 1e-9;
    if (to - from < kNothing) continue;
    // Along a straight line through one cell the surface is a parabola: its middle lies off the chord.
    const auto height = [&](double share) { return height_mm(x0 + share * (x1 - x0), y0 + share * (y1 - y0)); };
    const double sag = std::abs(height((from + to) / 2) - (height(from) + height(to)) / 2);
    const double pieces = std::max(std::ceil(std::sqrt(sag / tolerance_mm)), 1.0);
    for (double piece = 1; piece < pieces; ++piece) result.push_back(from + (to - from) * piece / pieces);
    result.push_back(to);
    from = to;
  }
  if (result.empty()) result.push_back(1.0);
  result.back() = 1.0;
  return result;
}

}  // namespace kerf::rehearsal
