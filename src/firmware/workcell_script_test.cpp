#include "firmware/workcell_script.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::firmware {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::SizeIs;
using vocabulary::Axis;
using vocabulary::MachineState;

Deed deed_of(std::string_view text) {
  const auto line = parse_script_line(text);
  if (!line || !*line || !(*line)->deed) {
    ADD_FAILURE() << text << (line ? " has no deed" : ": " + explain(line.error()));
    return WriteNote{"wrong"};
  }
  return *(*line)->deed;
}

template <typename T>
T as(std::string_view text) {
  const Deed deed = deed_of(text);
  if (const auto* found = std::get_if<T>(&deed)) return *found;
  ADD_FAILURE() << text << " is something else";
  return {};
}

template <typename T>
T event(std::string_view text) {
  const auto happened = as<WorkcellEvent>(text);
  if (const auto* found = std::get_if<T>(&happened)) return *found;
  ADD_FAILURE() << text << " is another event";
  return {};
}

template <typename T>
T timing(std::string_view text) {
  const auto line = parse_script_line(text);
  const T* found = line && *line ? std::get_if<T>(&(*line)->timing) : nullptr;
  if (found != nullptr) return *found;
  ADD_FAILURE() << text << " has another timing";
  return {};
}

TEST(WorkcellScript, SwitchesAndButtons) {
  EXPECT_TRUE(event<InputChanged>("door open").active);
  EXPECT_EQ(event<InputChanged>("estop release").input, Input::EmergencyStop);
  EXPECT_EQ(event<InputChanged>("probe unplug").input, Input::ProbeDisconnected);
  EXPECT_EQ(as<PressButton>("start").input, Input::CycleStart);
  EXPECT_TRUE(event<InputChanged>("hold press").active);
  EXPECT_EQ(event<LimitHeld>("limit y on").axis, Axis::Y);
  EXPECT_EQ(event<HomingSwitchMoved>("switch Z 80.5").distance_mm, 80.5);
  EXPECT_EQ(event<HomingSwitchMoved>("switch Z none").distance_mm, std::nullopt);
  EXPECT_EQ(event<StepsLost>("lose y -40").axis, Axis::Y);
  EXPECT_EQ(event<StepsLost>("lose X -40").steps, -40);
}

TEST(WorkcellScript, PortsSpindleAndPendant) {
  const auto input = event<PortInputChanged>("input 3 on");
  EXPECT_TRUE(input.digital);
  EXPECT_EQ(input.port, 3);
  EXPECT_EQ(input.value, 1.0F);
  EXPECT_EQ(event<PortInputChanged>("analog 1 -2.5").value, -2.5F);
  EXPECT_EQ(event<SpindleLoaded>("spindle slow 0.5").share, 0.5);
  EXPECT_EQ(event<SpindleLoaded>("spindle stuck").share, 0);
  EXPECT_EQ(event<SpindleLoaded>("spindle free").share, 1);
  EXPECT_FALSE(event<EncoderPlugged>("encoder unplug").plugged);
  EXPECT_TRUE(as<PendantTakes>("pendant take").command);
  EXPECT_EQ(as<PendantSays>(R"(pendant say $J=G91X1F500\n)").bytes, "$J=G91X1F500\n");
}

TEST(WorkcellScript, Surfaces) {
  EXPECT_EQ(event<ProbeSurfaceMoved>("surface none").z_mm, std::nullopt);
  const auto moved = event<ProbeSurfaceMoved>("surface -12.5 tilt 0.01 -0.02 wave 0.3 40");
  EXPECT_EQ(moved.z_mm, -12.5);
  EXPECT_EQ(moved.shape.tilt_y, -0.02);
  EXPECT_EQ(moved.shape.wave_length_mm, 40);
}

