#include "sender/machine/capability_collector.hpp"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"

namespace kerf::machine {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using vocabulary::SettingType;

/// What is known after these lines.
Capabilities after(std::string_view lines) {
  CapabilityCollector collector;
  for (const std::string_view line : base::split(lines, '\n')) collector.fold(protocol::decode(line));
  return collector.capabilities(true);
}

constexpr std::string_view kGrblHal =
    "[VER:1.1f.20260817:mill]\n[OPT:VNML+,100,1024,4,0]\n[AXS:4:XYZA]\n[NEWOPT:ENUMS,RT-,HOME,ATC=1,SED,SD,YM,PC]\n"
    "[FIRMWARE:grblHAL]\n[SIGNALS:DE]\n[AUX IO:4,3,2,1]\n[PLUGIN:SD card v1]\n[PLUGIN:Network v2]\n";

TEST(CapabilityCollector, EveryRowOfTheBuildIsKept) {
  const auto known = after(kGrblHal);
  EXPECT_THAT(known.build_rows, SizeIs(4));
  EXPECT_EQ(known.axes.letters, "XYZA");
  EXPECT_EQ(known.features.aux_ports, (AuxPortsFact{4, 3, 2, 1, FactSource::Told}));
  EXPECT_EQ(known.features.safety_door.available, true);
  EXPECT_EQ(known.features.emergency_stop.available, true);
  EXPECT_EQ(known.features.sd_card.available, true);
  EXPECT_EQ(known.features.sd_card.source, FactSource::Told);
  EXPECT_EQ(known.features.pendant.available, false);
  EXPECT_EQ(known.features.tool_change.kind, ToolChangeKind::Changer);
  EXPECT_EQ(known.features.legacy_realtime.available, false);
  EXPECT_THAT(known.option_meanings, SizeIs(5 + 8));
}

TEST(CapabilityCollector, AskingTwiceAddsNothing) {
  const std::string twice = std::string{kGrblHal} + std::string{kGrblHal};
  EXPECT_EQ(after(kGrblHal).build_rows, after(twice).build_rows);
}

TEST(CapabilityCollector, SettingsAreDescribedByTheControllerAndExplainedByItsTable) {
  const auto known = after(std::string{kGrblHal} +
                           "$32=1\n[SETTINGGROUP:6|0|Spindel]\n"
                           "[SETTING:32|6|Betriebsart||3|Normal,Laser,Drehbank|||1|0]\n"
                           "$-Code\tSetting\n"
                           "32\tBetriebsart\tinteger\tradiobuttons\tNormal,Laser,Drehbank\tZeile 1.\\nZeile 2.\n"
                           "Zeile 3.\t\t\t1\t0\nok\nnothing more");
  ASSERT_THAT(known.settings, SizeIs(1));
  const auto& mode = known.settings[0];
  EXPECT_EQ(mode.name, "Betriebsart");
  EXPECT_EQ(mode.group, "Spindel");
  EXPECT_EQ(mode.type_name, "Radio");
  EXPECT_EQ(mode.help, "Zeile 1.\nZeile 2.\nZeile 3.");
  EXPECT_TRUE(mode.reboot_required);
  EXPECT_EQ(mode.source, FactSource::Told);
  EXPECT_EQ(mode.help_source, FactSource::Told);
  EXPECT_EQ(known.features.mode, (WordFact{"Laser", FactSource::Told}));
}

TEST(CapabilityCollector, GrblGetsOurTables) {
  const auto known = after(
      "Grbl 1.1h ['$' for help]\n[VER:1.1h.20190830:]\n[OPT:VH,15,128]\n$13=1\n$22=1\n$110=500.000\n"
      "[G54:0.000,0.000,0.000]\n[G28:0.000,0.000,0.000]");
  const auto* rate = known.find_setting("110");
  ASSERT_NE(rate, nullptr);
  EXPECT_EQ(rate->unit, "mm/min");
  EXPECT_EQ(rate->type, static_cast<int>(SettingType::Decimal));
  EXPECT_EQ(rate->source, FactSource::Inferred);
  EXPECT_FALSE(rate->help.empty());
  EXPECT_EQ(known.features.report_units, (WordFact{"inch", FactSource::Told}));
  EXPECT_EQ(known.features.homing.enabled, true);
  EXPECT_EQ(known.features.homing.single_axis, true);
  EXPECT_THAT(known.features.homing.phases, ElementsAre("Z", "XY"));
  EXPECT_EQ(known.features.homing.phases_source, FactSource::Inferred);
  EXPECT_EQ(known.features.tool_change.kind, ToolChangeKind::None);
  EXPECT_THAT(known.features.coordinate_systems.names, ElementsAre("G54"));
}

TEST(CapabilityCollector, RabbitsNamesAreItsNumbers) {
  const auto known = after(
      "Rabbit GRBL v1.6.0 Build 20260315\n[VER:1.1h.20260315]\n[OPT:PHL]\n$22=1\n$110=4000.000\n$50=4\n$51=3\n"
      "$Homing/Enable=1\n$X/MaxRate=4000.000\n$Homing/Squared=X\n$GCode/Line0=");
  EXPECT_THAT(known.settings, SizeIs(5));
  EXPECT_NE(known.find_setting("Homing/Squared"), nullptr);
  EXPECT_THAT(known.features.homing.phases, ElementsAre("Z", "XY"));
  EXPECT_EQ(known.features.homing.phases_source, FactSource::Told);
  EXPECT_EQ(known.features.tool_change.kind, ToolChangeKind::Ignored);
}

TEST(CapabilityCollector, UnknownFirmwareGetsASafeMinimum) {
  const auto known = after("[VER:9.9]\n[FIRMWARE:Other]\n$7=1");
  EXPECT_EQ(known.family, vocabulary::Firmware::Unknown);
  EXPECT_LE(known.buffers.rx_usable, 127);
  EXPECT_EQ(known.buffers.rx_source, FactSource::Assumed);
  EXPECT_EQ(known.features.probe.available, std::nullopt);
  EXPECT_EQ(known.features.legacy_realtime.available, true);
  ASSERT_THAT(known.settings, SizeIs(1));
  EXPECT_EQ(known.settings[0].source, FactSource::Assumed);
}

TEST(CapabilityCollector, SpindlesInBothForms) {
  const auto table = after("[SPINDLE:0|0|0|*DRV|PWM|0.0,1000.0]\n[SPINDLE:1|-|4|SDE|VFD: Huanyang|10,24000]");
  ASSERT_THAT(table.spindles, SizeIs(2));
  EXPECT_EQ(table.spindles[0].max_rpm, 1000.0);
  EXPECT_EQ(table.spindles[1].number, std::nullopt);
  EXPECT_EQ(table.spindles[1].name, "VFD: Huanyang");
  const auto spindle = read_spindle_line("2 - VFD - old, enabled as spindle 1, active");
  ASSERT_TRUE(spindle);
  EXPECT_EQ(spindle->name, "VFD - old");
  EXPECT_EQ(spindle->number, 1);
  EXPECT_EQ(spindle->flags, "*");
  EXPECT_FALSE(read_spindle_line("hello - world"));
}

TEST(CapabilityCollector, TheOrderOfRowsDoesNotMatter) {
  EXPECT_TRUE(rc::check("order", [] {
    auto lines = base::split(
        "[SETTINGGROUP:43|42|X-axis]\n$110=500.000\n[SETTING:110|43|X|mm/min|6|0.0|||0|0]\n"
        "110\tX\tmm/min\tfloat\t0.0\thelp\t\t\t0\t0\n[NEWOPT:ENUMS,SED]\n[FIRMWARE:grblHAL]",
        '\n');
    CapabilityCollector in_order;
    for (const auto line : lines) in_order.fold(protocol::decode(line));
    CapabilityCollector shuffled;
    while (!lines.empty()) {
      const auto at = *rc::gen::inRange<std::size_t>(0, lines.size());
      shuffled.fold(protocol::decode(lines[at]));
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
    }
    RC_ASSERT(in_order.capabilities(true) == shuffled.capabilities(true));
  }));
}

}  // namespace
}  // namespace kerf::machine
