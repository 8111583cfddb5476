#include "common/protocol/decode.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "common/base/text.hpp"
#include "common/protocol/fields.hpp"

namespace kerf::protocol {
namespace {

using base::parse_int;

// A reader turns what stands between `[NAME:` and the last `]` into a message, or gives up.
using Found = std::optional<Message>;
using ReadRow = Found (*)(std::string_view name, std::string_view text);

std::string string_of(std::string_view text) {
  return std::string{text};
}

// [GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]
Found read_parser_state(std::string_view, std::string_view text) {
  ParserState state;
  for (const std::string_view word : base::split(text, ' ')) {
    if (!word.empty()) state.words.emplace_back(word);
  }
  return state;
}

// [G54:0.000,0.000,0.000]
Found read_stored_offset(std::string_view name, std::string_view text) {
  std::optional<std::vector<double>> values = numbers_of(text);
  if (!values) return std::nullopt;
  return StoredOffset{string_of(name), std::move(*values)};
}

// [TLO:0.000], [TLR:0.000], [G51:1.000,1.000,1.000]
template <typename Row>
Found read_values(std::string_view, std::string_view text) {
  std::optional<std::vector<double>> values = numbers_of(text);
  if (!values) return std::nullopt;
  return Row{std::move(*values)};
}

// [HOME:0.000,0.000,0.000:7]
Found read_home(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, ':');
  if (parts.size() != 2) return std::nullopt;
  std::optional<std::vector<double>> values = numbers_of(parts[0]);
  const std::optional<int> mask = parse_int(parts[1]);
  if (!values || !mask) return std::nullopt;
  return HomePosition{std::move(*values), *mask};
}

// [PRB:0.000,0.000,-4.072:1]
Found read_probe(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, ':');
  if (parts.size() != 2) return std::nullopt;
  std::optional<std::vector<double>> values = numbers_of(parts[0]);
  const std::optional<bool> success = flag_of(parts[1]);
  if (!values || !success) return std::nullopt;
  return ProbeResult{std::move(*values), *success};
}

// [T:1|1.000,2.000,3.000|0.500|6,0,0|name|1]; a name may hold anything but the separator
Found read_tool(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, '|');
  if (parts.size() < 3) return std::nullopt;
  const std::optional<int> tool = parse_int(parts[0]);
  std::optional<std::vector<double>> offsets = numbers_of(parts[1]);
  const std::optional<double> radius = base::parse_decimal(parts[2]);
  if (!tool || !offsets || !radius) return std::nullopt;
  const auto part = [&](std::size_t index) { return index < parts.size() ? string_of(parts[index]) : std::string{}; };
  return ToolRow{*tool, std::move(*offsets), *radius, part(3), part(4), part(5)};
}

// [PARAM:5220=1]
Found read_parameter(std::string_view, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  return NamedParameter{string_of(text.substr(0, equals)), string_of(text.substr(equals + 1))};
}

// [VER:1.1f.20260817:user text]; Rabbit: [VER:1.1h.20260315]
Found read_version(std::string_view, std::string_view text) {
  Version row;
  const std::size_t colon = text.find(':');
  row.has_user_text = colon != std::string_view::npos;
  if (row.has_user_text) row.user_text = text.substr(colon + 1);
  const std::string_view number = text.substr(0, colon);
  const std::size_t dot = number.rfind('.');
  const std::string_view tail = dot == std::string_view::npos ? std::string_view{} : number.substr(dot + 1);
  const bool is_date = tail.size() >= 6 && std::ranges::all_of(tail, base::is_digit);
  row.version = is_date ? number.substr(0, dot) : number;
  if (is_date) row.build = tail;
  return row;
}

// [OPT:VNML+,100,1024,3,0]
Found read_options(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, ',');
  if (parts.size() > 5) return std::nullopt;
  BuildOptions row;
  row.letters = parts[0];
  const std::array numbers{&row.planner_blocks, &row.rx_bytes, &row.axes, &row.tools};
  for (std::size_t index = 1; index < parts.size(); ++index) {
    *numbers[index - 1] = parse_int(parts[index]);
    if (!*numbers[index - 1]) return std::nullopt;
  }
  return row;
}

