#pragma once
// The bits of `$10`, the status report options (protocol.md 3.5).

#include <cstdint>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// Bit numbers of `$10`. Grbl and Rabbit know the first two, the others are grblHAL's.
enum class ReportBit : std::uint8_t {
  MachinePosition,
  BufferState,
  LineNumbers,
  FeedAndSpeed,
  PinState,
  WorkOffset,
  Overrides,
  ProbeCoordinates,
  SyncOnWorkOffsetChange,
  ParserState,
  AlarmSubstate,
  RunSubstate,
  ReportWhenHoming,
  DistanceToGo,
};
BOOST_DESCRIBE_ENUM(ReportBit, MachinePosition, BufferState, LineNumbers, FeedAndSpeed, PinState, WorkOffset, Overrides,
                    ProbeCoordinates, SyncOnWorkOffsetChange, ParserState, AlarmSubstate, RunSubstate, ReportWhenHoming,
                    DistanceToGo)

[[nodiscard]] constexpr std::uint32_t mask_of(ReportBit bit) {
  return std::uint32_t{1} << static_cast<unsigned>(bit);
}
[[nodiscard]] constexpr bool has(std::uint32_t report_mask, ReportBit bit) {
  return (report_mask & mask_of(bit)) != 0;
}

struct ReportBitRow {
  ReportBit bit{};
  std::string_view name;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const ReportBitRow&, const ReportBitRow&) = default;
};
BOOST_DESCRIBE_STRUCT(ReportBitRow, (), (bit, name, text, known_to))

/// All rows, in bit order.
[[nodiscard]] std::span<const ReportBitRow> report_bit_rows();

}  // namespace kerf::vocabulary
