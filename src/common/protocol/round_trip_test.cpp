// decode(encode(message)) is the message, to the printed precision, for every message and every dialect.

#include <array>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "common/protocol/decode.hpp"
#include "common/protocol/encode.hpp"

namespace kerf::protocol {
namespace {

using vocabulary::all_dialects;
using vocabulary::Dialect;

// What numbers are drawn from: those that the style prints exactly.
struct Draw {
  PrintStyle style;

  static int number(int least, int most) { return *rc::gen::inRange(least, most + 1); }
  static bool coin() { return *rc::gen::arbitrary<bool>(); }
  static double scaled(int decimals, int least = -2'000'000, int most = 2'000'000) {
    int ten_to_the_decimals = 1;
    for (int digit = 0; digit < decimals; ++digit) ten_to_the_decimals *= 10;
    // One division, so that the value is the nearest to what is printed.
    return static_cast<double>(number(least, most)) / ten_to_the_decimals;
  }
  [[nodiscard]] double position() const { return scaled(style.position_decimals); }
  [[nodiscard]] std::vector<double> positions() const {
    std::vector<double> values(static_cast<std::size_t>(number(1, 8)));
    for (double& value : values) value = position();
    return values;
  }
  // Text of `letters`, as rapidcheck likes it.
  static std::string text_of(std::string_view letters, int least = 0) {
    const auto letter = rc::gen::elementOf(std::string{letters});
    std::string text = *rc::gen::container<std::string>(letter);
    while (static_cast<int>(text.size()) < least) text += letters.front();
    return text;
  }
  static std::string words() { return text_of("abcXYZ 019.,;:-_()[]<>$%?='\"/"); }
  static std::string without_bar() { return text_of("abcXYZ 019.,;:-_()[]<>$%?='\"/\\"); }
  static std::string name() { return text_of("ABCXYZabc", 1); }
};

template <typename Value>
std::optional<Value> maybe(Value value) {
  if (Draw::coin()) return value;
  return std::nullopt;
}

void expect_same(const Message& message, const PrintStyle& style) {
  const std::string line = encode(message, style);
  const Message back = decode(line);
  if (back == message) return;
  RC_LOG() << name_of(message) << ": " << line << "\nbecame " << name_of(back) << ": " << encode(back, style);
  RC_FAIL("the line reads back as another message");
}

// Runs `make` for each dialect, in millimetres and inches, on drawn values.
template <typename Make>
void check(const char* what, Make make) {
  EXPECT_TRUE(rc::check(what, [&] {
    for (const Dialect* dialect : all_dialects()) {
      const PrintStyle style = style_of(*dialect, Draw::coin());
      expect_same(make(Draw{style}), style);
    }
  }));
}

MachineState any_state() {
  return static_cast<MachineState>(
      Draw::number(static_cast<int>(MachineState::Idle), static_cast<int>(MachineState::Tool)));
}

void draw_grblhal_fields(StatusReport& report, const Draw& draw) {
  report.distance_to_go = maybe(draw.positions());
  report.active_spindle = maybe(Draw::number(0, 7));
  report.wcs = maybe(std::string{"G59.3"});
  report.scaled_axes = maybe(Draw::text_of("XYZ"));
  report.auto_report_ms = maybe(Draw::number(0, 1000));
  report.mpg = maybe(Draw::coin());
  report.homed = maybe(Homed{Draw::coin(), maybe(Draw::number(0, 255))});
  report.diameter = maybe(Draw::coin());
  report.tool = maybe(Draw::number(0, 99999));
  report.probe = maybe(ProbeState{Draw::number(0, 3), Draw::coin()});
  report.tlr = maybe(Draw::coin());
  report.input_result = maybe(Draw::number(-1, 1));
  report.firmware = maybe(std::string{"grblHAL"});
  report.critical = maybe(Draw::coin());
  for (int spindle = Draw::number(0, 2); spindle > 0; --spindle) {
    report.extra_spindles.push_back(
        {spindle, Draw::scaled(draw.style.rpm_decimals, 0, 24000), Draw::text_of("SC"), maybe(Draw::number(10, 200))});
  }
}

StatusReport any_report(const Draw& draw) {
  StatusReport report{.state = any_state(), .substate = maybe(Draw::number(0, 22))};
  report.machine_position = maybe(draw.positions());
  report.work_position = maybe(draw.positions());
  report.buffer = maybe(BufferState{Draw::number(0, 1000), Draw::number(0, 1024)});
  report.line_number = maybe(std::int32_t{Draw::number(1, 9'999'999)});
  report.feed_mm_per_min = maybe(Draw::scaled(draw.style.feed_decimals, 0, 20'000));
  if (report.feed_mm_per_min) report.spindle_rpm = maybe(Draw::scaled(draw.style.rpm_decimals, 0, 24000));
  if (report.spindle_rpm) report.measured_rpm = maybe(Draw::scaled(draw.style.rpm_decimals, 0, 24000));
  report.pins = maybe(Draw::text_of("XYZABCPRHSDLTEOFMQ0123"));
  report.work_offset = maybe(draw.positions());
  report.overrides = maybe(Overrides{Draw::number(10, 200), Draw::number(5, 100), Draw::number(10, 200)});
  report.accessories = maybe(Draw::text_of("SCFMET"));
  draw_grblhal_fields(report, draw);
  for (int count = Draw::number(0, 2); count > 0; --count) {
    report.unknown.push_back({"Xx" + Draw::name(), Draw::text_of("0129.,/part")});
  }
  return report;
}

TEST(RoundTrip, StatusReports) {
  check("status reports", [](const Draw& draw) -> Message { return any_report(draw); });
}

TEST(RoundTrip, ReportsReadTheSameInAnyFieldOrder) {
  EXPECT_TRUE(rc::check("field order", [] {
    const Draw draw{style_of(vocabulary::dialect_of(Firmware::GrblHal))};
    StatusReport report = any_report(draw);
    report.unknown.clear();
    report.extra_spindles.clear();
    std::vector<vocabulary::StatusField> order(draw.style.field_order.begin(), draw.style.field_order.end());
    for (std::size_t left = order.size(); left > 1; --left) {
      std::swap(order[left - 1], order[static_cast<std::size_t>(Draw::number(0, static_cast<int>(left) - 1))]);
    }
    PrintStyle shuffled = draw.style;
    shuffled.field_order = order;
    RC_ASSERT(decode(encode(report, shuffled)) == Message{report});
  }));
}

TEST(RoundTrip, Answers) {
  check("answers", [](const Draw&) -> Message {
    switch (Draw::number(0, 4)) {
      case 0: return Ok{};
      case 1: return ErrorAnswer{Draw::number(0, 300), {}};
      case 2: return FileError{Draw::number(0, 300), Draw::number(0, 1'000'000)};
      case 3: return ErrorAnswer{ErrorAnswer::kUnnumbered, "Bad " + Draw::name()};
      default: return AlarmRaised{Draw::number(0, 30)};
    }
  });
}

TEST(RoundTrip, SettingsAndStartup) {
  check("settings", [](const Draw&) -> Message {
    switch (Draw::number(0, 3)) {
      case 0: return SettingValue{std::to_string(Draw::number(0, 800)), Draw::words()};
      case 1: return SettingValue{Draw::name() + "/" + Draw::name(), Draw::words()};
      case 2: return StartupLine{Draw::number(0, 1), Draw::words()};
      default: return StartupResult{Draw::text_of("GXYZ019. "), Draw::number(0, 40)};
    }
  });
}

TEST(RoundTrip, Parameters) {
  check("parameters", [](const Draw& draw) -> Message {
    constexpr std::array kNames{"G54", "G55", "G59", "G59.1", "G59.3", "G28", "G30", "G92"};
    switch (Draw::number(0, 8)) {
      case 0: return StoredOffset{kNames.at(static_cast<std::size_t>(Draw::number(0, 7))), draw.positions()};
      case 1: return HomePosition{draw.positions(), Draw::number(0, 255)};
      case 2: return ToolLengthOffset{draw.positions()};
      case 3: return ToolLengthReference{draw.positions()};
      case 4: return ProbeResult{draw.positions(), Draw::coin()};
      case 5: return ScaledAxes{draw.positions()};
      case 6: return NamedParameter{"_" + Draw::name(), Draw::words()};
      case 7: return ParserState{{"G1", "G54", speed_word(Draw::number(0, 24000), draw.style)}};
      default:
        return ToolRow{Draw::number(0, 99), draw.positions(),
                       draw.position(),     "6,0,0",
                       Draw::without_bar(), std::to_string(Draw::number(0, 99))};
    }
  });
}

TEST(RoundTrip, BuildInformation) {
  check("build rows", [](const Draw&) -> Message {
    const bool has_text = Draw::coin();
    switch (Draw::number(0, 6)) {
      case 0: return Version{"1.1h", "20260315", has_text ? Draw::words() : "", has_text};
      case 1: {
        BuildOptions row{.letters = Draw::text_of("VNMCPZHTLADSR+*$#IEW2")};
        for (std::optional<int>* value : {&row.planner_blocks, &row.rx_bytes, &row.axes, &row.tools}) {
          if (Draw::coin()) break;
          *value = Draw::number(0, 2000);
        }
        return row;
      }
      case 2: return AxisNames{Draw::number(1, 8), Draw::text_of("XYZABC")};
      case 3: return NewOptions{{"ENUMS", "ATC=1", Draw::name()}};
      case 4: return FirmwareName{Draw::words()};
      case 5: return BuildRow{"X" + Draw::name(), Draw::words()};
      default: return Feedback{Draw::words()};
    }
  });
}

TEST(RoundTrip, Enumerations) {
  check("enumerations", [](const Draw&) -> Message {
    switch (Draw::number(0, 8)) {
      case 0: return AlarmCodeRow{Draw::number(0, 30), Draw::without_bar(), Draw::words() + "|" + Draw::words()};
      case 1: return ErrorCodeRow{Draw::number(0, 300), Draw::without_bar(), Draw::words()};
      case 2: return SettingGroupRow{Draw::number(0, 60), Draw::number(0, 60), Draw::words()};
      case 3:
        return SettingDefinition{.id = Draw::number(0, 900),
                                 .group = Draw::number(0, 60),
                                 .name = Draw::without_bar(),
                                 .unit = Draw::without_bar(),
                                 .type = Draw::number(0, 9),
                                 .format = Draw::without_bar(),
                                 .min = Draw::without_bar(),
                                 .max = Draw::without_bar(),
                                 .reboot = Draw::coin(),
                                 .allow_null = Draw::coin()};
      case 4: return SettingDescription{Draw::number(0, 900), Draw::words()};
      case 7: {
        SettingTableRow row{.id = Draw::number(0, 900), .columns = {}};
        for (int column = Draw::number(1, 10); column > 0; --column) row.columns.push_back(Draw::words());
        return row;
      }
      case 5: return FileRow{"/" + Draw::words(), Draw::number(-1, 1'000'000), Draw::coin()};
      case 6: return HelpRow{Draw::words()};
      default: return Echo{Draw::words()};
    }
  });
}

TEST(RoundTrip, OwnTablesReadBack) {
  for (const Dialect* dialect : all_dialects()) {
    const PrintStyle style = style_of(*dialect);
    for (const vocabulary::CodeRow& row : dialect->errors) {
      const ErrorCodeRow message{row.code, std::string{row.title}, std::string{row.text}};
      EXPECT_TRUE(decode(encode(message, style)) == Message{message}) << row.code;
    }
    for (const vocabulary::CodeRow& row : dialect->alarms) {
      const AlarmCodeRow message{row.code, {}, std::string{row.text}};
      EXPECT_TRUE(decode(encode(message, style)) == Message{message}) << row.code;
    }
    for (const vocabulary::SettingRow& row : dialect->settings) {
      if (row.id < 0) continue;
      const SettingDescription message{row.id, std::string{row.description}};
      EXPECT_TRUE(decode(encode(message, style)) == Message{message}) << row.id;
    }
  }
}

// Whatever comes: reading what was printed from what was read changes nothing more.
TEST(RoundTrip, AnyLineSettles) {
  EXPECT_TRUE(rc::check("any line", [] {
    const auto letter = rc::gen::elementOf(std::string{"<>[]|:=$,.-0123IdleMPosHoldWCOFSAB okerrALRM \xC3"});
    const std::string line = *rc::gen::container<std::string>(letter);
    const Message once = decode(encode(decode(line)));
    RC_ASSERT(decode(encode(once)) == once);
  }));
}

}  // namespace
}  // namespace kerf::protocol
