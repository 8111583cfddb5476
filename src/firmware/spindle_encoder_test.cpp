// A grblHAL whose spindle tells its speed.

#include "firmware/spindle_encoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/bench_for_tests.hpp"

namespace kerf::firmware {
namespace {

using testing::Bench;
using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using vocabulary::Firmware;

TEST(SpindleEncoder, TurnsWithTheTimeAndTellsWhenItsIndexComes) {
  SpindleEncoder encoder;
  const Instant start{};
  EXPECT_EQ(encoder.until_index(start, 1), std::nullopt);
  encoder.turn(start, 600);
  EXPECT_DOUBLE_EQ(encoder.turns_at(start + 250ms), 2.5);
  EXPECT_EQ(encoder.until_index(start + 250ms, 2), 150ms);
  encoder.turn(start + 250ms, 60);
  EXPECT_DOUBLE_EQ(encoder.turns_at(start + 750ms), 3.0);
}

class WithEncoder : public ::testing::Test {
 protected:
  static std::string status(Bench& bench) { return bench.send("?").back(); }
  /// Sends lines that are all answered at once.
  static void prepare(Bench& bench, std::initializer_list<std::string_view> lines) {
    for (const std::string_view line : lines) EXPECT_THAT(bench.say(line), Contains("ok")) << line;
  }

