// <Hold:1|MPos:1.000,0.000,0.000|Bf:14,128|FS:250,12000|Pn:XP|WCO:0.000,0.000,0.000|Ov:100,100,100|A:SF>

#include <array>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "common/protocol/fields.hpp"

namespace kerf::protocol {
namespace {

// Each reader fills its field from the text behind the colon and says whether it could. A field that comes twice keeps
// its first value, so that the order of unknown and known fields cannot change what a report means.
using ReadField = bool (*)(StatusReport&, std::string_view);

template <auto Member>
bool read_numbers(StatusReport& report, std::string_view text) {
  if (report.*Member) return false;
  report.*Member = numbers_of(text);
  return (report.*Member).has_value();
}

template <auto Member>
bool read_int(StatusReport& report, std::string_view text) {
  if (report.*Member) return false;
  using Integer = typename std::remove_cvref_t<decltype(report.*Member)>::value_type;
  report.*Member = base::parse_int<Integer>(text);
  return (report.*Member).has_value();
}

template <auto Member>
bool read_flag(StatusReport& report, std::string_view text) {
  if (report.*Member) return false;
  report.*Member = flag_of(text);
  return (report.*Member).has_value();
}

template <auto Member>
bool read_text(StatusReport& report, std::string_view text) {
  if (report.*Member) return false;
  report.*Member = std::string{text};
  return true;
}

// Bf:15,128
bool read_buffer(StatusReport& report, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, ',');
  if (report.buffer || parts.size() != 2) return false;
  const std::optional<int> planner_blocks = base::parse_int(parts[0]);
  const std::optional<int> rx_bytes = base::parse_int(parts[1]);
  if (!planner_blocks || !rx_bytes) return false;
  report.buffer = BufferState{*planner_blocks, *rx_bytes};
  return true;
}

// F:250 of a build without variable spindle, FS:250,12000 or FS:250,12000,11980
bool read_speeds(StatusReport& report, std::string_view text, std::size_t fewest, std::size_t most) {
  if (report.feed_mm_per_min) return false;
  const std::optional<std::vector<double>> values = numbers_of(text);
  if (!values || values->size() < fewest || values->size() > most) return false;
  report.feed_mm_per_min = values->at(0);
  if (values->size() > 1) report.spindle_rpm = values->at(1);
  if (values->size() > 2) report.measured_rpm = values->at(2);
  return true;
}

// Ov:100,100,100
bool read_overrides(StatusReport& report, std::string_view text) {
  const std::vector<std::string_view> parts = base::split(text, ',');
  if (report.overrides || parts.size() != 3) return false;
  const std::optional<int> feed = base::parse_int(parts[0]);
  const std::optional<int> rapid = base::parse_int(parts[1]);
  const std::optional<int> spindle = base::parse_int(parts[2]);
  if (!feed || !rapid || !spindle) return false;
  report.overrides = Overrides{*feed, *rapid, *spindle};
  return true;
}

// H:1 or H:1,7
bool read_homed(StatusReport& report, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, ',', 2);
  const std::optional<bool> all = flag_of(parts[0]);
  if (report.homed || !all) return false;
  Homed homed{.homed = *all, .axis_mask = std::nullopt};
  if (parts.size() > 1) {
    homed.axis_mask = base::parse_int(parts[1]);
    if (!homed.axis_mask) return false;
  }
  report.homed = homed;
  return true;
}

// P:0 or P:0,P
bool read_probe(StatusReport& report, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, ',', 2);
  const std::optional<int> probe = base::parse_int(parts[0]);
  if (report.probe || !probe) return false;
  if (parts.size() > 1 && parts[1] != "P") return false;
  report.probe = ProbeState{.probe = *probe, .is_protected = parts.size() > 1};
  return true;
}

// AR:500
bool read_auto_report(StatusReport& report, std::string_view text) {
  const std::optional<int> period_ms = base::parse_int(text);
  if (report.auto_report_ms || !period_ms || *period_ms < 0) return false;
  report.auto_report_ms = period_ms;
  return true;
}

struct FieldReader {
  std::string_view name;
  ReadField read;
};

