#pragma once
// Everything that Kerf believes about the machine at one instant, as one value.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/protocol/message.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/machine_state.hpp"

namespace kerf::machine {

/// Override percentages as the controller reports them (`Ov:feed,rapid,spindle`).
struct OverridePercentages {
  int feed = 100;
  int rapid = 100;
  int spindle = 100;
  bool operator==(const OverridePercentages&) const = default;
};
BOOST_DESCRIBE_STRUCT(OverridePercentages, (), (feed, rapid, spindle))

/// Result of the last probing move: where the probe touched (machine coordinates, mm), and whether it touched at all.
struct ProbeContact {
  std::vector<double> position_mm;
  bool touched = false;
  bool operator==(const ProbeContact&) const = default;
};
BOOST_DESCRIBE_STRUCT(ProbeContact, (), (position_mm, touched))

/// A value of the machine's state as last told. An empty optional means "never told", not zero. Positions hold one
/// number for each axis that the controller prints, always in mm (`$13` is undone by MachineModel).
struct Snapshot {
  vocabulary::MachineState state = vocabulary::MachineState::Unknown;
  std::optional<int> substate;

  /// Machine position, work position and the offset between them: work = machine - offset (protocol.md 11, rule 9).
  std::optional<std::vector<double>> machine_position_mm;
  std::optional<std::vector<double>> work_position_mm;
  std::optional<std::vector<double>> work_offset_mm;

  std::optional<int> planner_blocks_free;
  std::optional<int> rx_bytes_free;
  std::optional<long> line_number;
  std::optional<double> feed_mm_per_min;
  std::optional<double> spindle_rpm;
  std::optional<double> measured_rpm;

  /// Letters of the active inputs (`Pn:`); empty when none is active.
  std::string pins;
  std::optional<OverridePercentages> overrides;
  /// Letters of what is switched on (`A:`): S, C, F, M, T.
  std::optional<std::string> accessories;
  std::optional<std::string> work_coordinate_system;
  std::optional<int> tool;
  std::optional<bool> homed;
  std::optional<vocabulary::AxisMask> homed_axes;
  /// A pendant has the machine (`MPG:1`): Kerf may read but sends no lines (protocol.md 1.5).
  bool pendant_in_control = false;
  /// File that the controller itself is running, as it says (`SD:`); empty when none.
  std::string controller_file;
  /// Period of reports that come unasked (`AR:`), ms; 0 when off.
  int auto_report_ms = 0;

  /// Words of `[GC:]`, in printed order.
  std::vector<std::string> parser_words;
  /// `[G54:]` … `[G59.3:]`, `[G28:]`, `[G30:]`, `[G92:]` in mm.
  std::map<std::string, std::vector<double>> offsets_mm;
  std::optional<std::vector<double>> tool_length_offset_mm;
  std::optional<ProbeContact> probe;

  /// Last alarm that has not been cleared.
  std::optional<int> alarm_code;
  /// Only a reset helps (protocol.md 6.6).
  bool reset_required = false;
  /// Positions are reported in inches (`$13=1`); Kerf has already converted them.
  bool reports_inches = false;

  /// Last messages for the operator, newest last, at most kMessagesKept.
  std::vector<std::string> messages;
  /// Fields of the last report that Kerf does not know.
  std::vector<protocol::UnknownField> other_fields;

  /// When the last status report came in. How stale the rest is, is now minus this.
  std::optional<Instant> reported_at;
  /// Number of status reports so far.
  std::uint64_t reports = 0;

  bool operator==(const Snapshot&) const = default;
};
BOOST_DESCRIBE_STRUCT(Snapshot, (),
                      (state, substate, machine_position_mm, work_position_mm, work_offset_mm, planner_blocks_free,
                       rx_bytes_free, line_number, feed_mm_per_min, spindle_rpm, measured_rpm, pins, overrides,
                       accessories, work_coordinate_system, tool, homed, homed_axes, pendant_in_control,
                       controller_file, auto_report_ms, parser_words, offsets_mm, tool_length_offset_mm, probe,
                       alarm_code, reset_required, reports_inches, messages, other_fields, reported_at, reports))

inline constexpr std::size_t kMessagesKept = 20;

}  // namespace kerf::machine
