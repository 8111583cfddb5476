#include "firmware/rig.hpp"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/text.hpp"
#include "firmware/bench_for_tests.hpp"

namespace kerf::firmware {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using vocabulary::Firmware;
using vocabulary::MachineState;

/// A rig that is switched on, and somebody who sends and orders.
struct Site {
  explicit Site(Firmware firmware = Firmware::GrblHal) : Site(personality_of(firmware), {}) {}
  Site(const Personality& personality, Equipment equipment)
      : rig(VirtualController(personality, testing::Bench::factory(), std::move(equipment))) {
    rig.power_on(now);
    hear();
  }

  std::string hear() { return rig.take_outbox(); }
  std::string send(std::string_view bytes) {
    rig.on_bytes(now, bytes);
    rig.advance_to(now);
    return hear();
  }
  std::string wait(Duration time) {
    now += time;
    rig.advance_to(now);
    return hear();
  }
  void order(std::string_view text) {
    const auto line = parse_script_line(text);
    ASSERT_TRUE(line && *line) << text;
    rig.submit(now, **line, "test");
  }
  void play(std::string_view text) {
    auto script = parse_script(text);
    ASSERT_TRUE(script) << explain(script.error());
    rig.play(now, RigRecordKind::Script, "a.script", *std::move(script));
  }
  /// Texts of the log, with their seconds.
  std::vector<std::string> log(RigRecordKind kind) {
    for (RigRecord& record : rig.take_records()) records.push_back(std::move(record));
    std::vector<std::string> texts;
    for (const RigRecord& record : records) {
      if (record.kind == kind) texts.push_back(base::to_fixed(base::to_seconds(record.at), 3) + " " + record.what);
    }
    return texts;
  }

