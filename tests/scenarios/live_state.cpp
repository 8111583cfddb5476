// The picture of the machine stays true while others have their hands on it: pendants, automatic reports, silent links.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using session::Refused;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using vocabulary::Firmware;
using vocabulary::MachineState;

class LiveState : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, LiveState, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

std::size_t sent_bytes(const simulation::World& world, char byte) {
  std::size_t count = 0;
  for (const auto& entry : world.transcript()) {
    if (entry.direction == Direction::ToController) {
      count += static_cast<std::size_t>(std::ranges::count(entry.bytes, byte));
    }
  }
  return count;
}

WorldOptions with_pendant() {
  auto options = quick_network(Firmware::GrblHal);
  options.equipment.pendant = true;
  return options;
}

bool has_pendant(const simulation::World& world) {
  return world.session().snapshot().pendant_in_control;
}

TEST(Pendant, TakesTheMachineMovesItAndGivesItBack) {
  World world{with_pendant()};
  ASSERT_TRUE(connect(world));
  EXPECT_TRUE(world.session().capabilities().has("MPG"));
  ASSERT_TRUE(world.order("pendant take"));
  ASSERT_TRUE(world.run_until(has_pendant, 5s));
  EXPECT_THAT(told<session::PendantTookOver>(world), SizeIs(1));
  const auto lines = told<session::LineSent>(world).size();
  world.submit(session::SendLine{"G0X50"});
  world.submit(session::Home{});
  world.submit(session::StartJob{program(zigzag(2))});
  for (const auto& refused : told<session::CommandRefused>(world)) EXPECT_EQ(refused.reason, Refused::PendantInControl);
  EXPECT_THAT(told<session::CommandRefused>(world), SizeIs(3));
  // The pendant changes modes and offsets, and moves.
  ASSERT_TRUE(world.order("pendant say G91\\n"));
  ASSERT_TRUE(world.order("pendant say G10L20P2X7\\n"));
  ASSERT_TRUE(world.order("pendant say G55\\n"));
  ASSERT_TRUE(world.order("pendant say G0X3\\n"));
  world.run_for(30s);
  EXPECT_EQ(told<session::LineSent>(world).size(), lines);
  EXPECT_THAT(told<session::LinkSilent>(world), IsEmpty()) << "the link is deaf, not dead";
  ASSERT_TRUE(world.order("pendant return"));
  ASSERT_TRUE(world.run_until([](const simulation::World& w) { return !has_pendant(w); }, 5s));
  world.run_for(3s);
  EXPECT_THAT(told<session::PendantReleased>(world), SizeIs(1));
  const auto& known = world.session().snapshot();
  EXPECT_EQ(known.modes.distance, "G91");
  EXPECT_EQ(known.work_coordinate_system, "G55");
  EXPECT_NEAR(known.offsets_mm.at("G55").at(0), -7, 0.01);
  EXPECT_NEAR(known.machine_position_mm->at(0), 3, 0.01);
  EXPECT_FALSE(known.parser_state_is_old);
  EXPECT_FALSE(known.offsets_are_old);
  const auto job = run_job(world, program("G21G90G54\nG0X1\n"), 1min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
}

TEST(Pendant, ADeafLinkSaysHowControlComesBackAndAHoldIsSentAllTheSame) {
  World world{with_pendant()};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.order("pendant take"));
  ASSERT_TRUE(world.run_until(has_pendant, 5s));
  world.submit(session::HoldJob{});
  world.submit(session::TakeControl{});
  world.run_for(5s);
  EXPECT_EQ(sent_bytes(world, '!'), 1U);
  EXPECT_EQ(sent_bytes(world, '\x8b'), 1U);
  const auto refused = told<session::CommandRefused>(world);
  ASSERT_THAT(refused, SizeIs(1));
  EXPECT_EQ(refused[0].reason, Refused::ControlNotGiven);
  EXPECT_THAT(refused[0].sentence, HasSubstr("connect again"));
  EXPECT_TRUE(has_pendant(world));
}

// grblHAL obeys 0x8B from the pendant's stream only (protocol.md 1.5): whoever works the pendant gives the machine
// back.
TEST(Pendant, AskedForAndGivenBackInTimeIsNoRefusal) {
  World world{with_pendant()};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.order("pendant take"));
  ASSERT_TRUE(world.run_until(has_pendant, 5s));
  world.submit(session::TakeControl{});
  world.run_for(500ms);
  ASSERT_TRUE(world.order("pendant return"));
  world.run_for(5s);
  EXPECT_FALSE(has_pendant(world));
  EXPECT_THAT(told<session::PendantReleased>(world), SizeIs(1));
  EXPECT_THAT(told<session::CommandRefused>(world), IsEmpty());
  const auto job = run_job(world, program("G21G90\nG0X1\n"), 1min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
}

TEST(Pendant, FoundInCommandIsWaitedFor) {
  World world{with_pendant()};
  ASSERT_TRUE(world.order("pendant take"));
  world.open();
  world.run_for(20s);
  EXPECT_FALSE(is_ready(world));
  EXPECT_THAT(told<session::LineSent>(world), IsEmpty());
  ASSERT_TRUE(world.order("pendant return"));
  ASSERT_TRUE(world.run_until(is_ready, 60s));
}

