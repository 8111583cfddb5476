// Settings changed on the virtual controllers: all or nothing, whatever happens meanwhile.

#include <chrono>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using session::SettingsOutcome;
using testing::SizeIs;
using vocabulary::Firmware;

class Settings : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, Settings, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

bool is_changed(const simulation::World& world) {
  return !told<session::SettingsChanged>(world).empty();
}

const std::vector<machine::SettingAssignment> kWanted{{"20", "1"},    {"110", "4321"}, {"13", "1"},    {"22", "1"},
                                                      {"130", "150"}, {"23", "5"},     {"111", "77.5"}};

TEST_P(Settings, ASetIsWrittenReadBackAndPutBack) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  const auto before = machine::settings_of(world.session().capabilities());
  world.submit(session::ChangeSettings{.settings = kWanted, .reason = "scenario"});
  ASSERT_TRUE(world.run_until(is_changed, 60s));
  const auto first = told<session::SettingsChanged>(world).back().result;
  EXPECT_EQ(first.outcome, SettingsOutcome::Done) << first.sentence;
  EXPECT_THAT(first.changed, SizeIs(7));
  const auto& now = world.session().capabilities();
  EXPECT_THAT(machine::plan_settings(now, kWanted)->steps, SizeIs(0));
  world.submit(session::ChangeSettings{.settings = before, .reason = "back"});
  world.run_for(60s);
  EXPECT_EQ(told<session::SettingsChanged>(world).back().result.outcome, SettingsOutcome::Done);
  EXPECT_THAT(machine::differences(now, before, machine::settings_of(world.session().capabilities())), SizeIs(0));
}

/// Holds, resumes and resets at random instants of a change: it is all there, all back, or said to be broken off; and
/// the session is none the worse for it.
TEST_P(Settings, SomebodyPressesKeysMeanwhile) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937 dice{seed};
    World world{quick_serial(GetParam())};
    ASSERT_TRUE(connect(world));
    world.submit(session::ChangeSettings{.settings = kWanted, .reason = "scenario"});
    constexpr std::string_view kKeys = "!~\x18";
    for (int press = 0; press < 2; ++press) {
      world.run_for(std::chrono::milliseconds{dice() % 400});
      world.submit(session::SendRealtime{static_cast<std::uint8_t>(kKeys[dice() % kKeys.size()])});
    }
    world.run_for(20s);
    world.submit(session::SendRealtime{'~'});
    ASSERT_TRUE(world.run_until(is_changed, 120s)) << seed;
    const auto result = told<session::SettingsChanged>(world).front().result;
    if (result.outcome == SettingsOutcome::Done) {
      EXPECT_THAT(result.changed, SizeIs(7)) << seed;
    }
    if (result.outcome == SettingsOutcome::RolledBack) {
      EXPECT_THAT(result.changed, SizeIs(0)) << seed;
    }
    EXPECT_TRUE(world.run_until(is_ready, 60s)) << seed;
  }
}

// Firmware runs a startup line when it is written: a change waits for its end. What was there before comes back.
TEST_P(Settings, StartupLinesBelongToTheSet) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  const auto before = machine::settings_of(world.session().capabilities());
  world.submit(session::ChangeSettings{
      .settings = {{"N1", "G54 G17"}, {"N0", "G0 X5"}, {"110", "4321"}, {"N0", "G1 X5 F600"}}, .reason = "scenario"});
  ASSERT_TRUE(world.run_until(is_changed, 60s));
  const auto result = told<session::SettingsChanged>(world).back().result;
  EXPECT_EQ(result.outcome, SettingsOutcome::Done) << result.sentence;
  EXPECT_THAT(result.changed, SizeIs(3));
  const auto& known = world.session().capabilities();
  EXPECT_EQ(machine::stored_form_of(known.find_setting("N1")->value.value_or("")), "G54G17");
  const auto sent = told<session::LineSent>(world);
  const auto is_line = [](std::string_view text) {
    return [text](const session::LineSent& line) { return line.text.starts_with(text); };
  };
  EXPECT_LT(std::ranges::find_if(sent, is_line("$110=")), std::ranges::find_if(sent, is_line("$N0=")));
  world.submit(session::ChangeSettings{.settings = before, .reason = "back"});
  world.run_for(60s);
  EXPECT_EQ(told<session::SettingsChanged>(world).back().result.outcome, SettingsOutcome::Done);
  EXPECT_EQ(world.session().capabilities().find_setting("N0")->value, "");
}

TEST_P(Settings, AMachineInMotionIsNotWrittenTo) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.submit(session::SendLine{"G1X50F600"});
  world.run_for(500ms);
  world.submit(session::ChangeSettings{.settings = kWanted, .reason = "scenario"});
  world.run_for(1s);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::Setting), 0U);
  EXPECT_THAT(told<session::CommandRefused>(world), SizeIs(1));
}

}  // namespace
}  // namespace kerf::scenarios
