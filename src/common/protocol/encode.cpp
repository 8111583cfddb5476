#include "common/protocol/encode.hpp"

#include "common/base/text.hpp"
#include "common/protocol/printer.hpp"

namespace kerf::protocol {
namespace {

std::string join(std::span<const std::string> parts, char separator) {
  std::string out;
  for (const std::string& part : parts) {
    if (&part != parts.data()) out += separator;
    out += part;
  }
  return out;
}

// [NAME:text]
std::string bracketed(std::string_view name, std::string_view text) {
  std::string out = "[";
  out.append(name).append(":").append(text).append("]");
  return out;
}

std::string number(auto value) {
  return std::to_string(value);
}

std::string_view digit(bool flag) {
  return flag ? "1" : "0";
}

// One overload a message, each the inverse of its reader in decode.cpp.
struct Printer {
  const PrintStyle& style;

  [[nodiscard]] std::string positions(std::span<const double> values) const { return print_positions(values, style); }

  std::string operator()(const Ok&) const { return "ok"; }
  std::string operator()(const ErrorAnswer& error) const {
    return error.code == ErrorAnswer::kUnnumbered ? "error: " + error.text : "error:" + number(error.code);
  }
  std::string operator()(const FileError& error) const {
    return "error:" + number(error.code) + " in SD file at line " + number(error.line);
  }
  std::string operator()(const AlarmRaised& alarm) const { return "ALARM:" + number(alarm.code); }
  std::string operator()(const StatusReport& report) const { return encode_status(report, style); }
  std::string operator()(const Welcome& welcome) const { return welcome.line; }
  std::string operator()(const SettingValue& setting) const { return "$" + setting.id + "=" + setting.value; }
  std::string operator()(const StartupLine& line) const { return "$N" + number(line.index) + "=" + line.block; }
  std::string operator()(const StartupResult& result) const {
    return ">" + result.block + (result.error_code == 0 ? ":ok" : ":error:" + number(result.error_code));
  }
  std::string operator()(const ParserState& state) const { return bracketed("GC", join(state.words, ' ')); }
  std::string operator()(const StoredOffset& offset) const { return bracketed(offset.name, positions(offset.values)); }
  std::string operator()(const HomePosition& home) const {
    return bracketed("HOME", positions(home.values) + ":" + number(home.axis_mask));
  }
  std::string operator()(const ToolLengthOffset& offset) const { return bracketed("TLO", positions(offset.values)); }
  std::string operator()(const ToolLengthReference& row) const { return bracketed("TLR", positions(row.values)); }
  std::string operator()(const ProbeResult& probe) const {
    return bracketed("PRB", positions(probe.values).append(":").append(digit(probe.success)));
  }
  std::string operator()(const ToolRow& row) const {
    return bracketed("T", number(row.tool) + "|" + positions(row.offsets) + "|" + positions({&row.radius, 1}) + "|" +
                              row.geometry + "|" + row.name + "|" + row.pocket);
  }
  std::string operator()(const ScaledAxes& row) const { return bracketed("G51", positions(row.factors)); }
  std::string operator()(const NamedParameter& row) const { return bracketed("PARAM", row.name + "=" + row.value); }
  std::string operator()(const Version& row) const {
    std::string text = row.version;
    if (!row.build.empty()) text += "." + row.build;
    if (row.has_user_text) text += ":" + row.user_text;
    return bracketed("VER", text);
  }
  std::string operator()(const BuildOptions& row) const {
    std::string text = row.letters;
    for (const std::optional<int>& value : {row.planner_blocks, row.rx_bytes, row.axes, row.tools}) {
      if (!value) break;  // read by position: a gap cannot be printed
      text += "," + number(*value);
    }
    return bracketed("OPT", text);
  }
  std::string operator()(const AxisNames& row) const { return bracketed("AXS", number(row.count) + ":" + row.letters); }
  std::string operator()(const NewOptions& row) const { return bracketed("NEWOPT", join(row.flags, ',')); }
  std::string operator()(const FirmwareName& row) const { return bracketed("FIRMWARE", row.name); }
  std::string operator()(const BuildRow& row) const { return bracketed(row.key, row.value); }
  std::string operator()(const Feedback& feedback) const { return bracketed("MSG", feedback.text); }
  std::string operator()(const HelpRow& row) const { return bracketed("HLP", row.text); }
  std::string operator()(const Echo& echo) const { return bracketed("echo", " " + echo.text); }
  std::string operator()(const AlarmCodeRow& row) const {
    return bracketed("ALARMCODE", number(row.id) + "|" + row.title + "|" + row.text);
  }
  std::string operator()(const ErrorCodeRow& row) const {
    return bracketed("ERRORCODE", number(row.id) + "|" + row.title + "|" + row.text);
  }
  std::string operator()(const SettingGroupRow& row) const {
    return bracketed("SETTINGGROUP", number(row.id) + "|" + number(row.parent) + "|" + row.name);
  }
  std::string operator()(const SettingDefinition& row) const {
    std::string text = number(row.id) + "|" + number(row.group) + "|" + row.name + "|" + row.unit + "|" +
                       number(row.type) + "|" + row.format + "|" + row.min + "|" + row.max;
    return bracketed("SETTING", text.append("|").append(digit(row.reboot)).append("|").append(digit(row.allow_null)));
  }
  std::string operator()(const SettingDescription& row) const {
    return bracketed("SETTINGDESCR", number(row.id) + "|" + row.text);
  }
  std::string operator()(const SettingTableRow& row) const { return number(row.id) + "\t" + join(row.columns, '\t'); }
  std::string operator()(const FileRow& row) const {
    return bracketed("FILE", row.path + "|SIZE:" + number(row.size_bytes) + (row.unusable ? "|UNUSABLE" : ""));
  }
  std::string operator()(const Unrecognized& other) const { return other.line; }
};

}  // namespace

void append_positions(std::string& out, std::span<const double> values, const PrintStyle& style) {
  for (const double& value : values) {
    if (&value != values.data()) out += ',';
    base::append_fixed(out, value, style.position_decimals);
  }
}

std::string print_positions(std::span<const double> values, const PrintStyle& style) {
  std::string out;
  append_positions(out, values, style);
  return out;
}

std::string speed_word(double rpm, const PrintStyle& style) {
  std::string word = "S";
  base::append_fixed(word, rpm, style.rpm_decimals);
  if (style.speed_has_trailing_dot && style.rpm_decimals == 0) word += '.';
  return word;
}

PrintStyle style_of(const vocabulary::Dialect& dialect, bool inches) {
  const vocabulary::NumberStyle& numbers = dialect.numbers;
  return {.position_decimals = inches ? numbers.position_decimals_inch : numbers.position_decimals_mm,
          .feed_decimals = inches ? numbers.feed_decimals_inch : numbers.feed_decimals_mm,
          .rpm_decimals = 0,
          .speed_has_trailing_dot = numbers.speed_has_trailing_dot,
          .field_order = dialect.field_order};
}

std::string encode(const Message& message, const PrintStyle& style) {
  return std::visit(Printer{style}, message);
}

}  // namespace kerf::protocol
