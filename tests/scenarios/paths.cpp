// A machine that leaves the path of its program is held, and the journal tells of it.

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>

#include "scenario.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::HoldCause;
using job::JobPhase;
using testing::IsEmpty;
using testing::SizeIs;

class Paths : public testing::TestWithParam<vocabulary::Firmware> {};

INSTANTIATE_TEST_SUITE_P(Firmwares, Paths, testing::ValuesIn(kFirmwares),
                         [](const auto& tested) { return word_for(tested.param); });

bool is_held(const simulation::World& world) {
  return world.session().job() && world.session().job()->phase == JobPhase::Held;
}

bool begin(World& world, std::string text) {
  if (!connect(world)) return false;
  world.run_for(1s);
  world.submit(
      session::StartJob{.program = program(std::move(text)), .options = {.flow = streaming::FlowPolicy::OneAtATime}});
  return true;
}

/// Of `line`, which has the same byte at its seventh and eighth place: one of them is lost.
bool lose_a_byte(World& world, std::string_view line) {
  const auto has_left = [line](const simulation::World& at) {
    return std::ranges::any_of(told<session::LineSent>(at), [line](const auto& sent) { return sent.text == line; });
  };
  if (!world.run_until(has_left, 1min)) return false;
  world.run_for(std::chrono::microseconds{565});
  return world.order("drop to next 1");
}

std::vector<job::TimedNote> notes_of(const World& world, job::NoteKind kind) {
  std::vector<job::TimedNote> notes;
  for (const auto& job : world.journal().jobs()) {
    std::ranges::copy_if(job.notes, std::back_inserter(notes), [kind](const auto& at) { return at.note.kind == kind; });
  }
  return notes;
}

TEST_P(Paths, ALostByteIsFoundAndJournaled) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(begin(world, "G21G90\nG1X5F600\nG1X20Y11\nG1X0Y0\nM30\n"));
  ASSERT_TRUE(lose_a_byte(world, "G1X20Y11"));
  ASSERT_TRUE(world.run_until(is_held, 10s));
  const auto job = *world.session().job();
  EXPECT_EQ(job.hold_cause, HoldCause::OffPath);
  ASSERT_TRUE(job.departure);
  EXPECT_EQ(job.departure->file_line, 3U);
  EXPECT_LT(position_mm(world, 0), 7);
  const auto notes = notes_of(world, job::NoteKind::OffThePath);
  ASSERT_THAT(notes, SizeIs(1));
  EXPECT_EQ(notes[0].note.line, 3U);
  EXPECT_EQ(notes[0].note.text, describe(*job.departure));
}

TEST_P(Paths, BehindAToolChangeTheyAreWatchedAgain) {
  World world{quick_serial(GetParam())};
  ASSERT_TRUE(begin(world, "G21G90\nG1X10Z5F3000\nT2 M6\nG3X30I10F600\nG1X50Y11\nG1X0Y0\nM30\n"));
  ASSERT_TRUE(world.run_until(is_held, 10s));
  world.run_for(3s);
  world.submit(session::ResumeJob{});
  ASSERT_TRUE(lose_a_byte(world, "G1X50Y11"));
  ASSERT_TRUE(world.run_until(is_held, 20s));
  EXPECT_THAT(told<session::PathUnwatched>(world), IsEmpty());
  ASSERT_TRUE(world.session().job()->departure);
  EXPECT_EQ(world.session().job()->departure->file_line, 5U);
  EXPECT_NEAR(position_mm(world, 2), 5, 0.005);
}

}  // namespace
}  // namespace kerf::scenarios
