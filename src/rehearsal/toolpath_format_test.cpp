#include "rehearsal/toolpath_format.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "rehearsal/toolpath_stream.hpp"

namespace kerf::rehearsal {
namespace {

using testing::ElementsAre;

template <typename Item>
Item decoded(std::string_view bytes) {
  auto item = take_toolpath_item(bytes);
  EXPECT_TRUE(item.has_value());
  EXPECT_TRUE(bytes.empty());
  return std::get<Item>(*std::move(item));
}

std::string in_hex(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const char letter : bytes) {
    const auto byte = static_cast<unsigned char>(letter);
    (text += kDigits[byte / 16]) += kDigits[byte % 16];
  }
  return text;
}

PathVertex any_vertex() {
  const auto number = [] { return static_cast<float>(*rc::gen::inRange(-100'000, 100'000)) / 128.0F; };
  PathVertex vertex;
  vertex.at_mm = {number(), number(), number()};
  vertex.kind = static_cast<PathKind>(*rc::gen::inRange<int>(0, kPathKinds));
  if (is_arc(vertex.kind)) {
    vertex.center_offset_mm = {number(), number()};
    vertex.plane = static_cast<ArcPlane>(*rc::gen::inRange(0, 3));
    vertex.turns = *rc::gen::inRange<std::uint16_t>(1, 9);
  }
  vertex.line = *rc::gen::arbitrary<std::uint32_t>();
  vertex.time_s = *rc::gen::inRange(0, 100'000) / 64.0;
  vertex.feed_mm_per_min = static_cast<float>(*rc::gen::inRange(0, 3));
  vertex.spindle_rpm = static_cast<float>(*rc::gen::inRange(0, 2));
  vertex.tool = *rc::gen::inRange<std::uint16_t>(0, 3);
  vertex.operation = *rc::gen::inRange<std::uint16_t>(0, 3);
  vertex.unknown_axes = *rc::gen::inRange<std::uint8_t>(0, 8);
  return vertex;
}

RC_GTEST_PROP(ToolpathFormat, ChunksComeBack, ()) {
  LevelChunk chunk{.level = *rc::gen::inRange<std::uint32_t>(0, 5)};
  chunk.chunk.start = {.at_mm = {1, 2, 3}, .time_s = 0.5, .line = 7, .tool = 2, .operation = 1, .unknown_axes = 3};
  for (int count = *rc::gen::inRange(0, 40); count > 0; --count) chunk.chunk.vertices.push_back(any_vertex());
  for (const auto& vertex : chunk.chunk.vertices) chunk.chunk.bounds.include(vertex.at_mm);
  const auto back = decoded<LevelChunk>(encode(chunk));
  RC_ASSERT(back.level == chunk.level);
  RC_ASSERT(back.chunk.start == chunk.chunk.start);
  RC_ASSERT(back.chunk.bounds == chunk.chunk.bounds);
  RC_ASSERT(back.chunk.vertices == chunk.chunk.vertices);
}

TEST(ToolpathFormat, OtherSectionsComeBack) {
  const ToolpathHead head{.hash = "0123456789abcdef0123456789abcdef", .tolerances_mm = {0.25F, 1}};
  EXPECT_EQ(decoded<ToolpathHead>(encode(head)), head);
  const ToolpathNames names{.operations = {"", "Slot", "\xC3\xA9"}};
  EXPECT_EQ(decoded<ToolpathNames>(encode(names)), names);
  const ToolpathTimes times{.marks = {{1, 2}, {3, 4.5}}};
  EXPECT_EQ(decoded<ToolpathTimes>(encode(times)), times);
  const ToolpathEnd end{.vertices = 1ULL << 40U, .refused_lines = 3, .time_s = 12.5, .bounds = {}};
  EXPECT_EQ(decoded<ToolpathEnd>(encode(end)), end);
}

TEST(ToolpathFormat, BytesAreThoseOfTheDocument) {
  LevelChunk chunk;
  chunk.chunk.vertices.push_back({.at_mm = {1, 2, -1},
                                  .time_s = 2,
                                  .line = 5,
                                  .feed_mm_per_min = 100,
                                  .spindle_rpm = 0,
                                  .tool = 1,
                                  .operation = 2,
                                  .kind = PathKind::Feed,
                                  .unknown_axes = 4});
  chunk.chunk.bounds.include(Point{1, 2, -1});
  const std::string place = "0000803f00000040000080bf";
  const std::string zero = "00000000";
  EXPECT_EQ(in_hex(encode(chunk)), "43484e4b" + zero + "7000000000000000"         // CHNK, 112 bytes
                                       + zero + "01000000" + "01000000" + zero    // level; vertices, runs, arcs
                                       + zero + zero + zero + zero + zero + zero  // begins: time, place, line
                                       + zero + zero + place + place  // tool, operation, unknown axes; bounds
                                       + place + "00000040" + "05000000" + "41000000"  // place, time, line, kind
                                       + zero + "0000c842" + zero + "01000200");       // run
}

TEST(ToolpathFormat, WhatIsNotWholeIsIncomplete) {
  const std::string whole = encode(ToolpathNames{.operations = {"a", "b"}});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string_view bytes = std::string_view{whole}.substr(0, size);
    const auto item = take_toolpath_item(bytes);
    ASSERT_FALSE(item.has_value());
    EXPECT_EQ(item.error(), ToolpathFault::Incomplete);
    EXPECT_EQ(bytes.size(), size);
  }
}

TEST(ToolpathFormat, WhatIsUnknownIsPassedOver) {
  std::string bytes = encode(ToolpathNames{});
  bytes.replace(0, 4, "ABCD");
  std::string_view rest = bytes;
  const auto item = take_toolpath_item(rest);
  ASSERT_TRUE(item.has_value());
  EXPECT_THAT(std::get<ToolpathUnknown>(*item).tag, ElementsAre('A', 'B', 'C', 'D'));
  EXPECT_TRUE(rest.empty());
}

TEST(ToolpathStream, IsTheWholePathInSections) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(vocabulary::Firmware::GrblHal)};
  machine.stored.initialised = true;
  std::string text = "G21 G90 F1000\n(Toolpath:- Wave)\n";
  for (int step = 0; step < 30'000; ++step) {
    text += "G1 X" + std::to_string(step * 0.01) + " Y" + std::to_string(std::sin(step * 0.01)) + "\n";
  }
  ToolpathStream stream(text, path_start_of(machine), std::string(32, 'a'));
  std::string bytes;
  while (const auto piece = stream.next()) bytes += *piece;
  std::string_view rest = bytes;
  std::vector<std::size_t> vertices(4);
  std::uint64_t told = 0;
  std::vector<std::string> names;
  for (bool is_first = true; !rest.empty(); is_first = false) {
    const auto item = take_toolpath_item(rest);
    ASSERT_TRUE(item.has_value());
    EXPECT_EQ(std::holds_alternative<ToolpathHead>(*item), is_first);
    if (const auto* chunk = std::get_if<LevelChunk>(&*item)) {
      vertices.at(chunk->level) += chunk->chunk.vertices.size();
    }
    if (const auto* known = std::get_if<ToolpathNames>(&*item)) names = known->operations;
    if (const auto* end = std::get_if<ToolpathEnd>(&*item)) told = end->vertices;
  }
  EXPECT_EQ(vertices[0], told);
  EXPECT_GT(told, 29'000U);
  EXPECT_THAT(names, ElementsAre("", "Wave"));
  EXPECT_LT(vertices[3], vertices[1]);
  EXPECT_LT(vertices[3], 200U);
}

}  // namespace
}  // namespace kerf::rehearsal
