#include "rehearsal/toolpath_reader.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::rehearsal {
namespace {

using simulation::CaseMachine;
using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::FloatNear;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;

CaseMachine machine_of(Firmware firmware) {
  CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"110", "6000"}, {"111", "6000"}, {"112", "3000"}};
  return machine;
}

struct WholePath {
  std::vector<PathVertex> vertices;
  PathBounds bounds{};
  std::uint32_t refused_lines = 0;
  std::vector<std::string> operations{};

  [[nodiscard]] std::vector<PathKind> kinds() const {
    std::vector<PathKind> kinds;
    for (const PathVertex& vertex : vertices) kinds.push_back(vertex.kind);
    return kinds;
  }
};

WholePath path_of(std::string_view text, Firmware firmware = Firmware::GrblHal, std::size_t most = 7) {
  ToolpathReader reader(text, path_start_of(machine_of(firmware)));
  WholePath path;
  PathChunk chunk;
  for (bool goes_on = true; goes_on;) {
    goes_on = reader.read_on(chunk, most);
    EXPECT_LE(chunk.vertices.size(), most + 1);
    const Point end = path.vertices.empty() ? Point{} : path.vertices.back().at_mm;
    EXPECT_EQ(chunk.start.at_mm, end);
    path.vertices.insert(path.vertices.end(), chunk.vertices.begin(), chunk.vertices.end());
  }
  path.bounds = reader.bounds();
  path.refused_lines = reader.refused_lines();
  path.operations = reader.operations();
  return path;
}

class Paths : public testing::TestWithParam<Firmware> {};

TEST_P(Paths, MotionsAndEventsComeInOrderWithTheirLines) {
  const auto path =
      path_of("g21 g90\nT1\nM3 S1000\nG4 P2\nG0 X10 Y0 Z5\nG1 Z-1 F60\n\nG2 X20 I5 J0\nM5\nM30\nG1 X99\n", GetParam());
  EXPECT_THAT(path.kinds(), ElementsAre(PathKind::ToolChange, PathKind::SpindleChange, PathKind::Dwell, PathKind::Rapid,
                                        PathKind::Feed, PathKind::ArcClockwise, PathKind::SpindleChange));
  ASSERT_THAT(path.vertices, SizeIs(7));
  EXPECT_EQ(path.vertices[5].line, 8U);
  EXPECT_EQ(path.vertices[5].tool, 1);
  EXPECT_EQ(path.vertices[5].spindle_rpm, 1000);
  EXPECT_EQ(path.vertices[4].feed_mm_per_min, 60);
  EXPECT_THAT(path.vertices[2].time_s, DoubleNear(2, 1e-6));
  EXPECT_THAT(path.vertices[4].time_s - path.vertices[3].time_s, DoubleNear(6, 1e-6));
  EXPECT_EQ(path.refused_lines, 0U);
}

TEST_P(Paths, ArcsAreBoundedByTheirFullExtent) {
  const auto path = path_of("G21 G90 F100\nG0 X10 Y0 Z0\nG1 Z-1\nG3 X-10 Y0 I-10 J0\n", GetParam());
  EXPECT_THAT(path.bounds.most_mm[1], FloatNear(10, 1e-4F));
  EXPECT_THAT(path.bounds.least_mm[0], FloatNear(-10, 1e-4F));
  EXPECT_THAT(path.bounds.least_mm[1], FloatNear(0, 1e-4F));
}

TEST_P(Paths, PlacesThatTheProgramHasNotToldAreUnknown) {
  const auto path = path_of("G21 G90\nG53 G0 Z-5\nG0 X100 Y100\nG0 Z2\nG1 X110 F100\nG28\n", GetParam());
  std::vector<int> unknown;
  for (const auto& vertex : path.vertices) unknown.push_back(vertex.unknown_axes);
  ASSERT_GE(unknown.size(), 4U);
  EXPECT_EQ(unknown[0], 0b111);
  EXPECT_EQ(unknown[1], 0b100);
  EXPECT_EQ(unknown[2], 0);
  EXPECT_EQ(unknown.back(), 0b111);
  EXPECT_EQ(path.bounds.least_mm, (Point{100, 100, 2}));
}

