#include "firmware/virtual_controller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "firmware/bench_for_tests.hpp"

namespace kerf::firmware {
namespace {

using testing::Bench;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using vocabulary::Axis;
using vocabulary::Firmware;

const auto kWelcomeHal = "GrblHAL 1.1f ['$' or '$HELP' for help]";
const auto kUnlock = "[MSG:'$H'|'$X' to unlock]";

TEST(VirtualController, BlankMemoryIsToldBeforeTheWelcome) {
  EXPECT_THAT(Bench(Firmware::GrblHal, {}).heard_at_start, ElementsAre("error:7", kWelcomeHal));
  EXPECT_THAT(Bench(Firmware::GrblHal).heard_at_start, ElementsAre(kWelcomeHal));
  EXPECT_EQ(Bench(Firmware::Grbl, {}).heard_at_start.front(), "error:7");
  EXPECT_THAT(Bench(Firmware::Rabbit, {}).heard_at_start, ElementsAre(StartsWith("Rabbit GRBL v1.6.0")));
}

TEST(VirtualController, IdleNeedsNoAttention) {
  for (const Personality* personality : all_personalities()) {
    Bench bench(personality->firmware);
    bench.run_out();
    EXPECT_EQ(bench.controller.next_deadline(), kNever);
    bench.say("G1X1F500");
    EXPECT_NE(bench.controller.next_deadline(), kNever);
    bench.run_out();
    EXPECT_EQ(bench.state(), "Idle");
  }
}

TEST(VirtualController, CutsOfTheByteStreamDoNotMatter) {
  rc::check("same bytes, same answers", [] {
    const std::string job = "G21G91\nG1X2F300\nG2X1Y1I1\n$G\nM3S100\nG4P0.1\n?G1X-1\nM5\n!?~$#\nG0X99Z-1\n";
    const auto talk = [&](const std::vector<std::size_t>& cuts) {
      Bench bench(Firmware::GrblHal);
      std::string heard;
      std::size_t at = 0;
      for (const std::size_t cut : cuts) {
        const std::size_t length = std::min(cut, job.size() - at);
        bench.controller.on_bytes(bench.now, std::string_view{job}.substr(at, length));
        at += length;
      }
      bench.controller.on_bytes(bench.now, std::string_view{job}.substr(at));
      for (int turn = 0; turn < 100; ++turn) {
        bench.now += 200ms;
        bench.controller.advance_to(bench.now);
        heard += bench.controller.take_outbox();
      }
      return heard;
    };
    const auto cuts = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(0, 20));
    RC_ASSERT(talk(cuts) == talk({}));
  });
}

TEST(VirtualController, ResetInMotionRaisesTheAlarmBeforeTheWelcome) {
  Bench bench(Firmware::GrblHal);
  bench.say("G91G1X50F500");
  bench.wait(1s);
  EXPECT_THAT(bench.send("\x18"), ElementsAre("ALARM:3"));
  EXPECT_THAT(bench.wait(99ms), IsEmpty());
  EXPECT_THAT(bench.wait(1ms), ElementsAre(kWelcomeHal, kUnlock));
  EXPECT_EQ(bench.state(), "Alarm");
  EXPECT_THAT(bench.say("$X"), ElementsAre("[MSG:Caution: Unlocked]", "ok"));
}

TEST(VirtualController, GrblAnswersTheLineThatAResetInterrupts) {
  Bench bench(Firmware::Grbl);
  EXPECT_THAT(bench.say("G4P5"), IsEmpty());
  EXPECT_THAT(bench.send("\x18"), ElementsAre("ok", "Grbl 1.1h ['$' for help]"));
  Bench hal(Firmware::GrblHal);
  hal.say("G4P5");
  EXPECT_THAT(hal.send("\x18"), ElementsAre(kWelcomeHal));
}

TEST(VirtualController, FullPlannerHoldsBackTheAnswer) {
  Bench bench(Firmware::Grbl);
  std::string lines = "G91F100\n";
  for (int line = 0; line < 20; ++line) lines += "X1\n";
  EXPECT_LT(bench.send(lines).size(), 21U);
  bench.run_out();
  EXPECT_THAT(bench.send("?").back(), HasSubstr("MPos:20.000"));
}

TEST(VirtualController, ReceiveBufferDropsWhatDoesNotFit) {
  Bench bench(Firmware::Grbl);
  bench.say("G4P5");
  EXPECT_EQ(bench.controller.receive_room(), 128U);
  bench.send(std::string(200, '\n'));
  EXPECT_EQ(bench.controller.receive_room(), 0U);
  EXPECT_EQ(bench.wait(6s).size(), 129U);
}

TEST(VirtualController, HoldStopsReadingUntilCycleStart) {
  for (const Personality* personality : all_personalities()) {
    Bench bench(personality->firmware);
    bench.say("G91G1X20F500");
    bench.wait(1s);
    bench.send("!");
    EXPECT_EQ(bench.state(), "Hold:1");
    bench.wait(3s);
    EXPECT_EQ(bench.state(), "Hold:0");
    EXPECT_THAT(bench.say("G1X1"), IsEmpty());
    EXPECT_EQ(bench.send("~").back(), "ok");
    EXPECT_EQ(bench.state(), "Run");
  }
}

TEST(VirtualController, HomingFindsTheSwitchesAtTheEndOfTravel) {
  for (const Personality* personality : all_personalities()) {
    Bench bench(personality->firmware);
    bench.say("$22=1");
    bench.say("$H");
    bench.run_out();
    EXPECT_EQ(bench.hear().back(), "ok") << personality->dialect().name;
    // Rabbit homes X and Y towards minus by default ($23=3).
    const bool is_rabbit = personality->firmware == Firmware::Rabbit;
    EXPECT_THAT(bench.send("?").back(), HasSubstr(is_rabbit ? "MPos:2.000,2.000,-2.000" : "MPos:-1.000,-1.000,-1.000"));
  }
}

TEST(VirtualController, HomingWithoutSwitchFails) {
  Bench bench(Firmware::GrblHal);
  bench.happens(HomingSwitchMoved{.axis = Axis::Z, .distance_mm = std::nullopt});
  bench.say("$22=1");
  bench.say("$H");
  bench.run_out();
  EXPECT_THAT(bench.hear(), ElementsAre("ALARM:9", kWelcomeHal, kUnlock));
}

TEST(VirtualController, SoftLimitIsCritical) {
  Bench bench(Firmware::GrblHal);
  bench.say("$22=1");
  bench.say("$20=1");
  bench.say("$H");
  bench.run_out();
  bench.hear();
  EXPECT_THAT(bench.say("G0X-900"), ElementsAre("ALARM:2"));
  EXPECT_THAT(bench.wait(100ms), ElementsAre("[MSG:Reset to continue]"));
  EXPECT_THAT(bench.say("G0X0"), ElementsAre("error:9"));
  EXPECT_THAT(bench.say("$X"), ElementsAre("error:79"));
  EXPECT_THAT(bench.send("\x18"), ElementsAre(kWelcomeHal, kUnlock));
}

TEST(VirtualController, HardLimitStopsDead) {
  Bench bench(Firmware::Grbl);
  bench.say("$21=1");
  bench.say("G91G1X50F500");
  bench.wait(1s);
  bench.happens(LimitHeld{.axis = Axis::X, .active = true});
  EXPECT_THAT(bench.hear(), ElementsAre("ALARM:1"));
  EXPECT_THAT(bench.wait(500ms), ElementsAre("[MSG:Reset to continue]"));
  EXPECT_THAT(bench.say("$X"), IsEmpty());
  EXPECT_THAT(bench.send("?"), IsEmpty());
}

TEST(VirtualController, ProbeTouchesTheSurface) {
  Bench bench(Firmware::Grbl);
  bench.happens(ProbeSurfaceMoved{.z_mm = -3.0});
  bench.say("G38.2Z-10F100");
  bench.run_out();
  EXPECT_THAT(bench.hear(), ElementsAre("[PRB:0.000,0.000,-3.000:1]", "ok"));
  EXPECT_THAT(bench.say("G38.2Z-20F100"), ElementsAre("ALARM:4"));
}

TEST(VirtualController, JogCancelEndsTheJog) {
  for (const Personality* personality : all_personalities()) {
    Bench bench(personality->firmware);
    EXPECT_THAT(bench.say("$J=G91X100F500"), ElementsAre("ok"));
    EXPECT_EQ(bench.state(), "Jog");
    bench.wait(1s);
    bench.send("\x85");
    bench.wait(2s);
    EXPECT_EQ(bench.state(), "Idle") << personality->dialect().name;
  }
}

TEST(VirtualController, SameOverrideByteAtOneInstantCountsOnceOnGrbl) {
  Bench grbl(Firmware::Grbl);
  grbl.send("?");
  grbl.send("\x91\x91\x91");
  EXPECT_THAT(grbl.send("?").back(), HasSubstr("Ov:110,100,100"));
  Bench hal(Firmware::GrblHal);
  hal.send("\x91\x91\x91");
  EXPECT_THAT(hal.send("?").back(), HasSubstr("Ov:130,100,100"));
}

TEST(VirtualController, ToolChangeWaitsForCycleStart) {
  Bench bench(Firmware::GrblHal);
  EXPECT_THAT(bench.send("T1M6\nG0X1\n"), ElementsAre("ok"));
  EXPECT_EQ(bench.state(), "Tool");
  bench.send("\xA3");
  EXPECT_THAT(bench.say("G0X2"), ElementsAre("error:40"));
  bench.say("$G");
  EXPECT_THAT(bench.send("~"), ElementsAre(HasSubstr("T:0"), "ok"));
  EXPECT_EQ(bench.state(), "Run");
}

TEST(VirtualController, ReportsByItself) {
  StoredState stored = Bench::factory();
  stored.settings = {{"481", "200"}};
  Bench bench(Firmware::GrblHal, stored);
  EXPECT_THAT(bench.wait(199ms), IsEmpty());
  EXPECT_EQ(bench.wait(1ms).size(), 1U);
  EXPECT_EQ(bench.wait(1s).size(), 5U);
  EXPECT_THAT(bench.send("\x80\x05"), IsEmpty());
  EXPECT_EQ(bench.send("?").size(), 1U);
  EXPECT_THAT(bench.send("\x87").back(), HasSubstr("|AR:200|"));
  bench.send("\x8C");
  EXPECT_THAT(bench.wait(1s), IsEmpty());
  EXPECT_THAT(bench.send("\x87").back(), HasSubstr("|AR|"));
  // A reset switches them on again, and the clock goes on as if nothing had been.
  bench.wait(100ms);
  bench.send("\x18");
  EXPECT_EQ(bench.wait(100ms).size(), 1U);
  bench.say("$481=500");
  bench.wait(200ms);
  EXPECT_EQ(bench.wait(1s).size(), 2U);
  bench.say("$481=0");
  bench.wait(1s);
  EXPECT_EQ(bench.controller.next_deadline(), kNever);
}

TEST(VirtualController, RemembersSettingsOffsetsAndLines) {
  StoredState stored;
  {
    Bench bench(Firmware::GrblHal);
    for (const auto* line : {"$110=700", "$N0=G55", "$I=mill", "G10L2P2X5"}) bench.say(line);
    stored = bench.controller.stored();
    EXPECT_GE(bench.controller.stored_revision(), 4U);
  }
  Bench bench(Firmware::GrblHal, *parse_stored_state(print(stored)));
  EXPECT_THAT(bench.heard_at_start, ElementsAre(kWelcomeHal, ">G55:ok"));
  EXPECT_THAT(bench.say("$110"), ElementsAre("$110=700.000", "ok"));
  EXPECT_THAT(bench.say("$#")[1], HasSubstr("[G55:5.000,0.000,0.000]"));
}

TEST(VirtualController, NamesStoredSettingsThatItRefuses) {
  StoredState stored = Bench::factory();
  stored.settings = {{"110", "fast"}, {"20", "1"}, {"22", "1"}, {"9999", "1"}};
  const VirtualController controller(personality_of(Firmware::GrblHal), stored);
  EXPECT_THAT(controller.rejected_settings(), ElementsAre("110", "9999"));
}

}  // namespace
}  // namespace kerf::firmware
