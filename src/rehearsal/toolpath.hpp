#pragma once
// The path of the tool as geometry: what the screen and the printer draw. Places are those of the tool's tip, in mm,
// measured from where work zero (G54, unless offsets say otherwise) is when the program begins.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/vocabulary/axis.hpp"

namespace kerf::rehearsal {

/// X, Y, Z in mm.
using Point = std::array<float, 3>;

/// What happens on the way to a vertex, or at it.
enum class PathKind : std::uint8_t {
  Rapid,
  Feed,
  ArcClockwise,  ///< seen from the positive end of the axis that is perpendicular to the arc's plane
  ArcCounterclockwise,
  Travel,  ///< fed, while the spindle is told to turn at 0: a laser that does not burn
  Probe,
  Dwell,
  SpindleChange,
  ToolChange,
  Pause,
};
BOOST_DESCRIBE_ENUM(PathKind, Rapid, Feed, ArcClockwise, ArcCounterclockwise, Travel, Probe, Dwell, SpindleChange,
                    ToolChange, Pause)
inline constexpr std::size_t kPathKinds = 10;

[[nodiscard]] constexpr bool is_arc(PathKind kind) {
  return kind == PathKind::ArcClockwise || kind == PathKind::ArcCounterclockwise;
}
/// The tool is at work on the way.
[[nodiscard]] constexpr bool is_cut(PathKind kind) {
  return kind == PathKind::Feed || is_arc(kind);
}
/// Something happens at the place that was reached before.
[[nodiscard]] constexpr bool is_event(PathKind kind) {
  return kind >= PathKind::Dwell;
}

enum class ArcPlane : std::uint8_t { XY, ZX, YZ };

/// The end of one motion, which begins at the vertex before, or an event.
struct PathVertex {
  Point at_mm{};
  /// Only of arcs: the centre, from the place where the arc begins, along the plane's first and second axis (G18: Z,
  /// then X).
  std::array<float, 2> center_offset_mm{};
  /// When the motion ends, from the beginning of the program: as if nothing had to speed up, until a better time is
  /// laid over it (toolpath_time.hpp).
  double time_s = 0;
  /// Of the file, from 1.
  std::uint32_t line = 0;
  /// As programmed; 0 for rapids and events.
  float feed_mm_per_min = 0;
  float spindle_rpm = 0;
  /// 0 before the first is told.
  std::uint16_t tool = 0;
  /// Index of a name; 0 before the first operation.
  std::uint16_t operation = 0;
  PathKind kind = PathKind::Rapid;
  ArcPlane plane = ArcPlane::XY;
  /// 1, but for arcs of grblHAL with P.
  std::uint16_t turns = 1;
  /// Axes on which the program has not yet said where it is (at its beginning, behind G53, G28, G30, $H): there `at_mm`
  /// is where the machine would be if it had been at work zero, and machine zero were there too.
  vocabulary::AxisMask unknown_axes = 0;

  bool operator==(const PathVertex&) const = default;
};

/// Axes on which the way from `before` to `vertex` is not known. A cut settles every doubt about where it begins: it is
/// on the workpiece, and that is all that a drawing needs.
[[nodiscard]] constexpr vocabulary::AxisMask unknown_axes_between(const PathVertex& before, const PathVertex& vertex) {
  const unsigned begin = is_cut(vertex.kind) ? 0U : before.unknown_axes;
  return static_cast<vocabulary::AxisMask>(begin | vertex.unknown_axes);
}

/// The smallest box around a path; empty before the first point.
struct PathBounds {
  Point least_mm{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                 std::numeric_limits<float>::max()};
  Point most_mm{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
                std::numeric_limits<float>::lowest()};

  [[nodiscard]] bool is_empty() const { return least_mm[0] > most_mm[0]; }
  [[nodiscard]] float size_mm(std::size_t axis) const { return is_empty() ? 0 : most_mm.at(axis) - least_mm.at(axis); }
  void include(const Point& point);
  void include(const PathBounds& other);
  bool operator==(const PathBounds&) const = default;
};

/// A stretch of the path. The first vertex of a chunk continues from `start`, the last one of the chunk before.
struct PathChunk {
  PathVertex start{};
  std::vector<PathVertex> vertices;
  /// Of all motion whose both ends are known, arcs to their full extent.
  PathBounds bounds{};
};

/// The arc from `start_mm` to `end` in chords that leave it by at most `tolerance_mm`, unless that took more than 2048
/// for a turn, or 20,000 in all: appends their ends, of which the last is the arc's own.
void append_chords(const Point& start_mm, const PathVertex& end, float tolerance_mm, std::vector<Point>& out);

/// Adds the motion from `start_mm` to `end`, arcs to their full extent.
void include_motion(PathBounds& bounds, const Point& start_mm, const PathVertex& end);

/// Length of the motion from `start_mm` to `end`.
[[nodiscard]] double length_of(const Point& start_mm, const PathVertex& end);

}  // namespace kerf::rehearsal
