#pragma once
// The fields of a status report after the state (protocol.md 3.1).

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/report_mask.hpp"

namespace kerf::vocabulary {

/// Every field that a firmware core prints. `PluginFields` stands for the place where grblHAL's plugins add theirs.
enum class StatusField : std::uint8_t {
  MachinePosition,
  WorkPosition,
  Buffer,
  LineNumber,
  DistanceToGo,
  FeedAndSpeed,
  Feed,
  ExtraSpindle,
  ActiveSpindle,
  Pins,
  WorkOffset,
  WorkCoordinateSystem,
  Overrides,
  Accessories,
  Scaling,
  AutoReport,
  Mpg,
  Homed,
  Diameter,
  Tool,
  Probe,
  ToolLengthReference,
  InputResult,
  PluginFields,
  FirmwareName,
  CriticalEvent,
};
BOOST_DESCRIBE_ENUM(StatusField, MachinePosition, WorkPosition, Buffer, LineNumber, DistanceToGo, FeedAndSpeed, Feed,
                    ExtraSpindle, ActiveSpindle, Pins, WorkOffset, WorkCoordinateSystem, Overrides, Accessories,
                    Scaling, AutoReport, Mpg, Homed, Diameter, Tool, Probe, ToolLengthReference, InputResult,
                    PluginFields, FirmwareName, CriticalEvent)

struct StatusFieldRow {
  StatusField field{};
  std::string_view name;    ///< as on the wire, without the colon; "SP" takes a number; empty for `PluginFields`
  std::string_view syntax;  ///< of the value
  std::string_view text;    ///< what it tells and when it is sent
  FirmwareSet known_to{};
  std::optional<ReportBit> needs;  ///< the `$10` bit that it depends on
  friend constexpr bool operator==(const StatusFieldRow&, const StatusFieldRow&) = default;
};
BOOST_DESCRIBE_STRUCT(StatusFieldRow, (), (field, name, syntax, text, known_to, needs))

/// All rows, in enumerator order.
[[nodiscard]] std::span<const StatusFieldRow> status_field_rows();
[[nodiscard]] const StatusFieldRow& row_of(StatusField field);

/// A field that a grblHAL plugin adds; kept as unknown fields in a decoded report.
struct PluginFieldRow {
  std::string_view name;
  std::string_view text;
  friend constexpr bool operator==(const PluginFieldRow&, const PluginFieldRow&) = default;
};
BOOST_DESCRIBE_STRUCT(PluginFieldRow, (), (name, text))

[[nodiscard]] std::span<const PluginFieldRow> plugin_field_rows();

/// Grbl 1.1h and Rabbit: position, Bf, Ln, FS, Pn, WCO, Ov, A (gnea/grbl report.c 466-654).
inline constexpr std::array kGrblFieldOrder{
    StatusField::MachinePosition, StatusField::WorkPosition, StatusField::Buffer, StatusField::LineNumber,
    StatusField::FeedAndSpeed,    StatusField::Feed,         StatusField::Pins,   StatusField::WorkOffset,
    StatusField::Overrides,       StatusField::Accessories,
};

/// grblHAL's order (report.c 1205-1616).
inline constexpr std::array kGrblHalFieldOrder{
    StatusField::MachinePosition,
    StatusField::WorkPosition,
    StatusField::Buffer,
    StatusField::LineNumber,
    StatusField::DistanceToGo,
    StatusField::FeedAndSpeed,
    StatusField::Feed,
    StatusField::ExtraSpindle,
    StatusField::ActiveSpindle,
    StatusField::Pins,
    StatusField::WorkOffset,
    StatusField::WorkCoordinateSystem,
    StatusField::Overrides,
    StatusField::Accessories,
    StatusField::Scaling,
    StatusField::AutoReport,
    StatusField::Mpg,
    StatusField::Homed,
    StatusField::Diameter,
    StatusField::Tool,
    StatusField::Probe,
    StatusField::ToolLengthReference,
    StatusField::InputResult,
    StatusField::PluginFields,
    StatusField::FirmwareName,
    StatusField::CriticalEvent,
};

[[nodiscard]] constexpr std::span<const StatusField> grbl_field_order() {
  return kGrblFieldOrder;
}
[[nodiscard]] constexpr std::span<const StatusField> grblhal_field_order() {
  return kGrblHalFieldOrder;
}

}  // namespace kerf::vocabulary
