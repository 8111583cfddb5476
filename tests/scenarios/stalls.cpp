// Answers that do not come: each cause provoked at the wire or at the machine, named, and its safe way on taken.

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::HoldCause;
using job::JobPhase;
using job::StallCause;
using testing::IsEmpty;
using testing::SizeIs;
using vocabulary::Firmware;

// Relative, so that a line cut twice or left out shows in the end. The dwell keeps the answers apart from the rest.
constexpr const char* kProgram = "G21G91\nG1X10F3000\nG4P2\nY10\nX10\nY10\nX5\nG90\n";

class Stalls : public testing::TestWithParam<Firmware> {
 protected:
  static bool is_held(const simulation::World& world) {
    return world.session().job() && world.session().job()->phase == JobPhase::Held;
  }
  static std::string lost_bytes(const simulation::World& world) {
    std::string lost;
    for (const auto& record : world.log()) lost += record.what + "\n";
    return lost;
  }
  /// A job in which `order` at some instant after its start hits exactly `bytes` (as the log writes them).
  std::unique_ptr<World> world_that_lost(const std::string& order, const std::string& bytes, Duration from,
                                         Duration step) const {
    for (int attempt = 0; attempt < 400; ++attempt) {
      auto world = std::make_unique<World>(quick_serial(GetParam()));
      if (!start(*world, kProgram, from + attempt * step) || !world->order(order)) return nullptr;
      world->run_for(4s);
      if (lost_bytes(*world).find(bytes) != std::string::npos) return world;
    }
    return nullptr;
  }
};
INSTANTIATE_TEST_SUITE_P(Firmwares, Stalls, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(Stalls, ALostAnswerIsProvenAndTheJobGoesOnWithoutSendingAnythingTwice) {
  const auto world = world_that_lost("drop from next 4", ": ok\\r\\n", 1s, 5ms);
  ASSERT_TRUE(world);
  ASSERT_TRUE(world->run_until(is_held, 1min)) << world->session().job()->reason;
  const auto job = *world->session().job();
  EXPECT_EQ(job.hold_cause, HoldCause::Stall);
  ASSERT_TRUE(job.stall);
  EXPECT_EQ(job.stall->cause, StallCause::LostAnswer) << job.stall->headline;
  ASSERT_TRUE(job.stall->goes_on_at);
  const auto lines = lines_sent(*world, streaming::Purpose::JobLine);
  world->run_for(1min);
  EXPECT_EQ(lines_sent(*world, streaming::Purpose::JobLine), lines);
  world->submit(session::ResumeJob{});
  ASSERT_TRUE(world->run_until(is_over, 1min));
  EXPECT_EQ(world->session().job()->phase, JobPhase::Finished) << world->session().job()->reason;
  EXPECT_NEAR(position_mm(*world, 0), 25, 0.005);
  EXPECT_NEAR(position_mm(*world, 1), 20, 0.005);
}

TEST_P(Stalls, AControllerThatStartedAgainUnseenIsNotTakenForOneThatLostAnswers) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(40), 1s));
  ASSERT_TRUE(world.order("link silent"));
  world.run_for(1min);
  ASSERT_TRUE(world.order("reset"));
  world.run_for(1s);
  ASSERT_TRUE(world.order("link restore"));
  static_cast<void>(world.run_until(is_held, 1min));
  const auto& job = *world.session().job();
  EXPECT_NE(job.phase, JobPhase::Finished);
  EXPECT_FALSE(job.stall && job.stall->goes_on_at) << job.stall->headline;
}

TEST_P(Stalls, BehindALostAnswerTheJobIsNotOverBeforeItsLastLineIsSent) {
  std::unique_ptr<World> world;
  for (int attempt = 0; attempt < 400 && (!world || !lost_bytes(*world).contains(": ok\\r\\n")); ++attempt) {
    world = std::make_unique<World>(quick_serial(GetParam()));
    ASSERT_TRUE(connect(*world));
    world->submit(
        session::StartJob{.program = program(zigzag(40)), .options = {.flow = streaming::FlowPolicy::OneAtATime}});
    world->run_for(5ms + attempt * 700us);
    ASSERT_TRUE(world->order("drop from next 4"));
    world->run_for(4s);
  }
  ASSERT_TRUE(world->run_until(is_held, 1min)) << lost_bytes(*world);
  ASSERT_EQ(world->session().job()->hold_cause, HoldCause::Stall);
  ASSERT_EQ(lines_sent(*world, streaming::Purpose::JobSync), 0U);
  world->submit(session::ResumeJob{});
  EXPECT_EQ(lines_sent(*world, streaming::Purpose::JobSync), 0U);
  ASSERT_TRUE(world->run_until(is_over, 10min));
  EXPECT_EQ(world->session().job()->phase, JobPhase::Finished) << world->session().job()->reason;
  EXPECT_NEAR(position_mm(*world, 1), 40, 0.005);
  EXPECT_EQ(lines_sent(*world, streaming::Purpose::JobSync), 1U);
}

