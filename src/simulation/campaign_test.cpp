// The observers of a campaign must notice what they are there for.

#include "simulation/campaign.hpp"

#include <chrono>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/departure_watch.hpp"
#include "simulation/memory_journal.hpp"
#include "simulation/undisturbed_job.hpp"
#include "simulation/wire_watch.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

session::Outbox lines(std::string text) {
  session::Outbox out;
  out.lines = std::move(text);
  return out;
}

TEST(Campaign, TheSameSeedGivesTheSameRun) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const CampaignCase made_up = campaign_case(seed);
    EXPECT_EQ(describe(made_up), describe(campaign_case(seed)));
    const CampaignVerdict first = judge(made_up, 2, true);
    const CampaignVerdict second = judge(made_up, 2, true);
    EXPECT_EQ(first.transcript, second.transcript);
    EXPECT_FALSE(first.transcript.empty());
    EXPECT_EQ(first.struck, second.struck);
  }
}

TEST(WireWatch, BytesBeyondTheWindowAreTold) {
  WireWatch watch{Duration::zero()};
  watch.on_command(session::SendLine{});
  watch.on_outbox(Instant{}, lines("G1X10\n"), 10);
  EXPECT_THAT(watch.complaints(), IsEmpty());
  watch.on_outbox(Instant{}, lines("G1X20\n"), 10);
  EXPECT_THAT(watch.complaints(), SizeIs(1));
  watch.on_received(Instant{}, "ok\r\nok\r\n");
  watch.on_outbox(Instant{}, lines("(a long line that travels alone)\n"), 10);
  EXPECT_THAT(watch.complaints(), SizeIs(1));
}

TEST(WireWatch, WhatAnAnsweredQuestionProvesToBeReadIsNotInFlight) {
  WireWatch watch{Duration::zero()};
  watch.on_command(session::SendLine{});
  watch.on_outbox(Instant{}, lines("G1X10\n$G\n"), 10);
  watch.on_received(Instant{}, "[GC:G1 G54]\r\nok\r\n");
  watch.on_outbox(Instant{}, lines("G1X201\n"), 10);
  EXPECT_THAT(watch.complaints(), IsEmpty());
  // Nobody asked.
  watch.on_received(Instant{}, "[GC:G1 G54]\r\n");
  watch.on_outbox(Instant{}, lines("G1X20\n"), 10);
  EXPECT_THAT(watch.complaints(), SizeIs(1));
}

// A line that lost its end is one with the next, and both have one answer.
TEST(WireWatch, EveryQuestionOfKerfProvesIt) {
  const std::pair<std::string, std::string> questions[] = {
      {"$G", "[GC:G1 G54]"}, {"$#", "[G54:0.000,0.000,0.000]"}, {"$I", "[VER:1.1h.20190830:]"}, {"$$", "$0=10"},
      {"$N", "$N0=G54"},
  };
  for (const auto& [question, answer] : questions) {
    WireWatch watch{Duration::zero()};
    watch.on_command(session::SendLine{});
    watch.on_outbox(Instant{}, lines("$N1\n" + question + "\n"), 10);
    watch.on_received(Instant{}, answer + "\r\nok\r\n");
    watch.on_outbox(Instant{}, lines("G1X1\n"), 10);
    watch.on_outbox(Instant{}, lines("G1X2\n"), 10);
    EXPECT_THAT(watch.complaints(), IsEmpty()) << question;
    watch.on_outbox(Instant{}, lines("M5\n"), 10);
    EXPECT_THAT(watch.complaints(), SizeIs(1)) << question;
  }
}

TEST(WireWatch, MotionWithoutACommandIsTold) {
  WireWatch watch{Duration::zero()};
  watch.on_outbox(Instant{}, lines("$$\n\n$G\n"), 100);
  EXPECT_THAT(watch.complaints(), IsEmpty());
  watch.on_outbox(Instant{}, lines("$H\n"), 100);
  EXPECT_THAT(watch.complaints(), SizeIs(1));
  watch.on_command(session::Home{});
  watch.on_outbox(Instant{}, lines("$H\n"), 100);
  EXPECT_THAT(watch.complaints(), SizeIs(1));
  watch.on_received(Instant{}, "\r\nGrbl 1.1h ['$' for help]\r\n");
  watch.on_outbox(Instant{}, lines("G1X1\n"), 100);
  EXPECT_THAT(watch.complaints(), SizeIs(2));
}

TEST(WireWatch, AnAnswerTooManyIsTold) {
  WireWatch watch{Duration::zero()};
  session::Outbox out;
  streaming::OwedLine line;
  line.serial = 1;
  out.events.emplace_back(session::LineReceived{.message = {}, .raw = {}, .answers = line});
  watch.on_received(Instant{}, "ok\r\n");
  watch.on_outbox(Instant{}, out, 100);
  EXPECT_THAT(watch.complaints(), IsEmpty());
  watch.on_outbox(Instant{}, out, 100);
  EXPECT_THAT(watch.complaints(), testing::Contains(HasSubstr("again")));
}

TEST(DepartureWatch, AJobThatGoesOnOffItsPathIsTold) {
  World world{network_world(vocabulary::Firmware::GrblHal, 1ms)};
  world.open();
  const auto is_ready = [](const World& w) { return w.session().phase() == session::SessionPhase::Ready; };
  ASSERT_TRUE(world.run_until(is_ready, 60s));
  world.run_for(1s);
  constexpr double kSteps = 250;
  DepartureWatch right{{{}, {.x = 10}}, kSteps, 20ms};
  DepartureWatch wrong{{{}, {.y = 10}}, kSteps, 20ms};
  world.submit(session::StartJob{.program = *job::Program::load("part.nc", "G21G91\nG1X10F600\n")});
  const Instant end = world.now() + 1min;
  while (!(world.session().job() && job::is_final(world.session().job()->phase)) && world.step(end)) {
    right.look(world);
    wrong.look(world);
  }
  EXPECT_FALSE(right.was_off());
  EXPECT_THAT(right.complaints(), IsEmpty());
  EXPECT_TRUE(wrong.was_off_in_job());
  EXPECT_THAT(wrong.complaints(), SizeIs(1));
}

TEST(MemoryJournal, WhatAFullDiskDoesNotTakeIsWrittenLaterUnlessTheSenderIsKilled) {
  MemoryJournal journal;
  const auto job = [](std::uint32_t number) {
    std::vector<job::JournalRecord> records;
    records.push_back({.at = Instant{}, .job = number, .what = job::JobBegun{}});
    return records;
  };
  journal.append(job(1));
  journal.fill_disk(true);
  journal.append(job(2));
  EXPECT_THAT(journal.jobs(), SizeIs(1));
  journal.fill_disk(false);
  EXPECT_THAT(journal.jobs(), SizeIs(2));
  journal.fill_disk(true);
  journal.append(job(3));
  journal.lose_since(Instant{} + std::chrono::seconds{1});
  journal.fill_disk(false);
  EXPECT_THAT(journal.jobs(), SizeIs(2));
}

TEST(CutterWatch, ACutThatIsNotTheJobsIsTold) {
  // The job of a seed without faults, on a workpiece that another job has cut.
  CampaignCase one = campaign_case(1);
  CampaignCase other = campaign_case(2);
  EXPECT_FALSE(compare(undisturbed(one).stock, undisturbed(other).stock).none());
  EXPECT_TRUE(compare(undisturbed(one).stock, undisturbed(one).stock).none());
}

}  // namespace
}  // namespace kerf::simulation
