#include "rehearsal/toolpath_levels.hpp"

#include <algorithm>
#include <utility>

namespace kerf::rehearsal {
namespace {

StraightRun::Place place_of(const Point& point) {
  return {point[0], point[1], point[2]};
}

bool may_be_one_line(const PathVertex& one, const PathVertex& other) {
  const bool same_work = is_cut(one.kind) ? is_cut(other.kind) : one.kind == other.kind;
  return same_work && one.tool == other.tool && one.operation == other.operation &&
         one.unknown_axes == other.unknown_axes;
}

bool is_marked(PathKind kind) {
  return kind == PathKind::ToolChange || kind == PathKind::Pause;
}

}  // namespace

LevelBuilder::LevelBuilder(std::span<const float> tolerances_mm) {
  // Each level is made of the one before, so it may add only what is left of its tolerance. Arcs become chords within
  // half of the first.
  constexpr float kHalf = 0.5F;
  float spent_mm = 0;
  for (const float tolerance_mm : tolerances_mm) {
    const bool is_first = levels_.empty();
    const float own_mm = is_first ? tolerance_mm * kHalf : tolerance_mm - spent_mm;
    levels_.push_back({.run = StraightRun(static_cast<double>(std::max(own_mm, 0.0F)))});
    if (is_first) chord_tolerance_mm_ = tolerance_mm * kHalf;
    spent_mm = tolerance_mm;
  }
}

void LevelBuilder::add(const PathChunk& chunk) {
  if (levels_.empty()) return;
  if (!std::exchange(has_begun_, true)) {
    for (Level& level : levels_) level.kept = level.chunk.start = chunk.start;
  }
  const PathVertex* before = &chunk.start;
  for (const PathVertex& vertex : chunk.vertices) {
    if (is_arc(vertex.kind)) {
      chords_.clear();
      append_chords(before->at_mm, vertex, chord_tolerance_mm_, chords_);
      PathVertex chord = vertex;
      chord.kind = PathKind::Feed;
      chord.center_offset_mm = {};
      chord.plane = ArcPlane::XY;
      chord.turns = 1;
      for (std::size_t at = 0; at < chords_.size(); ++at) {
        const double share = static_cast<double>(at + 1) / static_cast<double>(chords_.size());
        chord.at_mm = chords_[at];
        chord.time_s = before->time_s + (vertex.time_s - before->time_s) * share;
        add_to(0, chord);
      }
    } else if (!is_event(vertex.kind) || is_marked(vertex.kind)) {
      add_to(0, vertex);
    }
    before = &vertex;
  }
}

void LevelBuilder::add_to(std::size_t number, const PathVertex& vertex) {
  if (is_event(vertex.kind)) {
    flush(number);
    keep(number, vertex);
    return;
  }
  Level& level = levels_[number];
  if (level.is_open && !may_be_one_line(level.last, vertex)) flush(number);
  if (!level.is_open) level.run.begin(place_of(level.kept.at_mm));
  if (!level.run.take(place_of(vertex.at_mm))) {
    flush(number);
    level.run.begin(place_of(level.kept.at_mm));
    static_cast<void>(level.run.take(place_of(vertex.at_mm)));
  }
  level.last = vertex;
  level.is_open = true;
}

void LevelBuilder::flush(std::size_t number) {
  if (!std::exchange(levels_[number].is_open, false)) return;
  const PathVertex vertex = levels_[number].last;
  keep(number, vertex);
}

void LevelBuilder::keep(std::size_t number, const PathVertex& vertex) {
  Level& level = levels_[number];
  if (!is_event(vertex.kind) && unknown_axes_between(level.kept, vertex) == 0) {
    include_motion(level.chunk.bounds, level.kept.at_mm, vertex);
  }
  level.kept = vertex;
  level.chunk.vertices.push_back(vertex);
  if (level.chunk.vertices.size() >= kChunkVertices) hand_out(number);
  if (number + 1 < levels_.size()) add_to(number + 1, vertex);
}

void LevelBuilder::hand_out(std::size_t number) {
  Level& level = levels_[number];
  if (level.chunk.vertices.empty()) return;
  full_.push_back({.level = static_cast<std::uint32_t>(number + 1), .chunk = std::move(level.chunk)});
  level.chunk = {.start = level.kept, .vertices = {}};
}

void LevelBuilder::finish() {
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    flush(number);
    hand_out(number);
  }
}

std::vector<LevelChunk> LevelBuilder::take() {
  return std::exchange(full_, {});
}

}  // namespace kerf::rehearsal
