// Connecting, and links that are silent, noisy, slow or lost.

#include <chrono>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"
#include "sender/session/words_listener.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using session::SessionPhase;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class Links : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, Links, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

std::size_t resets_sent(const simulation::World& world) {
  std::size_t resets = 0;
  for (const auto& entry : world.transcript()) {
    if (entry.direction == Direction::ToController) {
      resets += static_cast<std::size_t>(std::ranges::count(entry.bytes, '\x18'));
    }
  }
  return resets;
}

TEST_P(Links, AControllerThatRestartsOnOpenIsKnownFromItsWelcome) {
  auto options = quick_serial(GetParam());
  options.opening_resets = true;
  World world{options};
  ASSERT_TRUE(connect(world));
  EXPECT_EQ(world.session().capabilities().family, GetParam());
  EXPECT_TRUE(world.session().capabilities().complete);
  EXPECT_EQ(resets_sent(world), 0U);
}

TEST_P(Links, ASilentControllerOnANetworkIsAsked) {
  auto options = quick_network(GetParam());
  options.head_start = 1min;
  World world{options};
  ASSERT_TRUE(connect(world));
  const auto& known = world.session().capabilities();
  EXPECT_EQ(known.family, GetParam());
  EXPECT_THAT(known.settings, Not(IsEmpty()));
  EXPECT_THAT(known.alarms, Not(IsEmpty()));
  EXPECT_THAT(known.errors, Not(IsEmpty()));
  EXPECT_THAT(told<session::HandshakeFailed>(world), IsEmpty());
}

/// How long it takes to know a machine that has been met before, at 115200 baud; nothing where it is not told.
Duration time_to_know(Firmware firmware, const machine::Words& words, std::string& told_of) {
  auto options = quick_serial(firmware);
  options.head_start = 1min;
  World world{options};
  world.open();
  const auto is_identified = [](const auto& w) { return is_ready(w) || !told<session::FirmwareIdentified>(w).empty(); };
  EXPECT_TRUE(world.run_until(is_identified, 60s));
  const Instant identified_at = world.now();
  if (!words.answers.empty()) world.submit(session::RecallWords{words});
  EXPECT_TRUE(world.run_until(is_ready, 60s));
  const auto& known = world.session().capabilities();
  for (const auto& error : known.errors) told_of += error.text + "\n";
  for (const auto& alarm : known.alarms) told_of += alarm.text + "\n";
  for (const auto& setting : known.settings) told_of += setting.name + setting.help + setting.group + "\n";
  return world.now() - identified_at;
}

machine::Words words_of(Firmware firmware) {
  auto options = quick_serial(firmware);
  World world{options};
  EXPECT_TRUE(connect(world));
  session::WordsListener listener;
  for (const auto& event : world.events()) listener.on_event(event);
  return listener.words();
}

TEST(LinksOfKnownMachines, AreReadyWithoutAskingForEverythingAgain) {
  for (const Firmware firmware : {Firmware::GrblHal, Firmware::Rabbit}) {
    const machine::Words words = words_of(firmware);
    ASSERT_THAT(words.answers, Not(IsEmpty()));
    std::string asked;
    std::string recalled;
    const Duration before = time_to_know(firmware, {}, asked);
    const Duration after = time_to_know(firmware, words, recalled);
    EXPECT_EQ(asked, recalled);
    RecordProperty(word_for(firmware) + "_asked_ms", static_cast<int>(before / 1ms));
    RecordProperty(word_for(firmware) + "_recalled_ms", static_cast<int>(after / 1ms));
    EXPECT_LT(after, before);
    const int factor = firmware == Firmware::GrblHal ? 4 : 1;
    EXPECT_LT(after, before / factor);
  }
}

TEST(LinksOfKnownMachines, WordsOfAnotherFirmwareAreNotTaken) {
  machine::Words words = words_of(Firmware::GrblHal);
  words.identity += "|another";
  std::string asked;
  EXPECT_GT(time_to_know(Firmware::GrblHal, words, asked), 1s);
}

TEST_P(Links, AMemoryFreshFromTheFactoryIsNoObstacle) {
  auto options = serial_world(GetParam(), 115200);
  options.opening_resets = true;
  World world{options};
  ASSERT_TRUE(connect(world));
  EXPECT_EQ(world.session().capabilities().family, GetParam());
}

