// What a controller does on hardware that its reference build lacks.

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

Personality with_ports() {
  return built_with(personality_of(Firmware::GrblHal),
                    {.ports = {.digital_inputs = 2, .digital_outputs = 2, .analog_inputs = 1, .analog_outputs = 1}});
}

TEST(Hardware, CountsAreLimitedToWhatTheFirmwareDrives) {
  EXPECT_EQ(built_with(personality_of(Firmware::GrblHal), {.axes = 9}).hardware.axes, 8);
  EXPECT_EQ(built_with(personality_of(Firmware::Rabbit), {.axes = 8}).hardware.axes, 6);
  EXPECT_EQ(built_with(personality_of(Firmware::GrblHal), {}).hardware.tools, 0);
}

TEST(Hardware, WhatAFirmwareCannotHaveIsNamed) {
  const Personality& grbl = personality_of(Firmware::Grbl);
  const Personality& hal = personality_of(Firmware::GrblHal);
  EXPECT_EQ(fault_in({}, grbl), std::nullopt);
  EXPECT_EQ(fault_in({.axes = 4}, grbl), HardwareFault::Axes);
  EXPECT_EQ(fault_in({.axes = 2}, hal), HardwareFault::Axes);
  EXPECT_EQ(fault_in({.tools = 1}, grbl), HardwareFault::Tools);
  EXPECT_EQ(fault_in({.tools = 33}, hal), HardwareFault::Tools);
  EXPECT_EQ(fault_in({.ports = {.analog_outputs = 1}}, grbl), HardwareFault::Ports);
  EXPECT_EQ(fault_in({.slow_memory = true}, hal), HardwareFault::SlowMemory);
  EXPECT_EQ(fault_in({.axes = 8, .tools = 32}, hal), std::nullopt);
  EXPECT_EQ(personality_names_for({.axes = 5}), "rabbit, grblhal or grblhal-expr");
  EXPECT_EQ(personality_names_for({.tools = 5}), "grblhal or grblhal-expr");
  EXPECT_EQ(personality_names_for({.axes = 9}), "");
}

TEST(Hardware, PortCountsAreFourNumbers) {
  EXPECT_EQ(parse_port_counts("4,3, 2,1"),
            (gcode::PortCounts{.digital_inputs = 4, .digital_outputs = 3, .analog_inputs = 2, .analog_outputs = 1}));
  for (const auto* const wrong : {"", "4", "4,4,4", "4,4,4,-1", "4,4,4,x", "1,2,3,4,5"}) {
    EXPECT_EQ(parse_port_counts(wrong), std::nullopt) << wrong;
  }
}

TEST(Hardware, PortsAreTold) {
  const Personality built = with_ports();
  EXPECT_THAT(Bench(built).say("$I+"), Contains("[AUX IO:2,2,1,1]"));
  EXPECT_THAT(Bench(Firmware::GrblHal).say("$I+"), Not(Contains(HasSubstr("AUX IO"))));
}

TEST(Hardware, AnInputIsWaitedFor) {
  const Personality built = with_ports();
  Bench bench(built);
  EXPECT_THAT(bench.say("M66P1L3Q5"), IsEmpty());
  EXPECT_THAT(bench.wait(1s), IsEmpty());
  bench.happens(PortInputChanged{.digital = true, .port = 1, .value = 1});
  EXPECT_THAT(bench.wait(0s), ElementsAre("ok"));
  EXPECT_THAT(bench.send("?").back(), HasSubstr("|In:1"));
}

TEST(Hardware, WaitingEndsInVain) {
  const Personality built = with_ports();
  Bench bench(built);
  EXPECT_THAT(bench.say("M66P0L1Q2"), IsEmpty());
  EXPECT_THAT(bench.wait(3s), ElementsAre("ok"));
  EXPECT_THAT(bench.send("?").back(), HasSubstr("|In:-1"));
  EXPECT_THAT(bench.send("?").back(), Not(HasSubstr("|In:")));
}

TEST(Hardware, BytesAreLostWhileGrblWritesItsMemory) {
  const Personality built = built_with(personality_of(Firmware::Grbl), {.slow_memory = true});
  Bench bench(built);
  EXPECT_THAT(bench.say("$110=600"), IsEmpty());
  EXPECT_THAT(bench.say("G1X1F100"), IsEmpty());
  EXPECT_THAT(bench.wait(1s), ElementsAre("ok"));
  // The UART kept two bytes of the line, so that the next one begins with them: G10 without axis words.
  EXPECT_THAT(bench.say("0"), ElementsAre("error:26"));
}

TEST(Hardware, SleepsAfterFiveMinutesWithTheSpindleOn) {
  Bench bench(Firmware::GrblHal);
  bench.say("$62=1");
  bench.say("M3S100");
  EXPECT_THAT(bench.wait(299s), IsEmpty());
  EXPECT_EQ(bench.state(), "Idle");  // the question keeps it awake
  EXPECT_THAT(bench.wait(299s), IsEmpty());
  EXPECT_THAT(bench.wait(2s), ElementsAre("[MSG:Sleeping]"));
  EXPECT_EQ(bench.state(), "Sleep");
}

TEST(Hardware, LastEventIsTold) {
  Bench bench(Firmware::GrblHal);
  EXPECT_THAT(bench.say("$LEV"), ElementsAre("[LASTEVENTS:,,,,]", "ok"));
  bench.happens(InputChanged{.input = Input::CycleStart, .active = true});
  EXPECT_THAT(bench.say("$LEV"), Contains("[LASTEVENTS:S,,,,]"));
}

}  // namespace
}  // namespace kerf::firmware