TEST(AutomaticReports, SpareTheQuestions) {
  auto options = quick_network(Firmware::GrblHal);
  options.stored.settings["481"] = "200";
  World world{options};
  ASSERT_TRUE(connect(world));
  const auto before = sent_bytes(world, '?');
  const auto reports = world.session().snapshot().reports;
  world.run_for(20s);
  EXPECT_LE(sent_bytes(world, '?') - before, 2U);
  EXPECT_NEAR(static_cast<double>(world.session().snapshot().reports - reports), 100, 10);
  EXPECT_TRUE(world.session().link_health(world.now()).automatic);
  const auto job = run_job(world, program(zigzag(3)), 5min);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->phase, JobPhase::Finished) << job->reason;
  // Somebody switches them off: Kerf asks again.
  world.inject_to_controller("\x8c");
  const auto later = world.session().snapshot().reports;
  world.run_for(10s);
  EXPECT_GT(world.session().snapshot().reports, later + 5);
  EXPECT_THAT(told<session::LinkSilent>(world), IsEmpty());
}

TEST_P(LiveState, ASilentLinkIsMeasuredAndItsEndIsNoticed) {
  World world{quick_network(GetParam())};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.order("link silent"));
  world.run_for(5s);
  EXPECT_THAT(told<session::LinkSilent>(world), SizeIs(1));
  const auto health = world.session().link_health(world.now());
  ASSERT_TRUE(health.silent_for_s);
  EXPECT_NEAR(*health.silent_for_s, 5, 0.3);
  world.submit(session::SendLine{"G0X10"});
  ASSERT_THAT(told<session::CommandRefused>(world), SizeIs(1));
  EXPECT_EQ(told<session::CommandRefused>(world)[0].reason, Refused::NotAnswering);
  ASSERT_TRUE(world.order("link restore"));
  world.run_for(5s);
  EXPECT_THAT(told<session::LinkAnswering>(world), SizeIs(1));
  EXPECT_FALSE(world.session().link_health(world.now()).silent_for_s);
  world.run_for(10s);
  EXPECT_NEAR(position_mm(world, 0), 0, 0.001) << "nothing was sent later on";
}

TEST_P(LiveState, ModesAndOffsetsAreKnownAfterWhatTheOperatorTyped) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.submit(session::SendLine{"G21G91G55"});
  world.submit(session::SendLine{"G10L2P2X12.5"});
  world.submit(session::SendLine{"G0X1"});
  world.run_for(5s);
  const auto& known = world.session().snapshot();
  EXPECT_EQ(known.modes.distance, "G91");
  EXPECT_EQ(known.work_coordinate_system, "G55");
  EXPECT_NEAR(known.offsets_mm.at("G55").at(0), 12.5, 0.001);
  EXPECT_NEAR(known.work_position_mm->at(0), -11.5, 0.01);
  EXPECT_FALSE(known.parser_state_is_old);
  EXPECT_FALSE(known.offsets_are_old);
}

TEST_P(LiveState, NothingIsAskedByLineWhileAJobRuns) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(20), 3s));
  const auto questions = lines_sent(world, streaming::Purpose::Question);
  ASSERT_TRUE(world.run_until(is_over, 10min));
  EXPECT_EQ(lines_sent(world, streaming::Purpose::Question), questions);
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  world.run_for(3s);
  EXPECT_FALSE(world.session().snapshot().parser_state_is_old);
}

TEST_P(LiveState, ASoftLimitIsExplainedWithLineAxisAndReason) {
  auto options = quick_serial(GetParam());
  for (const auto* const setting : {"20", "22"}) options.stored.settings[setting] = "1";
  options.stored.settings["132"] = "60.000";
  options.stored.settings["23"] = "0";
  World world{options};
  ASSERT_TRUE(connect(world));
  ASSERT_TRUE(world.order("switch X 5"));
  ASSERT_TRUE(world.order("switch Y 5"));
  ASSERT_TRUE(world.order("switch Z 5"));
  world.submit(session::Home{});
  ASSERT_TRUE(world.run_until(
      [](const simulation::World& w) { return w.session().snapshot().homing.all.value_or(false); }, 3min));
  world.run_for(2s);
  world.submit(session::SendLine{"G43.1Z-12.1"});
  world.run_for(2s);
  world.submit(session::StartJob{program("G21G90\nG1Z-1F1000\nX-10\nG1Z-50.3\nG1Z0\n")});
  ASSERT_TRUE(world.run_until(is_over, 5min));
  EXPECT_EQ(world.session().job()->alarm_code, 2) << world.session().job()->reason;
  const auto alarms = told<session::AlarmRaised>(world);
  ASSERT_THAT(alarms, SizeIs(1));
  const auto& told_why = alarms[0].explanation;
  EXPECT_EQ(told_why.headline,
            "Alarm 2 at line 4: Z-62.4 is 2.4 mm below the travel because the tool length offset is -12.1.");
  EXPECT_THAT(told_why.evidence, Contains("It was line 4, 'G1Z-50.3'."));
  EXPECT_THAT(told_why.next_steps, Not(IsEmpty()));
}

TEST_P(LiveState, AHardLimitNamesTheSwitch) {
  auto options = quick_serial(GetParam());
  options.stored.settings["21"] = "1";
  World world{options};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  ASSERT_TRUE(world.order("limit X on"));
  ASSERT_TRUE(world.run_until(is_over, 10s));
  world.run_for(2s);
  ASSERT_TRUE(world.session().alarm_explanation());
  const auto why = *world.session().alarm_explanation();
  EXPECT_EQ(why.code, 1);
  EXPECT_EQ(why.position, machine::PositionTrust::Unknown);
  // Grbl reports no inputs until the reset.
  if (vocabulary::dialect_of(GetParam()).critical_alarm_answers_lines) {
    EXPECT_THAT(why.headline, HasSubstr("limit switch of X is pressed"));
  }
  EXPECT_THAT(told<session::LinkSilent>(world), IsEmpty());
}

}  // namespace
}  // namespace kerf::scenarios