TEST_P(Paths, AProgramThatOnlyTellsWaysBeginsAtZero) {
  const auto path = path_of("G21 G91\nG1 X10 F100\nY10\nX-10\nY-10\n", GetParam());
  EXPECT_EQ(path.bounds.least_mm, (Point{0, 0, 0}));
  EXPECT_EQ(path.bounds.most_mm, (Point{10, 10, 0}));
}

TEST_P(Paths, ALaserThatDoesNotBurnOnlyTravels) {
  const auto path = path_of("G21 G90 F100\nM4 S100\nG1 X1\nX2 S0\nX3 S50\n", GetParam());
  std::vector<PathKind> kinds = path.kinds();
  std::erase(kinds, PathKind::SpindleChange);
  EXPECT_THAT(kinds, ElementsAre(PathKind::Feed, PathKind::Travel, PathKind::Feed));
}

TEST_P(Paths, RefusedLinesAreCountedAndPassedOver) {
  const auto path = path_of("G21 G90 F100\nG1 X1\nG99.7 X50\nX2\n", GetParam());
  EXPECT_EQ(path.refused_lines, 1U);
  EXPECT_EQ(path.bounds.most_mm[0], 2);
}

TEST_P(Paths, ToolsAndOperationsAreTold) {
  const auto path = path_of("G21 G90 F100\n(Toolpath:- A)\nT3 M6\nG1 X1\n(Toolpath:- B)\nT4 M6\nX2\n", GetParam());
  EXPECT_THAT(path.operations, ElementsAre("", "A", "B"));
  EXPECT_EQ(path.vertices.back().tool, 4);
  EXPECT_EQ(path.vertices.back().operation, 2);
}

INSTANTIATE_TEST_SUITE_P(Firmwares, Paths, testing::Values(Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal),
                         [](const auto& value) {
                           return std::string{boost::describe::enum_to_string(value.param, "?")};
                         });

RC_GTEST_PROP(Toolpath, ChunksNeverChangeThePath, ()) {
  std::string text = "G21 G90 F100\n";
  for (int line = *rc::gen::inRange(0, 40); line > 0; --line) {
    text += *rc::gen::elementOf(std::vector<std::string>{"G0 X1 Y2", "G1 X5", "G91 X1 Z-1", "G90", "G2 X9 Y2 R20",
                                                         "G81 X1 Y1 Z-2 R1", "M3 S5", "(MSG,a)", "G53 G0 Z0", "T2 M6"});
    text += '\n';
  }
  const auto whole = path_of(text, Firmware::GrblHal, 10'000);
  const auto pieces = path_of(text, Firmware::GrblHal, *rc::gen::inRange<std::size_t>(1, 9));
  RC_ASSERT(whole.vertices == pieces.vertices);
  RC_ASSERT(whole.bounds == pieces.bounds);
}

RC_GTEST_PROP(Toolpath, ChordsStayWithinTheirTolerance, ()) {
  const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-5000, 5000)) / 100.0F; };
  const Point start{coordinate(), coordinate(), coordinate()};
  const float radius = 0.01F * static_cast<float>(*rc::gen::inRange(10, 10'000));
  const float angle = 0.001F * static_cast<float>(*rc::gen::inRange(1, 6283));
  PathVertex end{.kind = *rc::gen::elementOf(std::vector{PathKind::ArcClockwise, PathKind::ArcCounterclockwise})};
  end.center_offset_mm = {radius, 0};
  end.at_mm = {start[0] + radius - radius * std::cos(angle), start[1] + radius * std::sin(angle), coordinate()};
  const float tolerance = 0.001F * static_cast<float>(*rc::gen::inRange(2, 1000));
  std::vector<Point> points{start};
  append_chords(start, end, tolerance, points);
  RC_ASSERT(points.back() == end.at_mm);
  PathBounds bounds;
  include_motion(bounds, start, end);
  for (std::size_t at = 1; at < points.size(); ++at) {
    const float middle_1 = (points[at][0] + points[at - 1][0]) / 2 - start[0] - radius;
    const float middle_2 = (points[at][1] + points[at - 1][1]) / 2 - start[1];
    RC_ASSERT(radius - std::hypot(middle_1, middle_2) <= tolerance * 1.05F + 1e-3F);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      RC_ASSERT(points[at][axis] <= bounds.most_mm[axis] + 1e-3F);
      RC_ASSERT(points[at][axis] >= bounds.least_mm[axis] - 1e-3F);
    }
  }
}

}  // namespace
}  // namespace kerf::rehearsal
