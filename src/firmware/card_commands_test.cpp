#include "firmware/card_commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/bench_for_tests.hpp"

namespace kerf::firmware {
namespace {

using testing::Bench;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class CardTest : public ::testing::Test {
 protected:
  std::shared_ptr<MemoryCard> card = std::make_shared<MemoryCard>();
  Bench bench{vocabulary::Firmware::GrblHal, Bench::factory(), {.card = card}};
};

TEST_F(CardTest, FilesComeAndGo) {
  card->put("a.nc", "G21\n");
  EXPECT_THAT(bench.say("$F=a.nc"), ElementsAre("error:64"));
  bench.say("$FM");
  EXPECT_THAT(bench.say("$F"), ElementsAre("[FILE:/a.nc|SIZE:4]", "ok"));
  EXPECT_THAT(bench.say("$FD=a.nc"), ElementsAre("ok"));
  EXPECT_THAT(bench.say("$F"), ElementsAre("ok"));
  EXPECT_THAT(bench.say("$FI"), ElementsAre("[FS:FatFs@/ size 7.45 GB, free 7.45 GB]", "ok"));
}

TEST_F(CardTest, RowsThatDoNotFitAreLeftOut) {
  std::string path(30, 'f');
  path.append("/").append(40, 'n').append(".nc");
  card->put(path, "");
  bench.say("$FM");
  EXPECT_THAT(bench.say("$F"), ElementsAre("ok"));
}

TEST_F(CardTest, AFileLongerThanThePlannerEndsWhenItHasMoved) {
  std::string program = "G91\n";
  for (int line = 0; line < 500; ++line) program += "G1X0.1F6000\n";
  card->put("long.nc", program);
  bench.say("$FM");
  EXPECT_THAT(bench.say("$F=long.nc"), ElementsAre("ok"));
  bench.wait(2s);
  EXPECT_THAT(bench.send("?").back(), HasSubstr("|SD:"));
  bench.run_out();
  EXPECT_THAT(bench.hear(), ElementsAre("[MSG:Pgm End]"));
  EXPECT_THAT(bench.send("?").back(), HasSubstr("MPos:50.000"));
  EXPECT_THAT(bench.send("?").back(), Not(HasSubstr("SD:")));
  EXPECT_THAT(bench.say("G4P0"), ElementsAre("ok"));
}

TEST_F(CardTest, WhatWasSentDuringARunIsGone) {
  card->put("part.nc", "G91\nG1X10F500\nM30\n");
  bench.say("$FM");
  bench.say("$F=part.nc");
  bench.wait(1s);
  EXPECT_THAT(bench.say("G0X99"), IsEmpty());
  EXPECT_THAT(bench.send("\x85"), IsEmpty());
  bench.run_out();
  EXPECT_THAT(bench.hear(), ElementsAre("[MSG:Pgm End]", "ok"));
  EXPECT_EQ(bench.controller.receive_room(), 1023U);
}

TEST_F(CardTest, ACriticalAlarmEndsTheRunAndForbidsTheCard) {
  card->put("part.nc", "G91\nG1X50F500\nM30\n");
  bench.say("$21=1");
  bench.say("$FM");
  bench.say("$F=part.nc");
  bench.wait(1s);
  bench.happens(LimitHeld{.axis = vocabulary::Axis::X, .active = true});
  bench.wait(1s);
  EXPECT_THAT(bench.say("$F"), ElementsAre("error:79"));
}

}  // namespace
}  // namespace kerf::firmware
