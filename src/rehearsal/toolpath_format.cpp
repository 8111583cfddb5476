#include "rehearsal/toolpath_format.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.hpp"
#include "rehearsal/byte_fields.hpp"

namespace kerf::rehearsal {
namespace {

constexpr std::string_view kHeadTag = "KTP1";
constexpr std::string_view kChunkTag = "CHNK";
constexpr std::string_view kNamesTag = "NAME";
constexpr std::string_view kTimesTag = "TIME";
constexpr std::string_view kEndTag = "DONE";
constexpr std::size_t kTagBytes = 4;
constexpr std::size_t kSectionHead = 16;
constexpr std::size_t kAlignment = 8;
constexpr std::size_t kHashDigits = 32;
constexpr int kHex = 16;
/// Of a vertex: place, time, line, kind.
constexpr std::size_t kVertexBytes = 21;
constexpr std::size_t kRunBytes = 16;
constexpr std::size_t kArcBytes = 16;
constexpr std::size_t kTimeMarkBytes = 16;
constexpr std::uint8_t kKindMask = 0x0F;
constexpr unsigned kUnknownShift = 4;
constexpr std::uint8_t kMostUnknown = 0b111;
constexpr std::size_t kPlanes = 3;

using Fault = ToolpathFault;
template <typename Item>
using Taken = std::expected<Item, Fault>;

std::string section(std::string_view tag, FieldWriter payload) {
  payload.align(kAlignment);
  FieldWriter out;
  out.reserve(kSectionHead + payload.bytes().size());
  out.put(tag).put(std::uint32_t{0}).put(static_cast<std::uint64_t>(payload.bytes().size()));
  out.put(payload.bytes());
  return std::move(out.bytes());
}

/// What stays the same for many vertices.
struct Run {
  std::uint32_t first = 0;
  float feed_mm_per_min = 0;
  float spindle_rpm = 0;
  std::uint16_t tool = 0;
  std::uint16_t operation = 0;
};

Run run_of(const PathVertex& vertex) {
  return {.feed_mm_per_min = vertex.feed_mm_per_min,
          .spindle_rpm = vertex.spindle_rpm,
          .tool = vertex.tool,
          .operation = vertex.operation};
}

bool same(const Run& one, const Run& other) {
  return one.feed_mm_per_min == other.feed_mm_per_min && one.spindle_rpm == other.spindle_rpm &&
         one.tool == other.tool && one.operation == other.operation;
}

void put_bounds(FieldWriter& out, const PathBounds& bounds) {
  for (const float value : bounds.least_mm) out.put(value);
  for (const float value : bounds.most_mm) out.put(value);
}

bool is_finite(const Point& point) {
  return std::ranges::all_of(point, [](float value) { return std::isfinite(value); });
}

/// Nothing where no encoder would have written it.
std::optional<PathBounds> take_bounds(FieldReader& in) {
  PathBounds bounds;
  for (float& value : bounds.least_mm) value = in.take<float>();
  for (float& value : bounds.most_mm) value = in.take<float>();
  if (!is_finite(bounds.least_mm) || !is_finite(bounds.most_mm)) return std::nullopt;
  return bounds;
}

Point take_point(FieldReader& in) {
  Point point{};
  for (float& value : point) value = in.take<float>();
  return point;
}

Taken<ToolpathItem> take_head(FieldReader in) {
  ToolpathHead head;
  const auto levels = in.take<std::uint32_t>();
  static_cast<void>(in.take<std::uint32_t>());
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const char letter : in.take_text(kHashDigits / 2)) {
    const auto byte = static_cast<unsigned char>(letter);
    (head.hash += kDigits[byte / kHex]) += kDigits[byte % kHex];
  }
  if (in.is_short() || in.left() / sizeof(float) < levels) return std::unexpected(Fault::WrongSize);
  for (std::uint32_t level = 0; level < levels; ++level) {
    const float tolerance = in.take<float>();
    const float before = head.tolerances_mm.empty() ? 0 : head.tolerances_mm.back();
    if (!std::isfinite(tolerance) || tolerance < before) return std::unexpected(Fault::BadValue);
    head.tolerances_mm.push_back(tolerance);
  }
  return head;
}

struct ChunkCounts {
  std::uint32_t vertices = 0;
  std::uint32_t runs = 0;
  std::uint32_t arcs = 0;

