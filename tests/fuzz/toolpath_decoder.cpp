// Any bytes are sections of a toolpath or a fault: nothing crashes, what is taken can be drawn, and what is written
// again is read again.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "rehearsal/toolpath_format.hpp"

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

template <typename Item>
void write_again(const Item& item) {
  const std::string bytes = rehearsal::encode(item);
  std::string_view rest = bytes;
  const auto again = rehearsal::take_toolpath_item(rest);
  require(again.has_value() && rest.empty());
  require(std::get<Item>(*again) == item);
}

void check(const rehearsal::LevelChunk& item) {
  const std::string bytes = rehearsal::encode(item);
  std::string_view rest = bytes;
  const auto again = rehearsal::take_toolpath_item(rest);
  // Times are rounded once more, and may leave the range of their 24 bits.
  if (again) {
    const auto& chunk = std::get<rehearsal::LevelChunk>(*again).chunk;
    require(chunk.vertices.size() == item.chunk.vertices.size());
    for (std::size_t at = 0; at < chunk.vertices.size(); ++at) {
      require(chunk.vertices[at].at_mm == item.chunk.vertices[at].at_mm);
      require(chunk.vertices[at].kind == item.chunk.vertices[at].kind);
      require(chunk.vertices[at].tool == item.chunk.vertices[at].tool);
    }
  }
  std::vector<rehearsal::Point> points;
  const rehearsal::PathVertex* before = &item.chunk.start;
  for (const auto& vertex : item.chunk.vertices) {
    constexpr float kTolerance_mm = 0.1F;
    constexpr std::uint16_t kFewTurns = 20;
    if (rehearsal::is_arc(vertex.kind) && vertex.turns < kFewTurns) {
      points.clear();
      rehearsal::append_chords(before->at_mm, vertex, kTolerance_mm, points);
      require(!points.empty() && points.back() == vertex.at_mm);
    }
    before = &vertex;
  }
  constexpr float kTolerances_mm[] = {0.1F, 1.0F};
  rehearsal::LevelBuilder levels(kTolerances_mm);
  levels.add(item.chunk);
  levels.finish();
  (void)levels.take();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::string_view rest{reinterpret_cast<const char*>(bytes), size};
  while (const auto item = rehearsal::take_toolpath_item(rest)) {
    if (const auto* chunk = std::get_if<rehearsal::LevelChunk>(&*item)) check(*chunk);
    if (const auto* head = std::get_if<rehearsal::ToolpathHead>(&*item)) write_again(*head);
    if (const auto* names = std::get_if<rehearsal::ToolpathNames>(&*item)) write_again(*names);
    if (const auto* times = std::get_if<rehearsal::ToolpathTimes>(&*item)) write_again(*times);
    if (const auto* end = std::get_if<rehearsal::ToolpathEnd>(&*item)) write_again(*end);
  }
  return 0;
}