TEST_P(Links, NoiseBeforeTheWelcomeIsNoObstacle) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::string noise;
    for (auto count = random() % 300; count > 0; --count) noise += static_cast<char>(random() % 256);
    auto options = quick_serial(GetParam());
    options.opening_resets = true;
    World world{options};
    world.open();
    world.inject_to_session(noise);
    ASSERT_TRUE(world.run_until(is_ready, 60s));
    EXPECT_EQ(world.session().capabilities().family, GetParam());
  }
}

TEST_P(Links, AMachineInMotionGetsNoLineAndNoReset) {
  World world{quick_serial(GetParam())};
  world.inject_to_controller("G21G91G1X100F1000\n");
  world.run_for(1s);
  world.open();
  ASSERT_TRUE(world.run_until([](const auto& w) { return w.session().phase() == SessionPhase::Waiting; }, 10s));
  ASSERT_THAT(told<session::ControllerBusy>(world), SizeIs(1));
  EXPECT_EQ(told<session::ControllerBusy>(world)[0].state, MachineState::Run);
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  EXPECT_EQ(resets_sent(world), 0U);
  ASSERT_TRUE(world.run_until(is_ready, 60s));
  // It finished what it was doing.
  EXPECT_NEAR(position_mm(world, 0), 100, 0.01);
}

TEST_P(Links, HalfALineThatSomebodyLeftIsNotExecuted) {
  World world{quick_serial(GetParam())};
  world.inject_to_controller("G21G91G0X50");
  world.run_for(1s);
  ASSERT_TRUE(connect(world));
  world.run_for(10s);
  EXPECT_NEAR(position_mm(world, 0), 0, 0.001);
}

TEST_P(Links, LosingTheLinkInterruptsAndReconnectingStartsNothing) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(30), 3s));
  world.cut_link();
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
  EXPECT_EQ(world.session().phase(), SessionPhase::Closed);
  const auto lines = lines_sent(world, streaming::Purpose::JobLine);
  world.run_for(1s);
  world.open();
  ASSERT_TRUE(world.run_until(is_ready, 5min));
  const auto stood_at = world.controller().position_steps();
  world.run_for(1min);
  EXPECT_EQ(world.controller().position_steps(), stood_at);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::JobLine), lines);
  EXPECT_EQ(world.session().job()->phase, JobPhase::Interrupted);
}

// Whatever is done when, the account adds up, the window holds, and the same seed gives the same bytes.
std::string run_at_random(Firmware firmware, unsigned seed) {
  std::mt19937 random{seed};
  World world{random() % 2 == 0 ? quick_serial(firmware) : quick_network(firmware)};
  EXPECT_TRUE(start(world, zigzag(15), std::chrono::milliseconds{random() % 2000}));
  for (int times = 0; times < 12; ++times) {
    switch (random() % 9) {
      case 0: world.submit(session::HoldJob{}); break;
      case 1: world.submit(session::ResumeJob{}); break;
      case 2: world.submit(session::StopJob{}); break;
      case 3: world.submit(session::AbortJob{}); break;
      case 4: world.inject_to_controller("\x18"); break;
      case 5: world.submit(session::SendRealtime{0x91}); break;
      case 6: world.submit(session::SendRealtime{0x84}); break;
      case 7: world.inject_to_session("\xFFnoise\r\n"); break;
      default: world.submit(session::StartJob{program(zigzag(2))}); break;
    }
    world.run_for(std::chrono::milliseconds{random() % 3000});
    const auto& ledger = world.session().ledger();
    EXPECT_EQ(ledger.lines_entered(), ledger.lines_settled() + ledger.lines_struck_out() + ledger.size());
    EXPECT_LE(ledger.bytes_in_flight(), std::max<std::size_t>(world.session().window_bytes(), 80));
  }
  return world.transcript_text();
}

TEST_P(Links, RandomDeedsLeaveAnAccountThatAddsUp) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    EXPECT_EQ(run_at_random(GetParam(), seed), run_at_random(GetParam(), seed));
  }
}

}  // namespace
}  // namespace kerf::scenarios
