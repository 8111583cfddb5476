#include "io/json.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::io {

enum class Colour { Red, Green };
BOOST_DESCRIBE_ENUM(Colour, Red, Green)

struct Point {
  double x = 0;
  std::optional<double> y;
};
BOOST_DESCRIBE_STRUCT(Point, (), (x, y))

struct Drawing {
  std::string name;
  Colour colour = Colour::Red;
  std::vector<Point> points;
  std::map<std::string, int> counts;
  std::variant<int, Point> extra;
  vocabulary::MachineState state = vocabulary::MachineState::Idle;
  Instant at{};
};
BOOST_DESCRIBE_STRUCT(Drawing, (), (name, colour, points, counts, extra, state, at))

namespace {

TEST(Json, DescribedValuesKeepTheirOrder) {
  const Drawing drawing{.name = "part",
                        .colour = Colour::Green,
                        .points = {{.x = 1.5, .y = 2}, {.x = 3, .y = {}}},
                        .counts = {{"lines", 7}},
                        .extra = Point{.x = 4, .y = {}},
                        .state = vocabulary::MachineState::Hold,
                        .at = Instant{std::chrono::milliseconds(1500)}};
  EXPECT_EQ(print(to_json(drawing)),
            R"({"name":"part","colour":"Green","points":[{"x":1.5,"y":2.0},{"x":3.0}],"counts":{"lines":7},)"
            R"("extra":{"x":4.0},"state":"Hold","at":1.5})");
}

TEST(Json, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(print(Json("a\xff")), "\"a\xEF\xBF\xBD\"");
}

}  // namespace
}  // namespace kerf::io
