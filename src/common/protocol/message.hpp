#pragma once
// Every line that a controller sends, as a value (protocol.md 3 to 5). `decode` makes them from text, `encode` prints
// them; nothing here knows a state or a history.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/machine_state.hpp"

namespace kerf::protocol {

using vocabulary::Firmware;
using vocabulary::MachineState;

/// `ok`
struct Ok {
  friend bool operator==(const Ok&, const Ok&) = default;
};

/// `error:20`, or `error: Bad number format` from a Rabbit GRBL that is set to verbose errors (and from Grbl 0.9): then
/// `code` is `kUnnumbered` and `text` is what was printed.
struct ErrorAnswer {
  static constexpr int kUnnumbered = -1;
  int code{};
  std::string text{};
  friend bool operator==(const ErrorAnswer&, const ErrorAnswer&) = default;
};

/// `error:20 in SD file at line 7`: a push, never an answer; the answer follows as `error:20`.
struct FileError {
  int code{};
  std::int32_t line{};
  friend bool operator==(const FileError&, const FileError&) = default;
};

/// `ALARM:1`
struct AlarmRaised {
  int code{};
  friend bool operator==(const AlarmRaised&, const AlarmRaised&) = default;
};

/// `Bf:15,128`: what is free.
struct BufferState {
  int planner_blocks{};
  int rx_bytes{};
  friend bool operator==(const BufferState&, const BufferState&) = default;
};

/// `Ov:100,100,100`, in percent.
struct Overrides {
  int feed_percent = 100;
  int rapid_percent = 100;
  int spindle_percent = 100;
  friend bool operator==(const Overrides&, const Overrides&) = default;
};

/// `H:1` or `H:1,7`: all axes that have to be homed are; the mask of those that are, if the controller tells.
struct Homed {
  bool homed{};
  std::optional<int> axis_mask{};
  friend bool operator==(const Homed&, const Homed&) = default;
};

/// `P:0` or `P:0,P`: the probe in use, and whether it is protected against a crash right now.
struct ProbeState {
  int probe{};
  bool is_protected{};
  friend bool operator==(const ProbeState&, const ProbeState&) = default;
};

/// `SP1:1000,,S,100`: another spindle that runs beside the first. `direction` is `S`, `C` or empty (off).
struct ExtraSpindle {
  int number{};
  double spindle_rpm{};
  std::string direction{};
  std::optional<int> override_percent{};
  friend bool operator==(const ExtraSpindle&, const ExtraSpindle&) = default;
};

/// A field that nobody here knows, or whose value is not what its name promises.
struct UnknownField {
  std::string name{};
  std::string value{};
  friend bool operator==(const UnknownField&, const UnknownField&) = default;
};

/// `<Idle|MPos:0.000,0.000,0.000|FS:0,0>`; absent fields were not in the report. Positions and feed are in the units
/// that `$13` chose, in axis order.
struct StatusReport {
  MachineState state = MachineState::Unknown;
  std::optional<int> substate{};
  /// The state as printed, where it is not a name that we know with an optional number.
  std::string odd_state{};
  std::optional<std::vector<double>> machine_position{};
  std::optional<std::vector<double>> work_position{};
  std::optional<BufferState> buffer{};
  std::optional<std::int32_t> line_number{};
  std::optional<std::vector<double>> distance_to_go{};
  std::optional<double> feed_mm_per_min{};  ///< in inches per minute if `$13` is 1
  std::optional<double> spindle_rpm{};      ///< absent with `F:`, a build without variable spindle
  std::optional<double> measured_rpm{};
  std::vector<ExtraSpindle> extra_spindles{};
  std::optional<int> active_spindle{};
  std::optional<std::string> pins{};
  std::optional<std::vector<double>> work_offset{};
  std::optional<std::string> wcs{};
  std::optional<Overrides> overrides{};
  std::optional<std::string> accessories{};  ///< may be empty: all off
  std::optional<std::string> scaled_axes{};
  std::optional<int> auto_report_ms{};  ///< 0 for a bare `AR`: configured but switched off
  std::optional<bool> mpg{};
  std::optional<Homed> homed{};
  std::optional<bool> diameter{};
  std::optional<int> tool{};
  std::optional<ProbeState> probe{};
  std::optional<bool> tlr{};
  std::optional<int> input_result{};
  std::optional<std::string> firmware{};
  std::optional<bool> critical{};
  std::vector<UnknownField> unknown{};
  friend bool operator==(const StatusReport&, const StatusReport&) = default;
};

/// `Grbl 1.1h ['$' for help]`. `line` is what was printed; the other two are read from it.
struct Welcome {
  Firmware firmware = Firmware::Unknown;  ///< Unknown: of the family, but none of the three
  std::string version{};                  ///< "1.1h"
  std::string line{};
  friend bool operator==(const Welcome&, const Welcome&) = default;
};

/// `$110=500.000` or `$Homing/Enable=1`: `id` is "110" or "Homing/Enable".
struct SettingValue {
  std::string id{};
  std::string value{};
  friend bool operator==(const SettingValue&, const SettingValue&) = default;
};

/// `$N0=G54G21`
struct StartupLine {
  int index{};
  std::string block{};
  friend bool operator==(const StartupLine&, const StartupLine&) = default;
};

/// `>G54G21:ok` or `>G99:error:20`; `error_code` 0 is ok.
struct StartupResult {
  std::string block{};
  int error_code{};
  friend bool operator==(const StartupResult&, const StartupResult&) = default;
};

/// `[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]`
struct ParserState {
  std::vector<std::string> words{};
  friend bool operator==(const ParserState&, const ParserState&) = default;
};

/// `[G54:0.000,0.000,0.000]`; names G54 to G59.3, G28, G30, G92.
struct StoredOffset {
  std::string name{};
  std::vector<double> values{};
  friend bool operator==(const StoredOffset&, const StoredOffset&) = default;
};

/// `[HOME:0.000,0.000,0.000:7]`
struct HomePosition {
  std::vector<double> values{};
  int axis_mask{};
  friend bool operator==(const HomePosition&, const HomePosition&) = default;
};

/// `[TLO:0.000]` (Grbl, Rabbit) or one value an axis (grblHAL).
struct ToolLengthOffset {
  std::vector<double> values{};
  friend bool operator==(const ToolLengthOffset&, const ToolLengthOffset&) = default;
};

/// `[TLR:12.000]`
struct ToolLengthReference {
  std::vector<double> values{};
  friend bool operator==(const ToolLengthReference&, const ToolLengthReference&) = default;
};

/// `[PRB:0.000,0.000,-4.072:1]`, machine coordinates.
struct ProbeResult {
  std::vector<double> values{};
  bool success{};
  friend bool operator==(const ProbeResult&, const ProbeResult&) = default;
};

/// `[T:1|1.000,2.000,3.000|0.500|6,0,0|name|1]`. `geometry` is kept as printed.
struct ToolRow {
  int tool{};
  std::vector<double> offsets{};
  double radius{};
  std::string geometry{};
  std::string name{};
  std::string pocket{};
  friend bool operator==(const ToolRow&, const ToolRow&) = default;
};

/// `[G51:1.000,2.000,1.000]`: scale factors.
struct ScaledAxes {
  std::vector<double> factors{};
  friend bool operator==(const ScaledAxes&, const ScaledAxes&) = default;
};

/// `[PARAM:5220=1]` or `[PARAM:_vmajor=1.1]`
struct NamedParameter {
  std::string name{};
  std::string value{};
  friend bool operator==(const NamedParameter&, const NamedParameter&) = default;
};

/// `[VER:1.1f.20260817:user text]`; Rabbit's row has no place for a text.
struct Version {
  std::string version{};
  std::string build{};
  std::string user_text{};
  bool has_user_text{};
  friend bool operator==(const Version&, const Version&) = default;
};

/// `[OPT:VNML+,100,1024,3,0]`; Rabbit prints letters only.
struct BuildOptions {
  std::string letters{};
  std::optional<int> planner_blocks{};
  std::optional<int> rx_bytes{};
  std::optional<int> axes{};
  std::optional<int> tools{};
  friend bool operator==(const BuildOptions&, const BuildOptions&) = default;
};

/// `[AXS:3:XYZ]`
struct AxisNames {
  int count{};
  std::string letters{};
  friend bool operator==(const AxisNames&, const AxisNames&) = default;
};

/// `[NEWOPT:ENUMS,RT+,TC,SED]`
struct NewOptions {
  std::vector<std::string> flags{};
  friend bool operator==(const NewOptions&, const NewOptions&) = default;
};

/// `[FIRMWARE:grblHAL]`
struct FirmwareName {
  std::string name{};
  friend bool operator==(const FirmwareName&, const FirmwareName&) = default;
};

/// `[BOARD:x]`, `[NVS STORAGE:*EEPROM]`, `[LIMITS:,,,]`: every `[KEY:value]` that has no type of its own.
struct BuildRow {
  std::string key{};
  std::string value{};
  friend bool operator==(const BuildRow&, const BuildRow&) = default;
};

/// `[MSG:Caution: Unlocked]`; the text may be empty and may contain `]`.
struct Feedback {
  std::string text{};
  friend bool operator==(const Feedback&, const Feedback&) = default;
};

/// `[HLP:$$ $# $G]`
struct HelpRow {
  std::string text{};
  friend bool operator==(const HelpRow&, const HelpRow&) = default;
};

/// `[echo: G0X1]` of debug builds.
struct Echo {
  std::string text{};
  friend bool operator==(const Echo&, const Echo&) = default;
};

/// `[ALARMCODE:1|title|text]`, also spelled `[ALARM:`; grblHAL leaves the title empty.
struct AlarmCodeRow {
  int id{};
  std::string title{};
  std::string text{};
  friend bool operator==(const AlarmCodeRow&, const AlarmCodeRow&) = default;
};

/// `[ERRORCODE:1|title|text]`, also spelled `[ERROR:`.
struct ErrorCodeRow {
  int id{};
  std::string title{};
  std::string text{};
  friend bool operator==(const ErrorCodeRow&, const ErrorCodeRow&) = default;
};

/// `[SETTINGGROUP:43|42|X-axis]`
struct SettingGroupRow {
  int id{};
  int parent{};
  std::string name{};
  friend bool operator==(const SettingGroupRow&, const SettingGroupRow&) = default;
};

/// `[SETTING:110|43|X-axis maximum rate|mm/min|6|#####0.000|||0|0]`
struct SettingDefinition {
  int id{};
  int group{};
  std::string name{};
  std::string unit{};
  int type{};
  std::string format{};
  std::string min{};
  std::string max{};
  bool reboot{};
  bool allow_null{};
  friend bool operator==(const SettingDefinition&, const SettingDefinition&) = default;
};

/// `[SETTINGDESCR:110|text]`; line breaks are the two characters `\n`.
struct SettingDescription {
  int id{};
  std::string text{};
  friend bool operator==(const SettingDescription&, const SettingDescription&) = default;
};

/// A row of `$ESH`: columns separated by tabs, the id first. `columns` are the others: name, unit, type, format,
/// description, min, max, reboot, allow null. A description may hold a line feed: then the rest of the row is a line of
/// its own, which is Unrecognized.
struct SettingTableRow {
  int id{};
  std::vector<std::string> columns{};
  friend bool operator==(const SettingTableRow&, const SettingTableRow&) = default;
};

/// `[FILE:/part.nc|SIZE:1234]`, `|UNUSABLE` behind; a directory has size -1.
struct FileRow {
  std::string path{};
  std::int64_t size_bytes{};
  bool unusable{};
  friend bool operator==(const FileRow&, const FileRow&) = default;
};

/// Anything else: shown and logged, never acted on.
struct Unrecognized {
  std::string line{};
  friend bool operator==(const Unrecognized&, const Unrecognized&) = default;
};

using Message =
    std::variant<Ok, ErrorAnswer, FileError, AlarmRaised, StatusReport, Welcome, SettingValue, StartupLine,
                 StartupResult, ParserState, StoredOffset, HomePosition, ToolLengthOffset, ToolLengthReference,
                 ProbeResult, ToolRow, ScaledAxes, NamedParameter, Version, BuildOptions, AxisNames, NewOptions,
                 FirmwareName, BuildRow, Feedback, HelpRow, Echo, AlarmCodeRow, ErrorCodeRow, SettingGroupRow,
                 SettingDefinition, SettingDescription, SettingTableRow, FileRow, Unrecognized>;

BOOST_DESCRIBE_STRUCT(Ok, (), ())
BOOST_DESCRIBE_STRUCT(ErrorAnswer, (), (code, text))
BOOST_DESCRIBE_STRUCT(FileError, (), (code, line))
BOOST_DESCRIBE_STRUCT(AlarmRaised, (), (code))
BOOST_DESCRIBE_STRUCT(BufferState, (), (planner_blocks, rx_bytes))
BOOST_DESCRIBE_STRUCT(Overrides, (), (feed_percent, rapid_percent, spindle_percent))
BOOST_DESCRIBE_STRUCT(Homed, (), (homed, axis_mask))
BOOST_DESCRIBE_STRUCT(ProbeState, (), (probe, is_protected))
BOOST_DESCRIBE_STRUCT(ExtraSpindle, (), (number, spindle_rpm, direction, override_percent))
BOOST_DESCRIBE_STRUCT(UnknownField, (), (name, value))
BOOST_DESCRIBE_STRUCT(StatusReport, (),
                      (state, substate, odd_state, machine_position, work_position, buffer, line_number, distance_to_go,
                       feed_mm_per_min, spindle_rpm, measured_rpm, extra_spindles, active_spindle, pins, work_offset,
                       wcs, overrides, accessories, scaled_axes, auto_report_ms, mpg, homed, diameter, tool, probe, tlr,
                       input_result, firmware, critical, unknown))
BOOST_DESCRIBE_STRUCT(Welcome, (), (firmware, version, line))
BOOST_DESCRIBE_STRUCT(SettingValue, (), (id, value))
BOOST_DESCRIBE_STRUCT(StartupLine, (), (index, block))
BOOST_DESCRIBE_STRUCT(StartupResult, (), (block, error_code))
BOOST_DESCRIBE_STRUCT(ParserState, (), (words))
BOOST_DESCRIBE_STRUCT(StoredOffset, (), (name, values))
BOOST_DESCRIBE_STRUCT(HomePosition, (), (values, axis_mask))
BOOST_DESCRIBE_STRUCT(ToolLengthOffset, (), (values))
BOOST_DESCRIBE_STRUCT(ToolLengthReference, (), (values))
BOOST_DESCRIBE_STRUCT(ProbeResult, (), (values, success))
BOOST_DESCRIBE_STRUCT(ToolRow, (), (tool, offsets, radius, geometry, name, pocket))
BOOST_DESCRIBE_STRUCT(ScaledAxes, (), (factors))
BOOST_DESCRIBE_STRUCT(NamedParameter, (), (name, value))
BOOST_DESCRIBE_STRUCT(Version, (), (version, build, user_text, has_user_text))
BOOST_DESCRIBE_STRUCT(BuildOptions, (), (letters, planner_blocks, rx_bytes, axes, tools))
BOOST_DESCRIBE_STRUCT(AxisNames, (), (count, letters))
BOOST_DESCRIBE_STRUCT(NewOptions, (), (flags))
BOOST_DESCRIBE_STRUCT(FirmwareName, (), (name))
BOOST_DESCRIBE_STRUCT(BuildRow, (), (key, value))
BOOST_DESCRIBE_STRUCT(Feedback, (), (text))
BOOST_DESCRIBE_STRUCT(HelpRow, (), (text))
BOOST_DESCRIBE_STRUCT(Echo, (), (text))
BOOST_DESCRIBE_STRUCT(AlarmCodeRow, (), (id, title, text))
BOOST_DESCRIBE_STRUCT(ErrorCodeRow, (), (id, title, text))
BOOST_DESCRIBE_STRUCT(SettingGroupRow, (), (id, parent, name))
BOOST_DESCRIBE_STRUCT(SettingDefinition, (), (id, group, name, unit, type, format, min, max, reboot, allow_null))
BOOST_DESCRIBE_STRUCT(SettingDescription, (), (id, text))
BOOST_DESCRIBE_STRUCT(SettingTableRow, (), (id, columns))
BOOST_DESCRIBE_STRUCT(FileRow, (), (path, size_bytes, unusable))
BOOST_DESCRIBE_STRUCT(Unrecognized, (), (line))

/// True for the two messages that answer a line. Everything else is pushed or comes before the answer.
[[nodiscard]] inline bool is_answer(const Message& message) {
  return std::holds_alternative<Ok>(message) || std::holds_alternative<ErrorAnswer>(message);
}

/// The type's name, such as "StatusReport".
[[nodiscard]] std::string_view name_of(const Message& message);

}  // namespace kerf::protocol