  [[nodiscard]] std::uint64_t bytes() const {
    constexpr std::uint64_t kWord = 4;
    const std::uint64_t kinds = (std::uint64_t{vertices} + kWord - 1) / kWord * kWord;
    return std::uint64_t{vertices} * (kVertexBytes - 1) + kinds + std::uint64_t{runs} * kRunBytes +
           std::uint64_t{arcs} * kArcBytes;
  }
};

bool take_kinds(FieldReader& in, std::vector<PathVertex>& vertices) {
  for (PathVertex& vertex : vertices) {
    const auto byte = in.take<std::uint8_t>();
    const auto kind = static_cast<std::uint8_t>(byte & kKindMask);
    const auto unknown = static_cast<std::uint8_t>(byte >> kUnknownShift);
    if (kind >= kPathKinds || unknown > kMostUnknown) return false;
    vertex.kind = static_cast<PathKind>(kind);
    vertex.unknown_axes = unknown;
  }
  return true;
}

bool take_runs(FieldReader& in, std::uint32_t count, std::vector<PathVertex>& vertices) {
  if ((count == 0) != vertices.empty()) return false;
  std::size_t done = 0;
  Run before;
  for (std::uint32_t index = 0; index <= count; ++index) {
    Run run{.first = static_cast<std::uint32_t>(vertices.size())};
    if (index < count) {
      run.first = in.take<std::uint32_t>();
      run.feed_mm_per_min = in.take<float>();
      run.spindle_rpm = in.take<float>();
      run.tool = in.take<std::uint16_t>();
      run.operation = in.take<std::uint16_t>();
      if (!std::isfinite(run.feed_mm_per_min) || !std::isfinite(run.spindle_rpm)) return false;
    }
    const bool is_in_order = index == 0 ? run.first == 0 : run.first > done || vertices.empty();
    if (!is_in_order || run.first > vertices.size()) return false;
    for (; done < run.first; ++done) {
      PathVertex& vertex = vertices[done];
      vertex.feed_mm_per_min = before.feed_mm_per_min;
      vertex.spindle_rpm = before.spindle_rpm;
      vertex.tool = before.tool;
      vertex.operation = before.operation;
    }
    before = run;
  }
  return true;
}

bool take_arcs(FieldReader& in, std::uint32_t count, std::vector<PathVertex>& vertices) {
  std::size_t next = 0;
  const auto skip_lines = [&] {
    while (next < vertices.size() && !is_arc(vertices[next].kind)) ++next;
  };
  for (std::uint32_t index = 0; index < count; ++index) {
    skip_lines();
    if (next >= vertices.size() || in.take<std::uint32_t>() != next) return false;
    PathVertex& vertex = vertices[next++];
    for (float& offset : vertex.center_offset_mm) offset = in.take<float>();
    vertex.turns = in.take<std::uint16_t>();
    const auto plane = in.take<std::uint8_t>();
    static_cast<void>(in.take<std::uint8_t>());
    const bool is_sound = std::isfinite(vertex.center_offset_mm[0]) && std::isfinite(vertex.center_offset_mm[1]) &&
                          vertex.turns > 0 && plane < kPlanes;
    if (!is_sound) return false;
    vertex.plane = static_cast<ArcPlane>(plane);
  }
  skip_lines();
  return next >= vertices.size();
}

Taken<ToolpathItem> take_chunk(FieldReader in) {
  LevelChunk item;
  PathVertex& start = item.chunk.start;
  item.level = in.take<std::uint32_t>();
  ChunkCounts counts;
  counts.vertices = in.take<std::uint32_t>();
  counts.runs = in.take<std::uint32_t>();
  counts.arcs = in.take<std::uint32_t>();
  start.time_s = in.take<double>();
  start.at_mm = take_point(in);
  start.line = in.take<std::uint32_t>();
  start.tool = in.take<std::uint16_t>();
  start.operation = in.take<std::uint16_t>();
  start.unknown_axes = in.take<std::uint8_t>();
  in.align(kAlignment);
  const auto bounds = take_bounds(in);
  if (in.is_short() || in.left() < counts.bytes() || in.left() - counts.bytes() >= kAlignment) {
    return std::unexpected(Fault::WrongSize);
  }
  if (!bounds || !is_finite(start.at_mm) || !std::isfinite(start.time_s) || start.unknown_axes > kMostUnknown) {
    return std::unexpected(Fault::BadValue);
  }
  item.chunk.bounds = *bounds;
  auto& vertices = item.chunk.vertices;
  vertices.resize(counts.vertices);
  bool is_sound = true;
  for (PathVertex& vertex : vertices) {
    vertex.at_mm = take_point(in);
    is_sound = is_sound && is_finite(vertex.at_mm);
  }
  for (PathVertex& vertex : vertices) {
    const float after_s = in.take<float>();
    is_sound = is_sound && std::isfinite(after_s);
    vertex.time_s = start.time_s + static_cast<double>(after_s);
  }
  for (PathVertex& vertex : vertices) vertex.line = in.take<std::uint32_t>();
  is_sound = is_sound && take_kinds(in, vertices);
  in.align(sizeof(std::uint32_t));
  is_sound = is_sound && take_runs(in, counts.runs, vertices) && take_arcs(in, counts.arcs, vertices);
  if (!is_sound) return std::unexpected(Fault::BadValue);
  return item;
}

Taken<ToolpathItem> take_names(FieldReader in) {
  ToolpathNames names;
  const auto count = in.take<std::uint32_t>();
  if (in.left() / sizeof(std::uint32_t) < count) return std::unexpected(Fault::WrongSize);
  for (std::uint32_t name = 0; name < count && !in.is_short(); ++name) {
    names.operations.emplace_back(in.take_text(in.take<std::uint32_t>()));
    in.align(sizeof(std::uint32_t));
  }
  if (in.is_short()) return std::unexpected(Fault::WrongSize);
  return names;
}

Taken<ToolpathItem> take_times(FieldReader in) {
  ToolpathTimes times;
  const auto count = in.take<std::uint64_t>();
  if (in.is_short() || in.left() / kTimeMarkBytes < count) return std::unexpected(Fault::WrongSize);
  TimeMark before;
  for (std::uint64_t mark = 0; mark < count; ++mark) {
    TimeMark next;
    next.path_s = in.take<double>();
    next.machine_s = in.take<double>();
    const bool is_sound = std::isfinite(next.path_s) && std::isfinite(next.machine_s) && next.path_s >= before.path_s &&
                          next.machine_s >= before.machine_s;
    if (!is_sound) return std::unexpected(Fault::BadValue);
    times.marks.push_back(next);
    before = next;
  }
  return times;
}

Taken<ToolpathItem> take_end(FieldReader in) {
  ToolpathEnd end;
  end.vertices = in.take<std::uint64_t>();
  end.time_s = in.take<double>();
  end.refused_lines = in.take<std::uint32_t>();
  static_cast<void>(in.take<std::uint32_t>());
  const auto bounds = take_bounds(in);
  if (in.is_short()) return std::unexpected(Fault::WrongSize);
  if (!bounds || !std::isfinite(end.time_s)) return std::unexpected(Fault::BadValue);
  end.bounds = *bounds;
  return end;
}

Taken<ToolpathItem> take_payload(std::string_view tag, std::string_view payload) {
  const FieldReader in(payload);
  if (tag == kHeadTag) return take_head(in);
  if (tag == kChunkTag) return take_chunk(in);
  if (tag == kNamesTag) return take_names(in);
  if (tag == kTimesTag) return take_times(in);
  if (tag == kEndTag) return take_end(in);
  ToolpathUnknown unknown;
  std::ranges::copy(tag, unknown.tag.begin());
  return unknown;
}

}  // namespace

