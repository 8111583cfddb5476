#include "rehearsal/toolpath_stream.hpp"

#include <utility>

namespace kerf::rehearsal {
namespace {

/// Enough to see something, and read in a few milliseconds.
constexpr std::size_t kFirstVertices = 4096;
constexpr std::size_t kVertices = 16'384;

}  // namespace

ToolpathStream::ToolpathStream(std::string_view text, PathStart start, std::string hash,
                               std::span<const float> tolerances_mm)
    : reader_(text, std::move(start)),
      levels_(tolerances_mm),
      head_{.hash = std::move(hash), .tolerances_mm = {tolerances_mm.begin(), tolerances_mm.end()}} {}

std::optional<std::string> ToolpathStream::next() {
  if (is_over_) return std::nullopt;
  std::string bytes;
  const bool is_first = !std::exchange(has_begun_, true);
  if (is_first) bytes += encode(head_);
  is_over_ = !reader_.read_on(chunk_.chunk, is_first ? kFirstVertices : kVertices);
  levels_.add(chunk_.chunk);
  if (!chunk_.chunk.vertices.empty()) bytes += encode(chunk_);
  if (is_over_) levels_.finish();
  for (const LevelChunk& full : levels_.take()) bytes += encode(full);
  if (is_over_) finish(bytes);
  return bytes;
}

void ToolpathStream::finish(std::string& bytes) {
  bytes += encode(ToolpathNames{.operations = reader_.operations()});
  bytes += encode(ToolpathEnd{.vertices = reader_.vertex_count(),
                              .refused_lines = reader_.refused_lines(),
                              .time_s = reader_.time_s(),
                              .bounds = reader_.bounds()});
}

}  // namespace kerf::rehearsal