TEST(WorkcellScript, BytesOnTheWire) {
  const auto drop = as<OrderByteFault>("drop to next 3");
  EXPECT_TRUE(drop.directions.to_controller);
  EXPECT_FALSE(drop.directions.from_controller);
  EXPECT_EQ(drop.order.kind, ByteFault::Drop);
  EXPECT_EQ(drop.order.next_bytes, 3U);
  EXPECT_EQ(as<OrderByteFault>("corrupt from rate 0.01").order.rate, 0.01);
  EXPECT_EQ(as<OrderByteFault>("duplicate both off").order.rate, 0);
  const auto latency = as<OrderByteFault>("delay both 50ms");
  EXPECT_EQ(latency.order.rate, 1);
  EXPECT_EQ(latency.order.delay, 50ms);
  EXPECT_EQ(as<OrderByteFault>("delay to 2s next 10").order.next_bytes, 10U);
  EXPECT_EQ(as<OrderByteFault>("delay to off").order.rate, 0);
  EXPECT_EQ(as<SeedChance>("seed 42").seed, 42U);
  EXPECT_EQ(as<InjectBytes>(R"(inject from ok\r\n)").bytes, "ok\r\n");
  EXPECT_EQ(as<InjectBytes>("inject to G1  X1").bytes, "G1  X1");
}

TEST(WorkcellScript, PowerAndLink) {
  EXPECT_EQ(as<SetLink>("link silent").state, LinkState::Silent);
  EXPECT_FALSE(as<SetPower>("power off").on);
  EXPECT_EQ(as<Stall>("stall 1.5s").time, 1500ms);
  EXPECT_EQ(as<WriteNote>("note now it gets hard").text, "now it gets hard");
  as<Reboot>("reboot");
  as<EndByteFaults>("faults off");
}

TEST(WorkcellScript, Timings) {
  EXPECT_EQ(timing<AtTime>("at 12.5s door open").time, 12500ms);
  EXPECT_EQ(timing<AfterTime>("after 200ms").time, 200ms);
  EXPECT_EQ(timing<AfterTime>("door open").time, 0ms);
  EXPECT_EQ(timing<WhenLine>("when line 20 estop press").lines, 20U);
  EXPECT_EQ(timing<WhenState>("when state Hold:0 start").substate, 0);
  EXPECT_EQ(timing<WhenState>("when state Run limit X on").state, MachineState::Run);
}

TEST(WorkcellScript, LinesKeepTheirNumbersAndCommentsSayNothing) {
  const auto script = parse_script("# first\n\n\tdoor open   # by hand\r\n   \nafter 1s\n");
  ASSERT_TRUE(script);
  ASSERT_THAT(*script, SizeIs(2));
  EXPECT_EQ((*script)[0].number, 3U);
  EXPECT_EQ((*script)[0].text, "door open");
  EXPECT_EQ((*script)[1].number, 5U);
  EXPECT_FALSE((*script)[1].deed);
}

TEST(WorkcellScript, WhatIsWrongIsSaidWithWhatWouldBeRight) {
  const auto wrong = [](std::string_view text, std::string_view what, std::string_view accepted) {
    const auto line = parse_script_line(text, 7);
    ASSERT_FALSE(line) << text;
    EXPECT_EQ(line.error().line, 7U);
    EXPECT_THAT(line.error().what, HasSubstr(what));
    EXPECT_THAT(line.error().accepted, HasSubstr(accepted));
  };
  wrong("dor open", "'dor' is no command", "door");
  wrong("door ajar", "'door ajar'", "door open|close");
  wrong("limit Q on", "limit Q on", "X|Y|Z");
  wrong("drop to", "drop to", "next N");
  wrong("drop to next 0", "drop to next 0", "next N");
  wrong("corrupt both rate 1.5", "rate 1.5", "rate R");
  wrong("at noon door open", "'noon' is no time", "200ms");
  wrong("when state Running hold", "'Running' is no state", "Idle, Run, Hold");
  wrong("when state Hold:x hold", "'Hold:x'", "Hold:0");
  wrong("when line x hold", "when line x", "when line N");
  wrong("when", "'when'", "when state NAME");
  wrong("inject to \\q", "inject", "\\x18");
  wrong("input 16 on", "input 16 on", "input N on|off");
  wrong("analog 0 high", "analog", "VALUE");
  wrong("spindle slow 3", "slow 3", "slow SHARE");
  wrong("encoder off", "encoder off", "plug|unplug");
  wrong("pendant say", "pendant say", "say TEXT");
  wrong("surface -1 wave 1 0", "surface", "wave HEIGHT LENGTH");
}

TEST(WorkcellScript, NoTextDoesHarm) {
  rc::check("any text is a script or an error", [](const std::string& text) {
    const auto script = parse_script(text);
    RC_ASSERT(script || !script.error().what.empty());
  });
}

}  // namespace
}  // namespace kerf::firmware