std::string encode(const ToolpathHead& head) {
  FieldWriter out;
  out.put(static_cast<std::uint32_t>(head.tolerances_mm.size())).put(std::uint32_t{0});
  for (std::size_t at = 0; at < kHashDigits; at += 2) {
    const auto digits = at < head.hash.size() ? std::string_view{head.hash}.substr(at, 2) : std::string_view{};
    out.put(base::parse_int<std::uint8_t>(digits, kHex).value_or(0));
  }
  for (const float tolerance : head.tolerances_mm) out.put(tolerance);
  return section(kHeadTag, std::move(out));
}

std::string encode(const LevelChunk& item) {
  const PathVertex& start = item.chunk.start;
  const auto& vertices = item.chunk.vertices;
  std::vector<Run> runs;
  ChunkCounts counts{.vertices = static_cast<std::uint32_t>(vertices.size())};
  for (std::uint32_t at = 0; at < counts.vertices; ++at) {
    Run run = run_of(vertices[at]);
    run.first = at;
    if (runs.empty() || !same(runs.back(), run)) runs.push_back(run);
    if (is_arc(vertices[at].kind)) ++counts.arcs;
  }
  counts.runs = static_cast<std::uint32_t>(runs.size());
  FieldWriter out;
  constexpr std::size_t kChunkHead = 72;
  out.reserve(kChunkHead + static_cast<std::size_t>(counts.bytes()) + kAlignment);
  out.put(item.level).put(counts.vertices).put(counts.runs).put(counts.arcs).put(start.time_s);
  for (const float value : start.at_mm) out.put(value);
  out.put(start.line).put(start.tool).put(start.operation).put(start.unknown_axes).align(kAlignment);
  put_bounds(out, item.chunk.bounds);
  for (const PathVertex& vertex : vertices) {
    for (const float value : vertex.at_mm) out.put(value);
  }
  for (const PathVertex& vertex : vertices) out.put(static_cast<float>(vertex.time_s - start.time_s));
  for (const PathVertex& vertex : vertices) out.put(vertex.line);
  for (const PathVertex& vertex : vertices) {
    const unsigned unknown = static_cast<unsigned>(vertex.unknown_axes) << kUnknownShift;
    out.put(static_cast<std::uint8_t>(static_cast<unsigned>(vertex.kind) | unknown));
  }
  out.align(sizeof(std::uint32_t));
  for (const Run& run : runs) {
    out.put(run.first).put(run.feed_mm_per_min).put(run.spindle_rpm).put(run.tool).put(run.operation);
  }
  for (std::uint32_t at = 0; at < counts.vertices; ++at) {
    const PathVertex& vertex = vertices[at];
    if (!is_arc(vertex.kind)) continue;
    out.put(at).put(vertex.center_offset_mm[0]).put(vertex.center_offset_mm[1]).put(vertex.turns);
    out.put(static_cast<std::uint8_t>(vertex.plane)).put(std::uint8_t{0});
  }
  return section(kChunkTag, std::move(out));
}