TEST_P(Stalls, ALostLineEndIsFoundOutWithoutMotion) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(connect(world));
  world.run_for(1s);
  world.submit(session::StartJob{.program = program("G21G91\nG1X10F3000\n"),
                                 .options = {.flow = streaming::FlowPolicy::OneAtATime}});
  // The second line leaves when the first is answered; its last byte is lost.
  ASSERT_TRUE(world.run_until([](const auto& w) { return lines_sent(w, streaming::Purpose::JobLine) == 2; }, 5s));
  world.run_for(std::chrono::microseconds{940});
  ASSERT_TRUE(world.order("drop to next 1"));
  ASSERT_TRUE(world.run_until(is_held, 1min)) << lost_bytes(world);
  const auto job = *world.session().job();
  ASSERT_TRUE(job.stall);
  if (lost_bytes(world).find(": \\n") == std::string::npos)
    GTEST_SKIP() << "another byte was hit: " << lost_bytes(world);
  EXPECT_EQ(job.stall->cause, StallCause::LostLineEnd) << job.stall->headline;
  EXPECT_FALSE(job.stall->goes_on_at);
  EXPECT_NEAR(position_mm(world, 0), 0, 0.005);
  world.submit(session::ResumeJob{});
  EXPECT_THAT(told<session::CommandRefused>(world), SizeIs(1));
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 10s));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Stopped);
  EXPECT_FALSE(world.session().job()->position_suspect);
}

TEST_P(Stalls, ADeadLinkIsNamedAndOverWhenItAnswers) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, zigzag(10), 2s));
  ASSERT_TRUE(world.order("link silent"));
  world.run_for(4s);
  ASSERT_THAT(told<session::JobStalled>(world), SizeIs(1));
  EXPECT_EQ(told<session::JobStalled>(world)[0].stall.cause, StallCause::DeadLink);
  ASSERT_TRUE(world.session().job()->stall);
  EXPECT_EQ(world.session().job()->stall->cause, StallCause::DeadLink);
  const auto jobs = world.journal().jobs();
  ASSERT_THAT(jobs, SizeIs(1));
  const auto noted =
      std::ranges::find(jobs[0].notes, job::NoteKind::Stalled, [](const auto& at) { return at.note.kind; });
  ASSERT_NE(noted, jobs[0].notes.end());
  EXPECT_EQ(noted->note.text, told<session::JobStalled>(world)[0].stall.headline);
}

// Answers go on afterwards, each taken for an older line's, and the machine comes back to the path: the account would
// tell only at the end of the job.
TEST_P(Stalls, LinesThatASilenceSwallowedAreMissedWhenTheLinkAnswersAgain) {
  World world{quick_serial(GetParam())};
  std::string text = "G21G91\nG1F300\n";
  for (int square = 0; square < 100; ++square) text += "X1\nY1\nX-1\nY-1\n";
  ASSERT_TRUE(start(world, text, 3s));
  const auto sent = lines_sent(world, streaming::Purpose::JobLine);
  ASSERT_TRUE(
      world.run_until([sent](const auto& at) { return lines_sent(at, streaming::Purpose::JobLine) > sent; }, 5s));
  ASSERT_TRUE(world.order("link silent"));
  const auto oldest = world.session().ledger().oldest().file_line;
  world.run_for(4s);
  ASSERT_TRUE(world.order("link restore"));
  ASSERT_TRUE(world.run_until(is_held, 30s));
  const auto job = *world.session().job();
  // Where the path shows it first, that is as good.
  ASSERT_TRUE(job.stall || job.departure) << job.reason;
  if (job.stall) {
    EXPECT_EQ(job.stall->cause, StallCause::LostLine) << job.stall->headline;
    EXPECT_FALSE(job.stall->goes_on_at);
  }
  world.run_for(5s);
  world.submit(session::StopJob{});
  ASSERT_TRUE(world.run_until(is_over, 20s));
  EXPECT_LE(world.session().job()->progress.executing.from, oldest);
}

TEST_P(Stalls, ASilenceInWhichNothingGotLostIsForgotten) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X30F300\nX31\nX32\nX33\nX0F3000\n", 2s));
  ASSERT_TRUE(world.order("link silent"));
  world.run_for(3s);
  ASSERT_TRUE(world.order("link restore"));
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished) << world.session().job()->reason;
  EXPECT_THAT(told<session::JobStalled>(world), SizeIs(1));
}

TEST_P(Stalls, WhatTheMachineWaitsForIsNamedWithoutAlarm) {
  auto options = quick_serial(GetParam());
  // Grbl and Rabbit report their buffers only when told to.
  if (GetParam() != Firmware::GrblHal) options.stored.settings["10"] = "3";
  World world{options};
  ASSERT_TRUE(start(
      world,
      "G21G90\n" +
          [] {
            std::string moves;
            for (int move = 0; move < 60; ++move) moves += "G1X" + std::to_string(move % 2 == 0 ? 150 : 0) + "F600\n";
            return moves;
          }(),
      10s));
  ASSERT_TRUE(world.session().job()->stall || GetParam() == Firmware::GrblHal);
  if (GetParam() != Firmware::GrblHal) {
    EXPECT_EQ(world.session().job()->stall->cause, StallCause::PlannerFull);
  }
  ASSERT_TRUE(world.order("door open"));
  world.run_for(10s);
  ASSERT_TRUE(world.session().job()->stall || world.session().ledger().empty());
  if (world.session().job()->stall) {
    EXPECT_EQ(world.session().job()->stall->cause, StallCause::Door);
  }
  EXPECT_THAT(told<session::JobStalled>(world), IsEmpty());
}

TEST_P(Stalls, ADwellIsNoStall) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(start(world, "G21G90\nG1X1F3000\nG4P30\nG1X5\n", 20s));
  ASSERT_TRUE(world.session().job()->stall);
  EXPECT_EQ(world.session().job()->stall->cause, StallCause::Dwell);
  EXPECT_EQ(lines_sent(world, streaming::Purpose::Proof), 0U);
  ASSERT_TRUE(world.run_until(is_over, 1min));
  EXPECT_EQ(world.session().job()->phase, JobPhase::Finished);
  EXPECT_THAT(told<session::JobStalled>(world), IsEmpty());
}

}  // namespace
}  // namespace kerf::scenarios
