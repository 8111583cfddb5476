#include <string>

#include <gtest/gtest.h>

#include "common/protocol/decode.hpp"
#include "common/protocol/encode.hpp"

namespace kerf::protocol {
namespace {

StatusReport status(std::string_view line) {
  const std::optional<StatusReport> report = decode_status(line);
  EXPECT_TRUE(report) << line;
  return report.value_or(StatusReport{});
}

// The line comes back as it was: everything was read, nothing was lost.
void expect_same_line(std::string_view line, vocabulary::Firmware firmware, bool inches = false) {
  EXPECT_EQ(encode(decode(line), style_of(vocabulary::dialect_of(firmware), inches)), line);
  EXPECT_TRUE(status(line).unknown.empty()) << line;
}

TEST(DecodeStatus, ReadsTheUsualFields) {
  const StatusReport report =
      status("<Hold:1|MPos:1.000,-2.500,0.000|Bf:14,128|FS:250,12000|Pn:XP|WCO:0.000,0.000,1.000>");
  EXPECT_EQ(report.state, MachineState::Hold);
  EXPECT_EQ(report.substate, 1);
  EXPECT_EQ(report.machine_position, (std::vector<double>{1, -2.5, 0}));
  EXPECT_EQ(report.work_position, std::nullopt);
  EXPECT_EQ(report.buffer, (BufferState{14, 128}));
  EXPECT_EQ(report.feed_mm_per_min, 250);
  EXPECT_EQ(report.spindle_rpm, 12000);
  EXPECT_EQ(report.measured_rpm, std::nullopt);
  EXPECT_EQ(report.pins, "XP");
  EXPECT_EQ(report.work_offset, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(report.overrides, std::nullopt);
}

TEST(DecodeStatus, OrderDoesNotMatter) {
  EXPECT_EQ(status("<Idle|MPos:1.000,2.000,3.000|Bf:15,128|FS:0,0|Ov:100,50,10|A:SF>"),
            status("<Idle|A:SF|Ov:100,50,10|FS:0,0|MPos:1.000,2.000,3.000|Bf:15,128>"));
}

// Transcripts 10, 32, 24 and protocol.md 3.1
TEST(DecodeStatus, RecordedReportsComeBack) {
  using enum vocabulary::Firmware;
  expect_same_line("<Idle|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0|Ov:100,100,100|A:|TLR:0>", GrblHal);
  expect_same_line(
      "<Idle|MPos:0.000,0.000,0.000|Bf:100,1023|FS:0,0|WCO:0.000,0.000,0.000|WCS:G54|Ov:100,100,100|A:|Sc:|MPG:0|H:0|T:"
      "0|"
      "P:0|TLR:0|FW:grblHAL>",
      GrblHal);
  expect_same_line("<Run|MPos:0.008,0.096,0.000|Bf:53,1023|DTG:0.065,0.279,0.000|FS:136,300|Ov:100,100,100|A:S>",
                   GrblHal);
  expect_same_line("<Run|MPos:0.0003,0.0000,0.0000|Bf:99,1023|FS:3,0|WCO:0.0000,0.0000,0.0000>", GrblHal, true);
  expect_same_line("<Door:1|MPos:25.400,0.000,0.000|Bf:100,1023|FS:0,0|Pn:D|A:>", GrblHal);
  expect_same_line("<Idle|WPos:0.000,0.000,0.000>", GrblHal);
  expect_same_line("<Alarm:1|MPos:0.000,0.000,0.000|FS:0,0|AR:100|MPG:0|H:1,7|T:0|P:0,P|TLR:0|In:-1|FW:grblHAL|$C:1>",
                   GrblHal);
  expect_same_line("<Run:2|MPos:0.000,0.000,0.000,0.000|Ln:99|FS:500,8000,7990|SP1:0,,,100|SP2:1000,,C|S:1|AR|D:1>",
                   GrblHal);
  expect_same_line("<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>", Grbl);
  expect_same_line("<Run|WPos:1.000,2.000,3.000|Bf:14,120|Ln:7|FS:500,0|Pn:PXYZDRHS|Ov:100,100,100|A:SFM>", Grbl);
  expect_same_line("<Jog|MPos:0.0000,0.0000,0.0000|FS:12.5,0>", Grbl, true);
  expect_same_line("<Hold:0|MPos:0.000,0.000,0.000,0.000,0.000,0.000|FS:0,0|Pn:0>", Rabbit);
  expect_same_line("<Sleep|MPos:0.000,0.000,0.000|F:0>", Grbl);
}

TEST(DecodeStatus, KeepsUnknownFields) {
  const StatusReport report = status("<Idle|MPos:0.000,0.000,0.000|FS:0,0|SD:10.5,part.nc|Fan:1|SomeFlag>");
  ASSERT_EQ(report.unknown.size(), 3U);
  EXPECT_EQ(report.unknown[0], (UnknownField{"SD", "10.5,part.nc"}));
  EXPECT_EQ(report.unknown[1], (UnknownField{"Fan", "1"}));
  EXPECT_EQ(report.unknown[2], (UnknownField{"SomeFlag", ""}));
  EXPECT_EQ(encode(report), "<Idle|MPos:0.000,0.000,0.000|FS:0,0|SD:10.5,part.nc|Fan:1|SomeFlag>");
}

TEST(DecodeStatus, PluginFieldsComeBeforeTheFirmware) {
  const std::string line = "<Idle|MPos:0.000,0.000,0.000|T:2|SD:3|FW:grblHAL>";
  EXPECT_EQ(encode(decode(line)), line);
}

TEST(DecodeStatus, DamagedFieldsAreKeptAsUnknown) {
  const StatusReport report = status("<Run|MPos:1.0,x,2.0|Bf:15|FS:1|Ov:100,100|H:2|P:x|WPos:1.000>");
  EXPECT_EQ(report.machine_position, std::nullopt);
  EXPECT_EQ(report.work_position, (std::vector<double>{1}));
  EXPECT_EQ(report.buffer, std::nullopt);
  EXPECT_EQ(report.feed_mm_per_min, std::nullopt);
  EXPECT_EQ(report.homed, std::nullopt);
  EXPECT_EQ(report.unknown.size(), 6U);
}

TEST(DecodeStatus, TheFirstOfTwoCounts) {
  const StatusReport report = status("<Run|MPos:1.000|MPos:2.000>");
  EXPECT_EQ(report.machine_position, (std::vector<double>{1}));
  EXPECT_EQ(report.unknown, (std::vector<UnknownField>{{"MPos", "2.000"}}));
}

TEST(DecodeStatus, DamagedFieldsStayBehindSoundOnesWhenPrinted) {
  const StatusReport report = status("<Idle|MPos:1.000|FW:grblHAL:0|P:x|FW:grblHAL|P:0|Fan:1>");
  EXPECT_EQ(report.firmware, "grblHAL:0");
  EXPECT_EQ(encode(report), "<Idle|MPos:1.000|P:0|Fan:1|FW:grblHAL:0|P:x|FW:grblHAL>");
  EXPECT_EQ(status(encode(report)).firmware, "grblHAL:0");
}

TEST(DecodeStatus, EmptyTextsDifferFromAbsentOnes) {
  EXPECT_EQ(status("<Idle|MPos:0.000|A:>").accessories, "");
  EXPECT_EQ(status("<Idle|MPos:0.000>").accessories, std::nullopt);
  EXPECT_EQ(status("<Idle|MPos:0.000|Sc:>").scaled_axes, "");
}

TEST(DecodeStatus, AutoReportMayBeBare) {
  EXPECT_EQ(status("<Idle|MPos:0.000|AR>").auto_report_ms, 0);
  EXPECT_EQ(status("<Idle|MPos:0.000|AR:500>").auto_report_ms, 500);
  EXPECT_EQ(status("<Idle|MPos:0.000>").auto_report_ms, std::nullopt);
}

TEST(DecodeStatus, Substates) {
  EXPECT_EQ(status("<Alarm:3|MPos:0.000>").substate, 3);
  EXPECT_EQ(status("<Hold:0|MPos:0.000>").substate, 0);
  EXPECT_EQ(status("<Idle>").state, MachineState::Idle);
}

TEST(DecodeStatus, OddStatesAreKept) {
  const StatusReport with_odd_substate = status("<Hold:soon|MPos:0.000>");
  EXPECT_EQ(with_odd_substate.state, MachineState::Hold);
  EXPECT_EQ(with_odd_substate.odd_state, "Hold:soon");
  const StatusReport new_state = status("<Warming:2|MPos:0.000>");
  EXPECT_EQ(new_state.state, MachineState::Unknown);
  EXPECT_EQ(new_state.odd_state, "Warming:2");
  EXPECT_EQ(encode(new_state), "<Warming:2|MPos:0.000>");
}

TEST(DecodeStatus, OtherTextInAngleBracketsIsNoReport) {
  for (const std::string_view line :
       {"<html>", "<>", "<|>", "<Warming|Foo:1>", "<Idle|MPos:0.000", "Idle|MPos:0.000>"}) {
    EXPECT_EQ(decode_status(line), std::nullopt) << line;
  }
}

}  // namespace
}  // namespace kerf::protocol
