#include "rehearsal/toolpath_levels.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "rehearsal/toolpath_reader.hpp"
#include "rehearsal/toolpath_time.hpp"

namespace kerf::rehearsal {
namespace {

using testing::DoubleNear;

PathStart start_of_grblhal() {
  simulation::CaseMachine machine{.personality = firmware::personality_of(vocabulary::Firmware::GrblHal)};
  machine.stored.initialised = true;
  return path_start_of(machine);
}

constexpr std::array<float, 3> kTolerances{0.02F, 0.1F, 0.5F};

struct Levels {
  std::vector<PathVertex> path;
  std::vector<std::vector<PathVertex>> levels{kTolerances.size()};
};

Levels levels_of(std::string_view text, std::size_t most_vertices) {
  Levels all;
  ToolpathReader reader(text, start_of_grblhal());
  LevelBuilder builder(kTolerances);
  PathChunk chunk;
  const auto collect = [&] {
    for (auto& [level, part] : builder.take()) {
      auto& into = all.levels.at(level - 1);
      const Point end = into.empty() ? Point{} : into.back().at_mm;
      EXPECT_EQ(part.start.at_mm, end);
      into.insert(into.end(), part.vertices.begin(), part.vertices.end());
    }
  };
  for (bool goes_on = true; goes_on;) {
    goes_on = reader.read_on(chunk, most_vertices);
    all.path.insert(all.path.end(), chunk.vertices.begin(), chunk.vertices.end());
    builder.add(chunk);
    collect();
  }
  builder.finish();
  collect();
  return all;
}

double distance_to(const Point& from, const Point& to, const Point& point) {
  double way = 0;
  double length = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double along = static_cast<double>(to[axis]) - static_cast<double>(from[axis]);
    way += along * (static_cast<double>(point[axis]) - static_cast<double>(from[axis]));
    length += along * along;
  }
  const auto share = static_cast<float>(length > 0 ? std::clamp(way / length, 0.0, 1.0) : 0.0);
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += std::pow(static_cast<double>(point[axis] - std::lerp(from[axis], to[axis], share)), 2);
  }
  return std::sqrt(square);
}

double distance_to(const std::vector<PathVertex>& path, const Point& point) {
  Point before{};
  double least = distance_to(before, before, point);
  for (const PathVertex& vertex : path) {
    least = std::min(least, distance_to(before, vertex.at_mm, point));
    before = vertex.at_mm;
  }
  return least;
}

RC_GTEST_PROP(ToolpathLevels, EveryPlaceIsWithinTheTolerance, ()) {
  std::string text = "G21 G90 F100\n";
  double x = 0;
  for (int line = *rc::gen::inRange(1, 60); line > 0; --line) {
    x += *rc::gen::inRange(-100, 300) / 100.0;
    const double y = *rc::gen::inRange(-30, 30) / 100.0;
    const auto place = " X" + std::to_string(x) + " Y" + std::to_string(y);
    text += *rc::gen::elementOf(std::vector<std::string>{"G1" + place, "G1" + place, "G1" + place, "G0" + place,
                                                         "G2" + place + " R400", "T1 M6", "T2 M6", "G4 P0.1",
                                                         "G1 Z-" + std::to_string(y + 1)});
    text += '\n';
  }
  const Levels all = levels_of(text, *rc::gen::inRange<std::size_t>(1, 50));
  std::size_t most = all.path.size() * 100;
  for (std::size_t level = 0; level < kTolerances.size(); ++level) {
    RC_ASSERT(all.levels[level].size() <= most);
    most = all.levels[level].size();
    const double tolerance = static_cast<double>(kTolerances.at(level)) + 1e-4;
    Point before{};
    for (const PathVertex& vertex : all.path) {
      std::vector<Point> points{vertex.at_mm};
      if (is_arc(vertex.kind)) append_chords(before, vertex, 0.001F, points);
      for (const Point& point : points) RC_ASSERT(distance_to(all.levels[level], point) <= tolerance);
      before = vertex.at_mm;
    }
    if (!all.path.empty() && !all.levels[level].empty()) {
      RC_ASSERT(all.levels[level].back().at_mm == all.path.back().at_mm);
    }
  }
}

TEST(ToolpathLevels, AFinePathHasACoarseOne) {
  std::string text = "G21 G90 F1000\n";
  for (int step = 0; step < 20'000; ++step) {
    text += "G1 X" + std::to_string(step * 0.01) + " Y" + std::to_string(std::sin(step * 0.001)) + "\n";
  }
  const Levels all = levels_of(text, 4096);
  EXPECT_GT(all.path.size(), 19'000U);
  EXPECT_LT(all.levels[0].size(), 800U);
  EXPECT_LT(all.levels[2].size(), 60U);
}

TEST(ToolpathLevels, ToolChangesAreOnAllLevels) {
  const Levels all = levels_of("G21 G90 F100\nT1 M6\nG1 X0.001\nX0.002\nT2 M6\nX0.003\n", 100);
  for (const auto& level : all.levels) {
    EXPECT_EQ(std::ranges::count(level, PathKind::ToolChange, &PathVertex::kind), 2);
  }
}

TEST(TimeLine, GivesThePathTheTimesOfTheMachine) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(vocabulary::Firmware::GrblHal)};
  machine.stored.initialised = true;
  std::string text = "G21 G90 F400\n";
  for (int step = 1; step < 200; ++step) text += "G1 X" + std::to_string(step % 2 * 3) + "\n";
  const auto program = *job::Program::load("part.nc", text);
  const auto estimate = estimate_job(*program, machine);
  const TimeLine line = time_line_of(estimate, program->line_count(), program->text(), path_start_of(machine));
  ASSERT_FALSE(line.marks().empty());
  EXPECT_THAT(line.machine_s(line.marks().back().path_s), DoubleNear(estimate.total_s, 0.2));
  EXPECT_EQ(line.machine_s(0), 0);
  double before = 0;
  for (double path_s = 0; path_s < line.marks().back().path_s; path_s += 0.37) {
    EXPECT_GE(line.machine_s(path_s), before);
    before = line.machine_s(path_s);
  }
  EXPECT_EQ(TimeLine({}).machine_s(7), 7);
}

}  // namespace
}  // namespace kerf::rehearsal