// [AXS:3:XYZ]
Found read_axes(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, ':', 2);
  const std::optional<int> count = parse_int(parts[0]);
  if (!count || parts.size() != 2) return std::nullopt;
  return AxisNames{*count, string_of(parts[1])};
}

// [NEWOPT:ENUMS,RT+,TC,SED]
Found read_new_options(std::string_view, std::string_view text) {
  NewOptions row;
  for (const std::string_view flag : base::split(text, ',')) {
    if (!flag.empty()) row.flags.emplace_back(flag);
  }
  return row;
}

// [FIRMWARE:grblHAL], [MSG:Pgm End], [HLP:$$ $# $G]
template <typename Row>
Found read_text(std::string_view, std::string_view text) {
  return Row{string_of(text)};
}

// [ALARMCODE:1|title|text], [ERRORCODE:1||text]; the text may hold anything
template <typename Row>
Found read_code(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, '|', 3);
  const std::optional<int> id = parse_int(parts[0]);
  if (!id || parts.size() < 2) return std::nullopt;
  return Row{*id, string_of(parts[1]), parts.size() > 2 ? string_of(parts[2]) : std::string{}};
}

// [SETTINGGROUP:43|42|X-axis]
Found read_setting_group(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, '|', 3);
  if (parts.size() != 3) return std::nullopt;
  const std::optional<int> id = parse_int(parts[0]);
  const std::optional<int> parent = parse_int(parts[1]);
  if (!id || !parent) return std::nullopt;
  return SettingGroupRow{*id, *parent, string_of(parts[2])};
}

// [SETTING:398|1|Planner buffer blocks||5|####0|30|1000|1|0]; read by position, fewer or more at the end are fine
Found read_setting(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, '|');
  if (parts.size() < 5) return std::nullopt;
  const std::optional<int> id = parse_int(parts[0]);
  const std::optional<int> group = parse_int(parts[1]);
  const std::optional<int> type = parse_int(parts[4]);
  if (!id || !group || !type) return std::nullopt;
  const auto part = [&](std::size_t index) { return index < parts.size() ? parts[index] : std::string_view{}; };
  return SettingDefinition{.id = *id,
                           .group = *group,
                           .name = string_of(parts[2]),
                           .unit = string_of(parts[3]),
                           .type = *type,
                           .format = string_of(part(5)),
                           .min = string_of(part(6)),
                           .max = string_of(part(7)),
                           .reboot = part(8) == "1",
                           .allow_null = part(9) == "1"};
}

// [SETTINGDESCR:110|text]
Found read_setting_description(std::string_view, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, '|', 2);
  const std::optional<int> id = parse_int(parts[0]);
  if (!id || parts.size() != 2) return std::nullopt;
  return SettingDescription{*id, string_of(parts[1])};
}

// [FILE:/part.nc|SIZE:1234|UNUSABLE]
Found read_file(std::string_view, std::string_view text) {
  constexpr std::string_view kUnusable = "|UNUSABLE";
  const bool unusable = text.ends_with(kUnusable);
  if (unusable) text.remove_suffix(kUnusable.size());
  const std::size_t at = text.rfind("|SIZE:");
  if (at == std::string_view::npos) return std::nullopt;
  const std::optional<std::int64_t> size = parse_int<std::int64_t>(text.substr(at + 6));
  if (!size) return std::nullopt;
  return FileRow{string_of(text.substr(0, at)), *size, unusable};
}

// [echo: G0X1]
Found read_echo(std::string_view, std::string_view text) {
  return Echo{string_of(text.starts_with(' ') ? text.substr(1) : text)};
}

struct RowReader {
  std::string_view name;
  ReadRow read;
};