std::string encode(const ToolpathNames& names) {
  FieldWriter out;
  out.put(static_cast<std::uint32_t>(names.operations.size()));
  for (const std::string& name : names.operations) {
    out.put(static_cast<std::uint32_t>(name.size())).put(name).align(sizeof(std::uint32_t));
  }
  return section(kNamesTag, std::move(out));
}

std::string encode(const ToolpathTimes& times) {
  FieldWriter out;
  out.put(static_cast<std::uint64_t>(times.marks.size()));
  for (const TimeMark& mark : times.marks) out.put(mark.path_s).put(mark.machine_s);
  return section(kTimesTag, std::move(out));
}

std::string encode(const ToolpathEnd& end) {
  FieldWriter out;
  out.put(end.vertices).put(end.time_s).put(end.refused_lines).put(std::uint32_t{0});
  put_bounds(out, end.bounds);
  return section(kEndTag, std::move(out));
}

std::expected<ToolpathItem, ToolpathFault> take_toolpath_item(std::string_view& bytes) {
  FieldReader in(bytes);
  const std::string_view tag = in.take_text(kTagBytes);
  static_cast<void>(in.take<std::uint32_t>());
  const auto size = in.take<std::uint64_t>();
  if (in.is_short()) return std::unexpected(Fault::Incomplete);
  if (size % kAlignment != 0) return std::unexpected(Fault::NotAligned);
  if (in.left() < size) return std::unexpected(Fault::Incomplete);
  auto item = take_payload(tag, bytes.substr(kSectionHead, static_cast<std::size_t>(size)));
  if (item) bytes.remove_prefix(kSectionHead + static_cast<std::size_t>(size));
  return item;
}

}  // namespace kerf::rehearsal
