// What the journal holds after a job, and after Kerf was killed in the middle of one.

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::JobOutcome;
using testing::SizeIs;

class Journal : public testing::TestWithParam<vocabulary::Firmware> {};

INSTANTIATE_TEST_SUITE_P(Firmwares, Journal, testing::ValuesIn(kFirmwares),
                         [](const auto& tested) { return word_for(tested.param); });

/// Bytes that were on their way when Kerf was killed, and what is in the buffers, are executed all the same.
TEST_P(Journal, HoldsHowFarAKilledJobWas) {
  for (const Duration after : {1200ms, 2377ms, 3141ms}) {
    World world(quick_serial(GetParam()));
    ASSERT_TRUE(start(world, zigzag(40), after));
    const auto sent = told<session::LineSent>(world);
    const auto last_sent = std::ranges::max(sent, {}, &session::LineSent::file_line).file_line;
    world.kill_sender();
    const auto jobs = world.journal().jobs();
    ASSERT_THAT(jobs, SizeIs(1));
    EXPECT_EQ(jobs[0].outcome(), JobOutcome::CutOff);
    EXPECT_EQ(jobs[0].begun.lines, program(zigzag(40))->line_count());
    EXPECT_TRUE(jobs[0].begun.machine.offsets_are_current);
    EXPECT_TRUE(jobs[0].begun.machine.modes_are_current);
    EXPECT_FALSE(jobs[0].begun.machine.settings.empty());
    ASSERT_NE(jobs[0].latest(), nullptr);
    EXPECT_GT(jobs[0].latest()->line_acknowledged, 3U);
    EXPECT_LE(jobs[0].latest()->line_acknowledged, jobs[0].latest()->line_sent);
    EXPECT_LE(jobs[0].latest()->line_sent, last_sent);
    EXPECT_LE(world.now() - jobs[0].last_at, 50ms + 40ms + 100ms);
    // A new Kerf waits for the machine to come to rest and may then go on.
    world.run_for(20s);
    ASSERT_TRUE(connect(world));
    world.submit(session::StartJob{program("G0X0\n")});
    ASSERT_TRUE(world.run_until(is_over, 60s));
    ASSERT_THAT(world.journal().jobs(), SizeIs(2));
    EXPECT_EQ(world.journal().jobs()[1].outcome(), JobOutcome::Complete);
  }
}

TEST_P(Journal, HoldsAWholeJob) {
  World world(quick_network(GetParam()));
  ASSERT_TRUE(connect(world));
  world.submit(session::SendLine{"G10L20P1X5"});
  ASSERT_TRUE(run_job(world, program(zigzag(6)), 120s));
  const auto jobs = world.journal().jobs();
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_EQ(jobs[0].outcome(), JobOutcome::Complete);
  EXPECT_EQ(jobs[0].begun.machine.offsets_mm.at("G54")[0], -5);
  EXPECT_EQ(jobs[0].closed->state.phase, job::JobPhase::Finished);
  EXPECT_EQ(jobs[0].latest()->line_acknowledged, jobs[0].latest()->line_sent);
  // Positions are in it, as they were reported.
  EXPECT_TRUE(std::ranges::any_of(jobs[0].advances, [](const job::JobAdvanced& advanced) {
    return advanced.machine_position_mm && (*advanced.machine_position_mm)[0] > 1;
  }));
}

TEST_P(Journal, TellsThatTheLinkWasCut) {
  World world(quick_network(GetParam()));
  ASSERT_TRUE(start(world, zigzag(40), 2s));
  world.cut_link();
  const auto jobs = world.journal().jobs();
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_EQ(jobs[0].outcome(), JobOutcome::Unfinished);
  EXPECT_EQ(jobs[0].notes.front().note.kind, job::NoteKind::LinkLost);
}

}  // namespace
}  // namespace kerf::scenarios