constexpr std::array kReaders{
    RowReader{"MSG", read_text<Feedback>},
    RowReader{"GC", read_parser_state},
    RowReader{"G54", read_stored_offset},
    RowReader{"G55", read_stored_offset},
    RowReader{"G56", read_stored_offset},
    RowReader{"G57", read_stored_offset},
    RowReader{"G58", read_stored_offset},
    RowReader{"G59", read_stored_offset},
    RowReader{"G59.1", read_stored_offset},
    RowReader{"G59.2", read_stored_offset},
    RowReader{"G59.3", read_stored_offset},
    RowReader{"G28", read_stored_offset},
    RowReader{"G30", read_stored_offset},
    RowReader{"G92", read_stored_offset},
    RowReader{"HOME", read_home},
    RowReader{"TLO", read_values<ToolLengthOffset>},
    RowReader{"TLR", read_values<ToolLengthReference>},
    RowReader{"G51", read_values<ScaledAxes>},
    RowReader{"PRB", read_probe},
    RowReader{"T", read_tool},
    RowReader{"PARAM", read_parameter},
    RowReader{"VER", read_version},
    RowReader{"OPT", read_options},
    RowReader{"AXS", read_axes},
    RowReader{"NEWOPT", read_new_options},
    RowReader{"FIRMWARE", read_text<FirmwareName>},
    RowReader{"HLP", read_text<HelpRow>},
    RowReader{"echo", read_echo},
    RowReader{"ALARMCODE", read_code<AlarmCodeRow>},
    RowReader{"ALARM", read_code<AlarmCodeRow>},
    RowReader{"ERRORCODE", read_code<ErrorCodeRow>},
    RowReader{"ERROR", read_code<ErrorCodeRow>},
    RowReader{"SETTINGGROUP", read_setting_group},
    RowReader{"SETTING", read_setting},
    RowReader{"SETTINGDESCR", read_setting_description},
    RowReader{"FILE", read_file},
};

// [NAME:text]; only the last bracket ends it, as texts may hold some
Found read_bracketed(std::string_view line) {
  const std::optional<std::string_view> inside = between(line, "[", "]");
  if (!inside) return std::nullopt;
  const std::size_t colon = inside->find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  const std::string_view name = inside->substr(0, colon);
  const std::string_view text = inside->substr(colon + 1);
  for (const RowReader& reader : kReaders) {
    if (reader.name == name) return reader.read(name, text);
  }
  return BuildRow{string_of(name), string_of(text)};
}

// $110=500.000, $Homing/Enable=1, $N0=G54; help such as "$J=<gcode> - jog machine." is no setting
Found read_dollar(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || equals < 2) return std::nullopt;
  const std::string_view name = line.substr(1, equals - 1);
  const std::string_view value = line.substr(equals + 1);
  if (std::ranges::all_of(name, base::is_digit)) return SettingValue{string_of(name), string_of(value)};
  if (name.size() == 2 && name[0] == 'N' && base::is_digit(name[1]))
    return StartupLine{name[1] - '0', string_of(value)};
  const auto may_be_in_name = [](char letter) {
    const char upper = base::to_upper(letter);
    return base::is_digit(letter) || (upper >= 'A' && upper <= 'Z') || letter == '/' || letter == '_' || letter == '-';
  };
  if (!name.contains('/') || !std::ranges::all_of(name, may_be_in_name)) return std::nullopt;
  return SettingValue{string_of(name), string_of(value)};
}

// 110<tab>X-axis maximum rate<tab>mm/min<tab>float<tab>…
Found read_table_row(std::string_view line) {
  const std::size_t tab = line.find('\t');
  if (tab == std::string_view::npos) return std::nullopt;
  const std::optional<int> id = parse_int(line.substr(0, tab));
  if (!id || *id < 0) return std::nullopt;
  SettingTableRow row{.id = *id, .columns = {}};
  for (const std::string_view column : base::split(line.substr(tab + 1), '\t')) row.columns.emplace_back(column);
  return row;
}