  Instant now{};
  Rig rig;
  std::vector<RigRecord> records;
};

TEST(Rig, WithoutOrdersItIsTheController) {
  testing::Bench bench(Firmware::GrblHal);
  Site site;
  for (const std::string_view bytes : {"G21G91\nG1X2F300\n", "?", "$G\n!", "~", "\x18"}) {
    bench.controller.on_bytes(bench.now, bytes);
    site.rig.on_bytes(site.now, bytes);
    EXPECT_EQ(site.rig.next_deadline(), bench.controller.next_deadline());
    site.rig.advance_to(site.now);
    bench.controller.advance_to(bench.now);
    EXPECT_EQ(site.rig.next_deadline(), bench.controller.next_deadline());
    bench.now += 130ms;
    bench.controller.advance_to(bench.now);
    EXPECT_EQ(site.wait(130ms), bench.controller.take_outbox());
  }
}

TEST(Rig, AScriptWaitsForItsMoments) {
  Site site;
  site.play("at 1s hold\nwhen state Hold:0\nafter 500ms start\nwhen state Idle note done\n");
  site.send("G21G91G1X50F1000\n");
  site.wait(1min);
  EXPECT_THAT(
      site.log(RigRecordKind::Script),
      ElementsAre("1.000 at 1s hold", AllOf(StartsWith("1."), EndsWith("when state Hold:0")),
                  AllOf(StartsWith("2."), EndsWith("after 500ms start")), EndsWith("when state Idle note done")));
  EXPECT_THAT(site.log(RigRecordKind::State), Contains("1.000 Hold:1"));
  EXPECT_EQ(site.records.back().what, "when state Idle note done");
  EXPECT_EQ(site.records.back().from, "a.script:4");
  EXPECT_EQ(site.rig.controller().state(), MachineState::Idle);
}

TEST(Rig, LinesOfGCodeAreCounted) {
  Site site;
  site.play("when line 3 door open\n");
  site.send("$G\nG21\n\nG90\n");
  EXPECT_THAT(site.log(RigRecordKind::Script), IsEmpty());
  site.send("G94\n");
  EXPECT_THAT(site.log(RigRecordKind::Script), ElementsAre("0.000 when line 3 door open"));
  EXPECT_EQ(site.rig.controller().state(), MachineState::Door);
}

TEST(Rig, LostBytesAreLostAndLogged) {
  Site site;
  site.order("drop to next 2");
  EXPECT_EQ(site.send("G21\n"), "error:1\r\n");
  EXPECT_THAT(site.log(RigRecordKind::Fault),
              ElementsAre("0.000 dropped byte 1 to 2 on the way to the controller: G2"));
  site.order("drop from next 4");
  EXPECT_EQ(site.send("\n"), "");
}

TEST(Rig, ItsLogHasNoPasswords) {
  Site site;
  site.wait(1s);
  site.send("$75=hun");
  site.order("drop to next 4");
  site.send("ter2\n");
  site.order("inject to $75=hunter2\\n");
  ASSERT_EQ(site.log(RigRecordKind::Fault).size(), 1U);
  for (const RigRecord& record : site.records) EXPECT_EQ(record.what.find("ter2"), std::string::npos) << record.what;
}

TEST(Rig, LateAnswersComeLate) {
  Site site;
  site.order("delay from 30ms");
  EXPECT_EQ(site.send("G21\n"), "");
  EXPECT_LE(site.rig.next_deadline(), site.now + 30ms);
  EXPECT_EQ(site.wait(29ms), "");
  EXPECT_EQ(site.wait(1ms), "ok\r\n");
}

TEST(Rig, ACutLinkCarriesNothing) {
  Site site;
  site.order("link cut");
  EXPECT_EQ(site.rig.link(), LinkState::Cut);
  EXPECT_EQ(site.send("G21G91G0X1\n"), "");
  site.order("link restore");
  EXPECT_EQ(site.send("?").substr(0, 6), "<Idle|");
}

TEST(Rig, PowerOffForgetsMotionAndKeepsTheWorld) {
  Site site(Firmware::Grbl);
  site.send("$100=200\nG91G1X10F1000\n");
  site.order("limit Y on");
  site.wait(200ms);
  site.order("power off");
  EXPECT_EQ(site.send("?"), "");
  EXPECT_EQ(site.rig.next_deadline(), kNever);
  site.wait(5s);
  site.order("power on");
  EXPECT_THAT(site.hear(), HasSubstr("Grbl 1.1h"));
  const std::string status = site.send("?");
  EXPECT_THAT(status, AllOf(HasSubstr("<Idle|MPos:0.000"), HasSubstr("Pn:Y")));
  EXPECT_THAT(site.send("$$\n"), HasSubstr("$100=200.000"));
  EXPECT_THAT(site.log(RigRecordKind::State), Contains("0.200 no power"));
}

TEST(Rig, TheHomingSwitchStaysWhereItIsThroughAReboot) {
  Site site(Firmware::Grbl);
  site.send("G91G1Z-5F400\n");
  site.wait(10s);
  site.order("reboot");
  site.hear();
  // 200 mm of travel: the switch was 200 mm above the first power-on, and is 205 mm above this one.
  const auto geometry = Workcell::Geometry{
      .axes = 3, .steps_per_mm = {250, 250, 250}, .travel_mm = {200, 200, 200}, .homing_negative = 0};
  EXPECT_EQ(site.rig.controller().workcell().homing_switch_step(2, geometry), 205 * 250);
}

TEST(Rig, AStalledControllerAnswersLater) {
  Site site;
  site.order("stall 2s");
  EXPECT_EQ(site.send("G21\n?"), "");
  EXPECT_EQ(site.wait(1999ms), "");
  const std::string heard = site.wait(1ms);
  EXPECT_THAT(heard, AllOf(HasSubstr("ok\r\n"), HasSubstr("<Idle|")));
}

TEST(Rig, MotionGoesOnInAStallAndAHoldWaits) {
  Site site;
  site.send("G21G91G1X50F600\n");
  site.wait(1s);
  site.order("stall 1s");
  site.send("!");
  const auto before = site.rig.controller().motor_steps()[0];
  site.wait(900ms);
  EXPECT_GT(site.rig.controller().motor_steps()[0], before + 1000);
  EXPECT_EQ(site.rig.controller().state(), MachineState::Run);
  site.wait(100ms);
  EXPECT_EQ(site.rig.controller().state(), MachineState::Hold);
}

TEST(Rig, AStallFillsTheReceiveBuffer) {
  Site site(Firmware::Grbl);
  site.order("stall 1s");
  const std::size_t room = site.rig.receive_room();
  std::string lines;
  while (lines.size() <= room) lines += "G4P0\n";
  site.send(lines);
  EXPECT_EQ(site.rig.receive_room(), 0U);
  const std::string heard = site.wait(1s);
  // The line whose end was lost runs into nothing.
  EXPECT_EQ(std::ranges::count(heard, 'k'), static_cast<std::ptrdiff_t>(room / 5));
}

TEST(Rig, RabbitAnswersStatusFromItsReceiveTask) {
  Site site(Firmware::Rabbit);
  site.order("stall 2s");
  EXPECT_THAT(site.send("?"), StartsWith("<Idle|"));
}

TEST(Rig, APlayerThatIsStoppedDoesNothingMore) {
  Site site;
  auto script = parse_script("after 1s door open\n");
  const auto player = site.rig.play(site.now, RigRecordKind::Order, "somebody", *std::move(script));
  site.rig.stop(player);
  site.wait(2s);
  EXPECT_EQ(site.rig.controller().state(), MachineState::Idle);
}

TEST(Rig, AScriptPlaysThePendant) {
  Site site(personality_of(Firmware::GrblHal), {.pendant = true});
  site.order("pendant take");
  site.wait(10ms);
  EXPECT_TRUE(site.rig.controller().pendant_commands());
  EXPECT_EQ(site.send("G21\n"), "");
  site.order(R"(pendant say $J=G91X1F600\n)");
  EXPECT_THAT(site.rig.take_pendant_outbox(), HasSubstr("ok\r\n"));
  site.wait(1s);
  EXPECT_EQ(site.rig.controller().position_steps()[0], 250);
  site.order("pendant take");
  EXPECT_TRUE(site.rig.controller().pendant_commands());
  site.order("pendant return");
  site.wait(10ms);
  EXPECT_FALSE(site.rig.controller().pendant_commands());
  EXPECT_EQ(site.send("G21\n"), "ok\r\n");
}

TEST(Rig, AScriptSetsUserInputs) {
  const Personality built = built_with(personality_of(Firmware::GrblHal), {.ports = {.digital_inputs = 2}});
  Site site(built, {});
  site.play("after 500ms input 1 on\n");
  EXPECT_EQ(site.send("M66P1L3Q2\n"), "");
  EXPECT_EQ(site.wait(1s), "ok\r\n");
  EXPECT_THAT(site.send("?"), HasSubstr("|In:1"));
}

TEST(Rig, WhatAMachineDoesNotHaveIsPlayedInVainAndLogged) {
  Site site;
  for (const auto* const order : {"pendant take", "input 0 on", "analog 1 2.5"}) site.order(order);
  EXPECT_THAT(site.log(RigRecordKind::InVain),
              ElementsAre("0.000 there is no pendant", "0.000 there is no such user input",
                          "0.000 there is no such analog input"));
}

TEST(Rig, EveryDeedIsAnEntryInTheLog) {
  for (const std::string_view usage : script_usage()) {
    Site site;
    // The first way to write it, with something in the place of what is meant.
    std::string line{usage.substr(0, usage.find_first_of("|["))};
    for (const auto& [meant, value] :
         std::initializer_list<std::pair<std::string_view, std::string_view>>{{"door open", "door open"},
                                                                              {"N on", "0 on"},
                                                                              {"N VALUE", "0 1"},
                                                                              {"surface Z", "surface -1"},
                                                                              {"TIME", "1s"},
                                                                              {"TEXT", "text"},
                                                                              {"seed N", "seed 1"}}) {
      if (const auto at = line.find(meant); at != std::string::npos) line.replace(at, meant.size(), value);
    }
    while (line.ends_with(' ')) line.pop_back();
    if (line == "limit X") line += " on";
    if (line == "switch X" || line == "lose X") line += " 10";
    if (line.ends_with(" to")) {
      line += line.starts_with("delay") ? " 1s" : line.starts_with("inject") ? " G21" : " next 1";
    }
    site.order(line);
    EXPECT_THAT(site.log(RigRecordKind::Order), ElementsAre("0.000 " + line));
  }
}

TEST(Rig, InjectedBytesReachBothEnds) {
  Site site;
  site.order(R"(inject from rst:0x1\r\n)");
  EXPECT_EQ(site.hear(), "rst:0x1\r\n");
  site.order(R"(inject to G91\n)");
  EXPECT_EQ(site.hear(), "ok\r\n");
}

}  // namespace
}  // namespace kerf::firmware
