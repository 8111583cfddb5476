#include "rehearsal/toolpath_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "firmware/settings_store.hpp"

namespace kerf::rehearsal {
namespace {

using gcode::AxisValues;
using vocabulary::AxisMask;

constexpr AxisMask kPlaceAxes = 0b111;
constexpr double kSecondsPerMinute = 60;
/// Files may have long stretches without motion; whoever shows progress wants to hear of them too.
constexpr std::size_t kMostLinesAtOnce = 65'536;

std::uint16_t as_tool(int number) {
  return static_cast<std::uint16_t>(std::clamp(number, 0, int{std::numeric_limits<std::uint16_t>::max()}));
}

ArcPlane plane_of(gcode::Plane plane) {
  switch (plane) {
    case gcode::Plane::XY: return ArcPlane::XY;
    case gcode::Plane::ZX: return ArcPlane::ZX;
    case gcode::Plane::YZ: break;
  }
  return ArcPlane::YZ;
}

}  // namespace

PathStart path_start_of(const simulation::CaseMachine& machine) {
  firmware::SettingsStore store(machine.personality, firmware::axes_of(machine.personality, machine.stored));
  static_cast<void>(store.load(machine.stored));
  return {.dialect = &machine.personality.dialect(),
          .reader = interpreter_of(machine),
          .max_rate_mm_per_min = store.axis_values(firmware::setting::kMaxRate)};
}

ToolpathReader::ToolpathReader(std::string_view text, PathStart start)
    : dialect_(start.dialect),
      knows_place_(start.knows_place),
      max_rate_mm_per_min_(start.max_rate_mm_per_min),
      origin_mm_(start.reader.work_coordinate_offset()),
      at_mm_(start.reader.state().position_mm),
      walk_(text, std::move(start.reader), *start.dialect) {
  for (std::size_t axis = 0; axis < last_.at_mm.size(); ++axis) last_.at_mm[axis] = at_mm_[axis] - origin_mm_[axis];
  if (!knows_place_) last_.unknown_axes = kPlaceAxes;
}

bool ToolpathReader::read_on(PathChunk& chunk, std::size_t most_vertices) {
  chunk.start = last_;
  chunk.vertices.clear();
  chunk.bounds = {};
  const bool goes_on = fill(chunk, most_vertices);
  bounds_.include(chunk.bounds);
  return goes_on;
}

bool ToolpathReader::fill(PathChunk& chunk, std::size_t most_vertices) {
  for (std::size_t lines = 0; chunk.vertices.size() < most_vertices && lines < kMostLinesAtOnce;) {
    if (line_ == nullptr || next_action_ == walk_.actions().size()) {
      if (line_ != nullptr && line_->ends_elsewhere) last_.unknown_axes = kPlaceAxes;
      line_ = walk_.next();
      if (line_ == nullptr) return false;
      ++lines;
      begin_line(*line_);
    }
    if (std::exchange(tool_is_new_, false)) add_event(PathKind::ToolChange, 0, chunk);
    if (next_action_ < walk_.actions().size()) add(walk_.actions()[next_action_++], chunk);
  }
  return true;
}

void ToolpathReader::begin_line(const WalkedLine& line) {
  next_action_ = 0;
  last_.line = line.number;
  last_.operation = walk_.operation();
  const std::uint16_t tool = as_tool(walk_.tool().value_or(0));
  tool_is_new_ = tool != last_.tool;
  last_.tool = tool;
  if (knows_place_ || walk_.actions().empty()) return;
  known_after_ = unknown_after_ = 0;
  const AxisMask named = line.axes & kPlaceAxes;
  if (line.in_machine_coordinates) {
    unknown_after_ = named == 0 ? kPlaceAxes : named;
  } else if (!walk_.reader().state().modal.incremental) {
    known_after_ = named;
  }
}

void ToolpathReader::add(const gcode::Action& action, PathChunk& chunk) {
  std::visit(
      base::Overloaded{
          [&](const gcode::LinearMove& move) {
            add_move(move.target_mm, move.feed, {.kind = kind_of(move.feed)}, chunk);
          },
          [&](const gcode::ArcMove& move) {
            const int turns = std::clamp(move.turns, 1, int{std::numeric_limits<std::uint16_t>::max()});
            add_move(move.target_mm, move.feed,
                     {.center_offset_mm = move.center_offset_mm,
                      .kind = move.clockwise ? PathKind::ArcClockwise : PathKind::ArcCounterclockwise,
                      .plane = plane_of(move.plane),
                      .turns = static_cast<std::uint16_t>(turns)},
                     chunk);
          },
          [&](const gcode::ProbeMove& move) { add_move(move.target_mm, move.feed, {.kind = PathKind::Probe}, chunk); },
          [&](const gcode::Dwell& dwell) {
            add_event(PathKind::Dwell, std::max(static_cast<double>(dwell.dwell_s), 0.0), chunk);
          },
          [&](const gcode::SpindleChange& change) {
            last_.spindle_rpm = change.direction == gcode::SpindleDirection::Off ? 0 : change.rpm;
            add_event(PathKind::SpindleChange, 0, chunk);
          },
          [&](const gcode::SpindleSpeedChange& change) {
            last_.spindle_rpm = change.rpm;
            add_event(PathKind::SpindleChange, 0, chunk);
          },
          [&](const gcode::ProgramPause&) { add_event(PathKind::Pause, 0, chunk); },
          [](const auto&) {},
      },
      action);
}

PathKind ToolpathReader::kind_of(const gcode::Feed& feed) {
  if (feed.rapid) return PathKind::Rapid;
  if (feed.spindle_rpm > 0) has_had_power_ = true;
  const bool is_dark = feed.spindle != gcode::SpindleDirection::Off && feed.spindle_rpm <= 0 && has_had_power_;
  return is_dark ? PathKind::Travel : PathKind::Feed;
}

double ToolpathReader::seconds_of(const AxisValues& target_mm, const gcode::Feed& feed, double length_mm) const {
  double least_s = 0;
  double square = 0;
  for (std::size_t axis = 0; axis < target_mm.size(); ++axis) {
    const double way = std::abs(static_cast<double>(target_mm[axis]) - static_cast<double>(at_mm_[axis]));
    square += way * way;
    const double rate = static_cast<double>(max_rate_mm_per_min_[axis]);
    if (rate > 0) least_s = std::max(least_s, way / rate * kSecondsPerMinute);
  }
  const double rate = static_cast<double>(feed.rate_mm_per_min);
  if (feed.rapid || rate <= 0) return least_s;
  // What only turns has a length in degrees.
  const double way = length_mm > 0 ? length_mm : std::sqrt(square);
  const double speed = feed.per_revolution ? rate * static_cast<double>(feed.spindle_rpm) : rate;
  const double minutes = feed.inverse_time ? 1 / rate : (speed > 0 ? way / speed : 0);
  return std::max(least_s, minutes * kSecondsPerMinute);
}

void ToolpathReader::add_move(const AxisValues& target_mm, const gcode::Feed& feed, PathVertex vertex,
                              PathChunk& chunk) {
  const auto unknown = static_cast<AxisMask>((last_.unknown_axes & ~known_after_) | unknown_after_);
  if (target_mm == at_mm_ && !is_arc(vertex.kind)) {
    last_.unknown_axes = unknown;
    return;
  }
  vertex.unknown_axes = is_cut(vertex.kind) ? AxisMask{0} : unknown;
  for (std::size_t axis = 0; axis < vertex.at_mm.size(); ++axis) {
    vertex.at_mm[axis] = target_mm[axis] - origin_mm_[axis];
  }
  vertex.line = last_.line;
  vertex.feed_mm_per_min = feed.rapid || feed.inverse_time || feed.per_revolution ? 0 : feed.rate_mm_per_min;
  vertex.spindle_rpm = feed.spindle == gcode::SpindleDirection::Off ? 0 : feed.spindle_rpm;
  vertex.tool = last_.tool;
  vertex.operation = last_.operation;
  vertex.time_s = last_.time_s + seconds_of(target_mm, feed, length_of(last_.at_mm, vertex));
  if (unknown_axes_between(last_, vertex) == 0) include_motion(chunk.bounds, last_.at_mm, vertex);
  at_mm_ = target_mm;
  (walk_.reader().state().modal.inches ? uses_inches_ : uses_mm_) = true;
  push(vertex, chunk);
}

void ToolpathReader::add_event(PathKind kind, double duration_s, PathChunk& chunk) {
  PathVertex vertex = last_;
  vertex.kind = kind;
  vertex.center_offset_mm = {};
  vertex.plane = ArcPlane::XY;
  vertex.turns = 1;
  vertex.feed_mm_per_min = 0;
  vertex.time_s += duration_s;
  push(vertex, chunk);
}

void ToolpathReader::push(const PathVertex& vertex, PathChunk& chunk) {
  chunk.vertices.push_back(vertex);
  last_ = vertex;
  ++vertex_count_;
}

}  // namespace kerf::rehearsal