constexpr std::array kReaders{
    FieldReader{"MPos", read_numbers<&StatusReport::machine_position>},
    FieldReader{"WPos", read_numbers<&StatusReport::work_position>},
    FieldReader{"Bf", read_buffer},
    FieldReader{"Ln", read_int<&StatusReport::line_number>},
    FieldReader{"DTG", read_numbers<&StatusReport::distance_to_go>},
    FieldReader{"FS", [](StatusReport& report, std::string_view text) { return read_speeds(report, text, 2, 3); }},
    FieldReader{"F", [](StatusReport& report, std::string_view text) { return read_speeds(report, text, 1, 1); }},
    FieldReader{"S", read_int<&StatusReport::active_spindle>},
    FieldReader{"Pn", read_text<&StatusReport::pins>},
    FieldReader{"WCO", read_numbers<&StatusReport::work_offset>},
    FieldReader{"WCS", read_text<&StatusReport::wcs>},
    FieldReader{"Ov", read_overrides},
    FieldReader{"A", read_text<&StatusReport::accessories>},
    FieldReader{"Sc", read_text<&StatusReport::scaled_axes>},
    FieldReader{"AR", read_auto_report},
    FieldReader{"MPG", read_flag<&StatusReport::mpg>},
    FieldReader{"H", read_homed},
    FieldReader{"D", read_flag<&StatusReport::diameter>},
    FieldReader{"T", read_int<&StatusReport::tool>},
    FieldReader{"P", read_probe},
    FieldReader{"TLR", read_flag<&StatusReport::tlr>},
    FieldReader{"In", read_int<&StatusReport::input_result>},
    FieldReader{"FW", read_text<&StatusReport::firmware>},
    FieldReader{"$C", read_flag<&StatusReport::critical>},
};

// SP1:1000,,S,100: number in the name, measured speed never given, direction empty when off
bool read_extra_spindle(StatusReport& report, std::string_view name, std::string_view text) {
  if (!name.starts_with("SP")) return false;
  const std::optional<int> number = base::parse_int(name.substr(2));
  const std::vector<std::string_view> parts = base::split(text, ',');
  if (!number || parts.size() < 3 || parts.size() > 4 || !parts[1].empty()) return false;
  const std::optional<double> rpm = base::parse_decimal(parts[0]);
  if (!rpm) return false;
  ExtraSpindle spindle{*number, *rpm, std::string{parts[2]}, std::nullopt};
  if (parts.size() == 4) {
    spindle.override_percent = base::parse_int(parts[3]);
    if (!spindle.override_percent) return false;
  }
  report.extra_spindles.push_back(std::move(spindle));
  return true;
}

bool read_field(StatusReport& report, std::string_view name, std::string_view value) {
  for (const FieldReader& reader : kReaders) {
    if (reader.name == name) return reader.read(report, value);
  }
  return read_extra_spindle(report, name, value);
}

// Hold:1
void read_state(StatusReport& report, std::string_view text) {
  const std::vector<std::string_view> parts = base::split_at_most(text, ':', 2);
  const std::optional<MachineState> state = vocabulary::machine_state_of(parts[0]);
  if (state) report.state = *state;
  if (parts.size() > 1) report.substate = base::parse_int(parts[1]);
  const bool is_odd = !state || (parts.size() > 1 && !report.substate);
  if (!is_odd) return;
  report.substate.reset();
  report.odd_state = std::string{text};
}

}  // namespace

std::optional<StatusReport> decode_status(std::string_view line) {
  const std::optional<std::string_view> inside = between(line, "<", ">");
  if (!inside) return std::nullopt;
  const std::vector<std::string_view> parts = base::split(*inside, '|');
  StatusReport report;
  read_state(report, parts[0]);
  for (const std::string_view part : std::span{parts}.subspan(1)) {
    const std::size_t colon = part.find(':');
    const std::string_view name = part.substr(0, colon);
    const std::string_view value = colon == std::string_view::npos ? "" : part.substr(colon + 1);
    // A bare AR tells that auto report is set up but switched off.
    const bool is_bare_ar = part == "AR" && !report.auto_report_ms;
    if (is_bare_ar) report.auto_report_ms = 0;
    if (is_bare_ar || read_field(report, name, value)) continue;
    report.unknown.push_back({std::string{name}, std::string{value}});
  }
  // With a state that we do not know, a position is what tells a report from any other text in angle brackets.
  const bool has_position = report.machine_position || report.work_position;
  if (report.state == MachineState::Unknown && !has_position) return std::nullopt;
  return report;
}

}  // namespace kerf::protocol
