// Overrides as an operator sets them with a slider.

#include <chrono>
#include <utility>

#include "scenario.hpp"
#include "sender/session/override_pursuit.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using session::OverridePursuit;
using session::OverrideWish;
using vocabulary::Firmware;

class Overrides : public testing::TestWithParam<Firmware> {};

void pursue(World& world, OverridePursuit& pursuit, Duration time) {
  const Instant end = world.now() + time;
  std::uint64_t seen = 0;
  while (world.step(end)) {
    if (std::exchange(seen, world.session().snapshot().reports) == world.session().snapshot().reports) continue;
    for (const char byte : pursuit.on_report(world.session().snapshot())) {
      world.submit(session::SendRealtime{static_cast<std::uint8_t>(byte)});
    }
  }
}

TEST_P(Overrides, AreReachedInAJobAndAtRest) {
  World world(quick_serial(GetParam()));
  ASSERT_TRUE(start(world, zigzag(200), 2s));
  OverridePursuit pursuit;
  const std::vector<machine::OverridePercentages> wanted{
      {.feed = 137, .rapid = 50, .spindle = 84}, {.feed = 10, .rapid = 25, .spindle = 200}, {}};
  for (const auto& aim : wanted) {
    pursuit.aim_at({.feed = aim.feed, .rapid = aim.rapid, .spindle = aim.spindle});
    pursue(world, pursuit, 12s);
    EXPECT_TRUE(pursuit.is_over());
    EXPECT_EQ(world.session().snapshot().overrides, aim);
  }
  world.submit(session::StopJob{});
  pursue(world, pursuit, 5s);
  pursuit.aim_at({.feed = 55});
  pursue(world, pursuit, 12s);
  EXPECT_TRUE(pursuit.is_over());
  EXPECT_EQ(world.session().snapshot().overrides->feed, 55);
}

TEST(OverridePursuit, KnowsWhatCannotBeReached) {
  EXPECT_EQ(OverridePursuit::why_not({.feed = 10, .rapid = 25, .spindle = 200}), "");
  EXPECT_NE(OverridePursuit::why_not({.feed = 9}), "");
  EXPECT_NE(OverridePursuit::why_not({.spindle = 201}), "");
  EXPECT_NE(OverridePursuit::why_not({.rapid = 75}), "");
}

TEST(OverridePursuit, GivesUpOnAControllerThatDoesNotFollow) {
  OverridePursuit pursuit;
  pursuit.aim_at({.feed = 120});
  const machine::Snapshot deaf;
  std::size_t bytes = 0;
  for (int report = 0; report < 100; ++report) bytes += pursuit.on_report(deaf).size();
  EXPECT_TRUE(pursuit.is_over());
  EXPECT_LT(bytes, 12U);
}

INSTANTIATE_TEST_SUITE_P(Every, Overrides, testing::ValuesIn(kFirmwares),
                         [](const auto& on) { return word_for(on.param); });

}  // namespace
}  // namespace kerf::scenarios
