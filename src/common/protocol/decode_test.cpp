#include "common/protocol/decode.hpp"

#include <string>

#include <gtest/gtest.h>

#include "common/protocol/encode.hpp"

namespace kerf::protocol {
namespace {

template <typename Expected>
void expect_decodes(std::string_view line, const Expected& expected) {
  const Message message = decode(line);
  const auto* found = std::get_if<Expected>(&message);
  ASSERT_NE(found, nullptr) << line << " is " << name_of(message);
  EXPECT_TRUE(*found == expected) << line;
}

void expect_unrecognized(std::string_view line) {
  expect_decodes(line, Unrecognized{std::string{line}});
}

TEST(Decode, Answers) {
  expect_decodes("ok", Ok{});
  expect_decodes("ok ", Ok{});
  expect_decodes("error:20", ErrorAnswer{20, {}});
  expect_decodes("error: Bad number format", ErrorAnswer{ErrorAnswer::kUnnumbered, "Bad number format"});
  EXPECT_TRUE(is_answer(decode("ok")));
  EXPECT_TRUE(is_answer(decode("error:9")));
  EXPECT_FALSE(is_answer(decode("error:20 in SD file at line 7")));
  expect_unrecognized("OK");
  expect_unrecognized("okay");
  expect_unrecognized("error");
  expect_unrecognized("error:");
  expect_unrecognized("error:x");
  expect_unrecognized("error:99999999999999");
}

TEST(Decode, ErrorInAFileIsNoAnswer) {
  expect_decodes("error:20 in SD file at line 7", FileError{20, 7});
  expect_unrecognized("error:20 in SD file at line x");
}

TEST(Decode, Alarms) {
  expect_decodes("ALARM:1", AlarmRaised{1});
  expect_unrecognized("ALARM:");
  expect_unrecognized("ALARM: Hard limit");
}

// protocol.md 5.3 row 4
TEST(Decode, Welcomes) {
  expect_decodes("Grbl 1.1h ['$' for help]", Welcome{Firmware::Grbl, "1.1h", "Grbl 1.1h ['$' for help]"});
  expect_decodes("GrblHAL 1.1f ['$' or '$HELP' for help]",
                 Welcome{Firmware::GrblHal, "1.1f", "GrblHAL 1.1f ['$' or '$HELP' for help]"});
  expect_decodes("Rabbit GRBL v1.6.0 Build 20260315  ",
                 Welcome{Firmware::Rabbit, "1.6.0", "Rabbit GRBL v1.6.0 Build 20260315  "});
  // Of the family, but none of ours: FluidNC, Grbl 0.9, a Rabbit of 2024.
  expect_decodes("Grbl 3.7 [FluidNC v3.7.8 (wifi) '$' for help]",
                 Welcome{Firmware::Unknown, "3.7", "Grbl 3.7 [FluidNC v3.7.8 (wifi) '$' for help]"});
  expect_decodes("Grbl 0.9j ['$' for help]", Welcome{Firmware::Unknown, "0.9j", "Grbl 0.9j ['$' for help]"});
  expect_decodes("Grbl 1.1h (20240303)", Welcome{Firmware::Unknown, "1.1h", "Grbl 1.1h (20240303)"});
  expect_unrecognized("Grblly 1.1h ['$' for help]");
  expect_unrecognized("Grbl is a controller");
  expect_unrecognized("Rabbit GRBLing");
  expect_unrecognized("Marlin 2.0");
  expect_unrecognized("ets Jun  8 2016 00:22:57");
}

TEST(Decode, DialectsGreetAsThemselves) {
  for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
    const auto welcome = std::get<Welcome>(decode(dialect->welcome));
    EXPECT_EQ(welcome.firmware, dialect->firmware);
  }
}

TEST(Decode, Settings) {
  expect_decodes("$110=500.000", SettingValue{"110", "500.000"});
  expect_decodes("$10=511", SettingValue{"10", "511"});
  expect_decodes("$Homing/Enable=1", SettingValue{"Homing/Enable", "1"});
  expect_decodes("$X/Home/Mpos=-1.000", SettingValue{"X/Home/Mpos", "-1.000"});
  expect_decodes("$74=my = net", SettingValue{"74", "my = net"});
  expect_decodes("$75=", SettingValue{"75", ""});
  expect_decodes("$N0=G54G21", StartupLine{0, "G54G21"});
  expect_decodes("$N1=", StartupLine{1, ""});
}

// Transcript 03: lines of $HELP are no settings.
TEST(Decode, HelpIsNoSetting) {
  expect_unrecognized("$J=<gcode> - jog machine.");
  expect_unrecognized("$<n>=<value> - assign <value> to settings <n>");
  expect_unrecognized("$N0 - N0=<gcode> - set startup line 0.");
  expect_unrecognized("$22: Homing cycle as bitfield where setting bit 0 enables the rest:");
  expect_unrecognized("$=1");
  expect_unrecognized("$");
}

TEST(Decode, StartupResults) {
  expect_decodes(">G54G21:ok", StartupResult{"G54G21", 0});
  expect_decodes(">x:error:5", StartupResult{"x", 5});
  expect_decodes(">:ok", StartupResult{"", 0});
  expect_decodes(">(a:b):error:20", StartupResult{"(a:b)", 20});
  expect_unrecognized(">G54");
  expect_unrecognized(">G54:error:x");
}

TEST(Decode, ParserState) {
  expect_decodes("[GC:G0 G54 G17 M5 M9 T0 F0 S0.]", ParserState{{"G0", "G54", "G17", "M5", "M9", "T0", "F0", "S0."}});
  expect_decodes("[GC:]", ParserState{});
}

TEST(Decode, Parameters) {
  expect_decodes("[G54:0.000,-1.500,2.000]", StoredOffset{"G54", {0, -1.5, 2}});
  expect_decodes("[G59.3:1.000,2.000,3.000,4.000]", StoredOffset{"G59.3", {1, 2, 3, 4}});
  expect_decodes("[G92:0.0394,0.0787,0.1181]", StoredOffset{"G92", {0.0394, 0.0787, 0.1181}});
  expect_decodes("[HOME:-1.000,-1.000,-1.000:7]", HomePosition{{-1, -1, -1}, 7});
  expect_decodes("[TLO:2.500]", ToolLengthOffset{{2.5}});
  expect_decodes("[TLO:0.000,0.000,1.000]", ToolLengthOffset{{0, 0, 1}});
  expect_decodes("[TLR:12.000]", ToolLengthReference{{12}});
  expect_decodes("[PRB:0.000,0.000,-4.072:1]", ProbeResult{{0, 0, -4.072}, true});
  expect_decodes("[PRB:0.000,0.000,0.000:0]", ProbeResult{{0, 0, 0}, false});
  expect_decodes("[G51:1.000,2.000,1.000]", ScaledAxes{{1, 2, 1}});
  expect_decodes("[PARAM:5220=1]", NamedParameter{"5220", "1"});
  expect_decodes("[PARAM:_vmajor=1.1]", NamedParameter{"_vmajor", "1.1"});
  expect_decodes("[T:1|1.000,2.000,3.000,0.000|0.500|6,0,0||1]", ToolRow{1, {1, 2, 3, 0}, 0.5, "6,0,0", "", "1"});
}

TEST(Decode, DamagedParametersAreUnrecognized) {
  expect_unrecognized("[G54:]");
  expect_unrecognized("[G54:0.000,,1.000]");
  expect_unrecognized("[G54:0.000,nan,1.000]");
  expect_unrecognized("[G54:0.000,1e5,1.000]");
  expect_unrecognized("[PRB:0.000,0.000,0.000]");
  expect_unrecognized("[PRB:0.000,0.000,0.000:2]");
  expect_unrecognized("[G54:0.000,0.000,0.000");
  expect_unrecognized("[T:1|1.000]");
  expect_unrecognized("[PARAM:5220]");
}

// protocol.md 4.5
TEST(Decode, BuildInformation) {
  expect_decodes("[VER:1.1f.20260817:hello: world]", Version{"1.1f", "20260817", "hello: world", true});
  expect_decodes("[VER:1.1h.20190830:]", Version{"1.1h", "20190830", "", true});
  expect_decodes("[VER:1.1h.20260315]", Version{"1.1h", "20260315", "", false});
  expect_decodes("[VER:3.7 FluidNC v3.7.8:]", Version{"3.7 FluidNC v3.7.8", "", "", true});
  expect_decodes("[OPT:VNML+,100,1024,3,0]", BuildOptions{"VNML+", 100, 1024, 3, 0});
  expect_decodes("[OPT:V,15,128]", BuildOptions{"V", 15, 128, {}, {}});
  expect_decodes("[OPT:PH]", BuildOptions{"PH", {}, {}, {}, {}});
  expect_decodes("[OPT:]", BuildOptions{});
  expect_decodes("[AXS:4:XYZA]", AxisNames{4, "XYZA"});
  expect_decodes("[NEWOPT:ENUMS,RT+,ATC=1,SOMETHING]", NewOptions{{"ENUMS", "RT+", "ATC=1", "SOMETHING"}});
  expect_decodes("[FIRMWARE:grblHAL]", FirmwareName{"grblHAL"});
  expect_decodes("[NVS STORAGE:*EEPROM]", BuildRow{"NVS STORAGE", "*EEPROM"});
  expect_decodes("[LASTEVENTS:,,,,]", BuildRow{"LASTEVENTS", ",,,,"});
  expect_decodes("[WIFI MAC:00:11:22]", BuildRow{"WIFI MAC", "00:11:22"});
}

// protocol.md 4.1: a text may be empty and may contain brackets.
TEST(Decode, Texts) {
  expect_decodes("[MSG:Caution: Unlocked]", Feedback{"Caution: Unlocked"});
  expect_decodes("[MSG:]", Feedback{""});
  expect_decodes("[MSG:a[1]]", Feedback{"a[1]"});
  expect_decodes("[MSG:a]b]", Feedback{"a]b"});
  expect_decodes("[MSG: keeps blanks ]", Feedback{" keeps blanks "});
  expect_decodes("[HLP:$$ $# $G]", HelpRow{"$$ $# $G"});
  expect_decodes("[echo: G0X1]", Echo{"G0X1"});
  expect_unrecognized("[MSG:unfinished");
  expect_unrecognized("[no colon]");
  expect_unrecognized("[:x]");
  expect_unrecognized("[]");
}

// protocol.md 5.3 rows 1 and 2: both spellings, with and without a title.
TEST(Decode, Enumerations) {
  expect_decodes("[ALARMCODE:1||text, with | all sorts]", AlarmCodeRow{1, "", "text, with | all sorts"});
  expect_decodes("[ALARM:1|title|text]", AlarmCodeRow{1, "title", "text"});
  expect_decodes("[ALARM:1|only a title]", AlarmCodeRow{1, "only a title", ""});
  expect_decodes("[ERRORCODE:0||]", ErrorCodeRow{0, "", ""});
  expect_decodes("[ERROR:2|title|text]", ErrorCodeRow{2, "title", "text"});
  expect_decodes("[SETTINGGROUP:43|42|X-axis]", SettingGroupRow{43, 42, "X-axis"});
  expect_decodes("[SETTINGDESCR:0|line\\nline | more]", SettingDescription{0, "line\\nline | more"});
  expect_unrecognized("[ALARMCODE:x||text]");
  expect_unrecognized("[SETTINGGROUP:43|X-axis]");
}

// protocol.md 5.1: ten fields, by position; fewer or more at the end are tolerated.
TEST(Decode, SettingDefinitions) {
  expect_decodes("[SETTING:481|1|Autoreport interval|ms|5|###0|100|1000|1|1]",
                 SettingDefinition{481, 1, "Autoreport interval", "ms", 5, "###0", "100", "1000", true, true});
  expect_decodes("[SETTING:1|2|name||0]", SettingDefinition{1, 2, "name", "", 0, "", "", "", false, false});
  expect_decodes("[SETTING:1|2|name||0|||||0|1|later]",
                 SettingDefinition{1, 2, "name", "", 0, "", "", "", false, false});
  expect_unrecognized("[SETTING:1|2|name|ms]");
}

TEST(Decode, Files) {
  expect_decodes("[FILE:/part.nc|SIZE:1234]", FileRow{"/part.nc", 1234, false});
  expect_decodes("[FILE:/big|SIZE:5000000000|UNUSABLE]", FileRow{"/big", 5'000'000'000, true});
  expect_decodes("[FILE:/folder|SIZE:-1]", FileRow{"/folder", -1, false});
  expect_unrecognized("[FILE:/part.nc]");
}

TEST(Decode, AnythingElseIsKept) {
  for (const std::string_view line : {"0 - simulated PWM spindle", "Malformed alarm number: x", "", " ", "<", "<>",
                                      "<|>", "<html>", "[", "]", ">", "$", "\x00\xFF", "Help topics:"}) {
    expect_unrecognized(line);
  }
}

TEST(Decode, NamesFollowTheVariant) {
  EXPECT_EQ(name_of(Ok{}), "Ok");
  EXPECT_EQ(name_of(StatusReport{}), "StatusReport");
  EXPECT_EQ(name_of(ProbeResult{}), "ProbeResult");
  EXPECT_EQ(name_of(BuildRow{}), "BuildRow");
  EXPECT_EQ(name_of(Unrecognized{}), "Unrecognized");
}

}  // namespace
}  // namespace kerf::protocol
