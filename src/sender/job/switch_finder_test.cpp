#include "sender/job/switch_finder.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::job {
namespace {

using Verdict = SwitchFinder::Verdict;

/// Closed at and beyond `closes`; open again `slack` steps before that.
struct Switch {
  std::int64_t closes = 0;
  std::int64_t slack = 0;
  int direction = 1;
  bool closed = false;

  bool at(std::int64_t step) {
    if ((step - closes) * direction >= 0) closed = true;
    if ((step - closes + slack * direction) * direction < 0) closed = false;
    return closed;
  }
};

SwitchSearch search(int direction) {
  return {.direction = direction, .moves = {60, 5, 1}, .back_off = 250, .farthest = direction * 1000};
}

struct Outcome {
  Verdict verdict{};
  std::int64_t found = 0;
  int moves = 0;
  std::int64_t farthest = std::numeric_limits<std::int64_t>::min();
};

Outcome run(Switch limit, std::int64_t from) {
  SwitchFinder finder(search(limit.direction), from, limit.at(from));
  Outcome outcome;
  while (finder.verdict() == Verdict::Moving && outcome.moves < 10000) {
    ++outcome.moves;
    outcome.farthest = std::max(outcome.farthest, finder.target() * limit.direction);
    finder.on_stand(limit.at(finder.target()));
  }
  outcome.verdict = finder.verdict();
  outcome.found = finder.found();
  return outcome;
}

RC_GTEST_PROP(SwitchFinder, FindsTheVeryStepFromWhereverItBegins, ()) {
  const int direction = *rc::gen::element(1, -1);
  const auto closes = *rc::gen::inRange<std::int64_t>(-1000, 900);
  const auto slack = *rc::gen::inRange<std::int64_t>(0, 200);
  const auto from = *rc::gen::inRange<std::int64_t>(-1500, 1000);
  const Outcome outcome = run({.closes = direction * closes, .slack = slack, .direction = direction}, direction * from);
  RC_ASSERT(outcome.verdict == Verdict::Found);
  RC_ASSERT(outcome.found == direction * closes);
  // Never farther into the switch than the coarsest move.
  RC_ASSERT(outcome.farthest <= std::max<std::int64_t>(closes + 60, from));
}

TEST(SwitchFinder, GivesUpAtTheFarthestPlace) {
  const Outcome outcome = run({.closes = 5000}, 0);
  EXPECT_EQ(outcome.verdict, Verdict::NotFound);
  EXPECT_LE(outcome.farthest, 1000);
}

TEST(SwitchFinder, SaysThatASwitchStaysShut) {
  EXPECT_EQ(run({.closes = -100000}, 0).verdict, Verdict::StaysShut);
}

TEST(SwitchFinder, SaysThatASwitchIsUnsteady) {
  SwitchFinder finder(search(1), 0, false);
  std::int64_t closes = 300;
  std::int64_t before = 0;
  for (int move = 0; move < 1000 && finder.verdict() == Verdict::Moving; ++move) {
    const bool forward = finder.target() > before;
    before = finder.target();
    const bool is_closed = finder.target() >= closes;
    // Closes earlier each time it is met.
    if (is_closed && forward) closes -= 100;
    finder.on_stand(is_closed);
  }
  EXPECT_NE(finder.verdict(), Verdict::Found);
  EXPECT_NE(finder.verdict(), Verdict::Moving);
}

}  // namespace
}  // namespace kerf::job
