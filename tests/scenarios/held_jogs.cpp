// Jogging by a held button, and everything that can become of the one who holds it.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scenario.hpp"
#include "sender/session/jog_lease.hpp"
#include "simulation/dice.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using session::JogLease;
using vocabulary::Firmware;
using vocabulary::MachineState;

constexpr Duration kRenewEvery = 50ms;

/// A browser with a finger on a button, and the lease that it holds.
class Finger {
 public:
  explicit Finger(simulation::World& world) : world_(world) {}

  [[nodiscard]] bool press(const session::JogWish& wish) {
    const bool begun = lease_.begin(world_.now(), wish, world_.session().snapshot());
    if (begun) on_renewed();
    return begun;
  }

  void renew() {
    if (!lease_.is_held()) return;
    lease_.renew(world_.now());
    on_renewed();
  }

  /// As the daemon does when the button is released, or the socket is gone.
  void release() {
    if (!lease_.is_held()) return;
    lease_.end();
    world_.submit(session::CancelJog{});
  }

  /// Time goes on without a word of the one who holds it; where the daemon hangs, not even its own clock ends it.
  void run_for(Duration time, bool daemon_lives = true) {
    const Instant end = world_.now() + time;
    std::uint64_t seen = world_.session().snapshot().reports;
    while (world_.step(end)) {
      if (!daemon_lives) continue;
      if (std::exchange(seen, world_.session().snapshot().reports) != world_.session().snapshot().reports) {
        lease_.on_report(world_.session().snapshot());
        send();
      }
      if (lease_.is_held() && world_.now() >= lease_.next_deadline()) release();
    }
  }

  /// Where the machine really was when the lease was last renewed.
  [[nodiscard]] const std::vector<double>& renewed_from() const { return renewed_from_; }
  [[nodiscard]] bool is_held() const { return lease_.is_held(); }

 private:
  void on_renewed() {
    renewed_from_ = world_.controller().position_mm();
    send();
  }
  void send() {
    for (std::string words = lease_.take_words(); !words.empty(); words = lease_.take_words()) {
      world_.submit(session::Jog{words});
    }
  }

  simulation::World& world_;
  JogLease lease_;
  std::vector<double> renewed_from_;
};

double distance(const std::vector<double>& from, const std::vector<double>& to) {
  double square = 0;
  for (std::size_t axis = 0; axis < from.size(); ++axis) square += std::pow(to[axis] - from[axis], 2);
  return std::sqrt(square);
}

/// Whichever way it goes, there is room: the machine has not been homed.
session::JogWish wish_by_chance(Dice& dice) {
  session::JogWish wish{.feed_mm_per_min = dice.pick({60.0, 500.0, 2000.0, 5000.0, 20000.0})};
  while (wish.direction == decltype(wish.direction){}) {
    for (std::size_t axis = 0; axis < 3; ++axis) wish.direction.at(axis) = dice.between(-1, 1);
  }
  return wish;
}

class HeldJogs : public testing::TestWithParam<Firmware> {};

bool stands(const simulation::World& world) {
  return world.session().snapshot().state == MachineState::Idle && world.session().ledger().empty();
}

TEST_P(HeldJogs, MoveTheMachineNoFurtherThanGranted) {
  constexpr int kSequences = 3400;
  auto options = quick_network(GetParam());
  options.keeps_transcript = false;
  options.keeps_wire_log = false;
  simulation::World world(options);
  ASSERT_TRUE(connect(world));
  Dice dice(2026);
  double farthest = 0;
  for (int sequence = 0; sequence < kSequences; ++sequence) {
    Finger finger(world);
    const std::vector<double> before = world.controller().position_mm();
    ASSERT_TRUE(finger.press(wish_by_chance(dice)));
    for (int renewals = dice.between(0, 12); renewals > 0; --renewals) {
      // Timers of a browser come when they come.
      finger.run_for(dice.one_in(5) ? std::chrono::milliseconds(dice.between(1, 190)) : kRenewEvery);
      if (dice.one_in(10)) finger.release();
      finger.renew();
    }
    const bool daemon_lives = !dice.one_in(3);
    if (daemon_lives && dice.one_in(2)) finger.release();
    finger.run_for(3s, daemon_lives);
    ASSERT_TRUE(world.run_until(stands, 60s)) << sequence;
    ASSERT_FALSE(finger.is_held() && daemon_lives) << sequence;
    const double beyond = distance(finger.renewed_from(), world.controller().position_mm());
    // What a step is long, on each axis.
    ASSERT_LE(beyond, session::JogLease::kGrantedMm + 0.01) << sequence;
    farthest = std::max(farthest, distance(before, world.controller().position_mm()));
  }
  EXPECT_GT(farthest, 5) << "a button that is held moves it";
}

TEST_P(HeldJogs, EndAtTheEndOfTheTravel) {
  simulation::World world(quick_network(GetParam()));
  ASSERT_TRUE(connect(world));
  const double at = world.controller().position_mm()[0];
  Finger finger(world);
  session::JogWish wish{.feed_mm_per_min = 3000, .room_mm = 7.013};
  wish.direction.at(0) = -1;
  ASSERT_TRUE(finger.press(wish));
  for (int i = 0; i < 40; ++i) {
    finger.run_for(kRenewEvery);
    finger.renew();
  }
  finger.run_for(1s);
  EXPECT_NEAR(world.controller().position_mm()[0], at - 7.013, 0.02);
}

TEST(JogLease, WantsADirectionAPaceAndAPosition) {
  session::JogLease lease;
  machine::Snapshot snapshot;
  session::JogWish wish{.feed_mm_per_min = 500};
  wish.direction.at(0) = 1;
  EXPECT_FALSE(lease.begin({}, wish, snapshot)) << "nobody knows where the machine is";
  snapshot.machine_position_mm = {0, 0, 0};
  EXPECT_TRUE(lease.begin({}, wish, snapshot));
  wish.feed_mm_per_min = 0;
  EXPECT_FALSE(session::JogLease{}.begin({}, wish, snapshot));
  wish.feed_mm_per_min = 500;
  wish.direction = {};
  EXPECT_FALSE(session::JogLease{}.begin({}, wish, snapshot));
}

INSTANTIATE_TEST_SUITE_P(Every, HeldJogs, testing::ValuesIn(kFirmwares),
                         [](const auto& on) { return word_for(on.param); });

}  // namespace
}  // namespace kerf::scenarios