  const Personality built = built_with(personality_of(Firmware::GrblHal), {.spindle_encoder = true});
  Bench bench{built};
};

TEST_F(WithEncoder, IsToldAndHasSettings) {
  EXPECT_THAT(bench.say("$I+"), Contains(HasSubstr(",SS,SED")));
  EXPECT_THAT(bench.say("$340"), Contains("$340=0.0"));
  EXPECT_THAT(bench.say("$SPINDLESH"), Contains(HasSubstr("|*SDRVE|")));
  prepare(bench, {"M3S600"});
  EXPECT_THAT(status(bench), HasSubstr("|FS:0,600,600"));
  bench.happens(SpindleLoaded{.share = 0.5});
  EXPECT_THAT(status(bench), HasSubstr("|FS:0,600,300"));
  bench.happens(EncoderPlugged{.plugged = false});
  EXPECT_THAT(status(bench), HasSubstr("|FS:0,600,0"));
}

TEST_F(WithEncoder, WithoutPulsesThereIsNone) {
  prepare(bench, {"$38=0"});
  EXPECT_THAT(bench.say("G95"), ElementsAre("error:20"));
  EXPECT_THAT(bench.say("$I+"), Not(Contains(HasSubstr(",SS,"))));
}

TEST(WithoutEncoder, TheReferenceBuildKnowsNoneOfIt) {
  for (const auto* const line : {"G95", "G33Z-1K1"}) {
    EXPECT_THAT(Bench(Firmware::GrblHal).say(line), ElementsAre("error:20")) << line;
  }
  Bench bench(Firmware::GrblHal);
  EXPECT_THAT(bench.say("$340"), Not(Contains(HasSubstr("$340="))));
}

TEST_F(WithEncoder, FeedPerTurnFollowsTheSpindle) {
  prepare(bench, {"$110=6000", "$120=1000", "M3S600", "G95F0.5", "G91G1X5"});
  // 300 mm/min.
  bench.wait(500ms);
  EXPECT_THAT(status(bench), HasSubstr("|FS:300,600,600"));
  bench.happens(SpindleLoaded{.share = 0.5});
  bench.wait(200ms);
  EXPECT_THAT(status(bench), HasSubstr("|FS:150,600,300"));
  bench.wait(10s);
  EXPECT_THAT(status(bench), HasSubstr("<Idle|MPos:5.000,"));
}

TEST_F(WithEncoder, FeedPerTurnWithASpindleThatStandsIsAnAlarm) {
  prepare(bench, {"G95F0.5"});
  EXPECT_THAT(bench.say("G91G1X5"), ElementsAre("ok", "ALARM:14"));
  bench.wait(1s);
  EXPECT_EQ(bench.state(), "Alarm");
}

TEST_F(WithEncoder, AThreadBeginsAtTheIndexAndTakesATurnEachPitch) {
  prepare(bench, {"$112=6000", "$122=1000", "M3S600"});
  bench.wait(30ms);
  EXPECT_THAT(bench.say("G91G33Z-10K1"), IsEmpty());
  // Second index: 200 ms after the spindle began to turn; nothing is said before.
  EXPECT_THAT(bench.send("?"), IsEmpty());
  EXPECT_THAT(bench.wait(169ms), Not(Contains(HasSubstr("MPos:0.000,0.000,-"))));
  // Ten turns take a second, and some more to speed up and to slow down.
  EXPECT_THAT(bench.wait(1s), Not(Contains("ok")));
  EXPECT_THAT(bench.wait(40ms), Contains("ok"));
  EXPECT_THAT(status(bench), HasSubstr("<Idle|MPos:0.000,0.000,-10.000|"));
}

TEST_F(WithEncoder, AThreadIsNotHeldBeforeItsEnd) {
  prepare(bench, {"$112=6000", "$122=1000", "M3S600"});
  bench.say("G91G33Z-10K1");
  bench.wait(500ms);
  bench.send("!");
  bench.wait(100ms);
  EXPECT_EQ(bench.state(), "Run");
  bench.wait(1s);
  EXPECT_THAT(status(bench), HasSubstr("<Hold:0|MPos:0.000,0.000,-10.000|"));
}

TEST_F(WithEncoder, AThreadWantsASpindleThatTurnsAndAxesThatFollow) {
  const auto answer = [&](std::string_view line) {
    Bench one{built};
    prepare(one, {"$112=500", "M3S600"});
    return one.say(line);
  };
  EXPECT_THAT(bench.say("G91G33Z-10K1"), ElementsAre("error:41"));
  EXPECT_THAT(answer("G91G33Z-10K1"), ElementsAre("error:43"));
  EXPECT_THAT(answer("G91G33Z-10"), ElementsAre("error:39"));
  EXPECT_THAT(answer("G33.1Z-10K1"), ElementsAre("error:20"));
}

TEST_F(WithEncoder, NoIndexInFiveSecondsIsAnAlarm) {
  prepare(bench, {"$112=6000", "M3S3"});
  bench.say("G91G33Z-1K1");
  EXPECT_THAT(bench.wait(4900ms), IsEmpty());
  EXPECT_THAT(bench.wait(200ms), Contains("ALARM:14"));
}

TEST_F(WithEncoder, ASpindleThatIsTooSlowIsAnAlarm) {
  prepare(bench, {"$340=10", "$394=2"});
  EXPECT_THAT(bench.say("M3S600"), IsEmpty());
  EXPECT_THAT(bench.wait(200ms), ElementsAre("ok"));
  prepare(bench, {"G4P0"});
  bench.happens(SpindleLoaded{.share = 0.8});
  bench.say("M4S500");
  EXPECT_THAT(bench.wait(2100ms), IsEmpty());
  EXPECT_THAT(bench.wait(200ms), Contains("ALARM:14"));
  EXPECT_THAT(status(bench), HasSubstr("|FS:0,0,0"));
}

TEST_F(WithEncoder, AThreadingCycleIsChecked) {
  const auto answer = [&](std::string_view line) {
    Bench one{built};
    prepare(one, {"$32=2", "$112=6000", "M3S600"});
    return one.say(line);
  };
  EXPECT_THAT(answer("G17G76P1Z-5I-1J0.2K0.6"), ElementsAre("error:42"));
  EXPECT_THAT(answer("G18G76P1Z-5I-1J0.2K0.1"), ElementsAre("error:39"));
  EXPECT_THAT(answer("G18G76P1I-1J0.2K0.6"), ElementsAre("error:28"));
}

TEST_F(WithEncoder, AThreadingCycleCutsPassAfterPass) {
  prepare(bench, {"$32=2", "$110=6000", "$112=6000", "$120=1000", "$122=1000", "G18G8", "M3S600"});
  EXPECT_THAT(bench.say("G76P1Z-5I-1J0.2K0.6"), IsEmpty());
  std::vector<std::string> heard;
  int cuts = 0;
  bool below = false;
  for (int tick = 0; tick < 4000 && heard.empty(); ++tick) {
    heard = bench.wait(5ms);
    const bool now_below = bench.controller.position_mm()[2] < -4.9;
    cuts += now_below && !below ? 1 : 0;
    below = now_below;
  }
  EXPECT_THAT(heard, ElementsAre("ok"));
  EXPECT_EQ(cuts, 3);
  EXPECT_THAT(status(bench), HasSubstr("<Idle|MPos:0.000,0.000,-5.000|"));
}

}  // namespace
}  // namespace kerf::firmware