// >G54G21:ok or >G99:error:20
Found read_startup_result(std::string_view line) {
  if (const auto block = between(line, ">", ":ok")) return StartupResult{string_of(*block), 0};
  constexpr std::string_view kError = ":error:";
  const std::size_t at = line.rfind(kError);
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const std::optional<int> code = parse_int(line.substr(at + kError.size()));
  if (!code || *code == 0) return std::nullopt;
  return StartupResult{string_of(line.substr(1, at - 1)), *code};
}

// error:20, error:20 in SD file at line 7, or error: text
Found read_error(std::string_view line) {
  constexpr std::string_view kInFile = " in SD file at line ";
  line.remove_prefix(std::string_view{"error:"}.size());
  if (line.size() > 1 && line.starts_with(' ')) return ErrorAnswer{ErrorAnswer::kUnnumbered, string_of(line.substr(1))};
  const std::size_t at = line.find(kInFile);
  const std::optional<int> code = parse_int(line.substr(0, at));
  if (!code || *code < 0) return std::nullopt;
  if (at == std::string_view::npos) return ErrorAnswer{*code, {}};
  const std::optional<std::int32_t> file_line = parse_int<std::int32_t>(line.substr(at + kInFile.size()));
  if (!file_line) return std::nullopt;
  return FileError{*code, *file_line};
}

Found read_line(std::string_view line) {
  if (line == "ok") return Ok{};
  if (line.starts_with("error:")) return read_error(line);
  if (line.starts_with("ALARM:")) {
    const std::optional<int> code = parse_int(line.substr(6));
    return code ? Found{AlarmRaised{*code}} : std::nullopt;
  }
  if (line.starts_with('<')) {
    std::optional<StatusReport> report = decode_status(line);
    return report ? Found{std::move(*report)} : std::nullopt;
  }
  if (line.starts_with('[')) return read_bracketed(line);
  if (line.starts_with('$')) return read_dollar(line);
  if (line.starts_with('>')) return read_startup_result(line);
  if (!line.empty() && base::is_digit(line.front())) return read_table_row(line);
  std::optional<Welcome> welcome = decode_welcome(line);
  return welcome ? Found{std::move(*welcome)} : std::nullopt;
}

// The word that starts `text`.
std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find(' '));
}

}  // namespace

// Grbl 1.1h ['$' for help]                     also grblHAL at compatibility level 1 and above
// GrblHAL 1.1f ['$' or '$HELP' for help]
// Rabbit GRBL v1.6.0 Build 20260315
// Grbl 3.7 [FluidNC v3.7.8 (wifi) '$' for help]   of the family, but none of ours
std::optional<Welcome> decode_welcome(std::string_view line) {
  const auto welcome = [&](Firmware firmware, std::string_view version) {
    return Welcome{firmware, string_of(version), string_of(line)};
  };
  if (const auto rest = between(line, "GrblHAL ", "")) return welcome(Firmware::GrblHal, first_word(*rest));
  if (const auto rest = between(line, "Rabbit GRBL", "")) {
    if (!rest->empty() && !rest->starts_with(' ')) return std::nullopt;
    std::string_view version = first_word(base::trim(*rest));
    if (version.starts_with('v')) version.remove_prefix(1);
    return welcome(Firmware::Rabbit, version);
  }
  const auto rest = between(line, "Grbl ", "");
  if (!rest || rest->empty() || !base::is_digit(rest->front())) return std::nullopt;
  const std::string_view version = first_word(*rest);
  const bool is_grbl = version.starts_with("1.1") && rest->contains("['$' for help]");
  return welcome(is_grbl ? Firmware::Grbl : Firmware::Unknown, version);
}

Message decode(std::string_view line) {
  Found found = read_line(line);
  // A blank behind a line (seen from bridges) changes nothing; texts keep theirs when the line reads as it is.
  if (!found && !line.empty() && base::is_blank(line.back())) found = read_line(base::trim(line));
  if (!found) return Unrecognized{string_of(line)};
  return std::move(*found);
}

}  // namespace kerf::protocol
