#pragma once
// The realtime bytes: taken out of the stream by the receive interrupt, also in the middle of a line; never counted
// against the receive buffer, never answered with `ok` (protocol.md 2).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// Every realtime byte of the three firmwares. `...Alternate` are grblHAL's top-bit-set twins of printable bytes.
enum class Realtime : std::uint8_t {
  Exit = 0x03,
  Enquiry = 0x05,
  Reboot = 0x14,  ///< only directly after an ESC (0x1B)
  SoftReset = 0x18,
  Stop = 0x19,
  FeedHold = '!',
  StatusQuery = '?',
  CycleStart = '~',
  StatusQueryAlternate = 0x80,
  CycleStartAlternate = 0x81,
  FeedHoldAlternate = 0x82,
  ParserReport = 0x83,
  SafetyDoor = 0x84,
  JogCancel = 0x85,
  DebugReport = 0x86,
  FullStatus = 0x87,
  OptionalStopToggle = 0x88,
  SingleBlockToggle = 0x89,
  FanToggle = 0x8A,
  MpgModeToggle = 0x8B,
  AutoReportToggle = 0x8C,
  FeedOverrideReset = 0x90,
  FeedOverrideCoarsePlus = 0x91,
  FeedOverrideCoarseMinus = 0x92,
  FeedOverrideFinePlus = 0x93,
  FeedOverrideFineMinus = 0x94,
  RapidOverrideReset = 0x95,
  RapidOverrideMedium = 0x96,
  RapidOverrideLow = 0x97,
  RapidOverrideExtraLow = 0x98,
  SpindleOverrideReset = 0x99,
  SpindleOverrideCoarsePlus = 0x9A,
  SpindleOverrideCoarseMinus = 0x9B,
  SpindleOverrideFinePlus = 0x9C,
  SpindleOverrideFineMinus = 0x9D,
  SpindleStopToggle = 0x9E,
  FloodToggle = 0xA0,
  MistToggle = 0xA1,
  PidReport = 0xA2,
  ToolChangeAcknowledge = 0xA3,
  ProbeConnectedToggle = 0xA4,
  Macro0 = 0xB0,
  Macro1 = 0xB1,
  Macro2 = 0xB2,
  Macro3 = 0xB3,
  Macro4 = 0xB4,
  Macro5 = 0xB5,
  Macro6 = 0xB6,
  Macro7 = 0xB7,
};
BOOST_DESCRIBE_ENUM(Realtime, Exit, Enquiry, Reboot, SoftReset, Stop, FeedHold, StatusQuery, CycleStart,
                    StatusQueryAlternate, CycleStartAlternate, FeedHoldAlternate, ParserReport, SafetyDoor, JogCancel,
                    DebugReport, FullStatus, OptionalStopToggle, SingleBlockToggle, FanToggle, MpgModeToggle,
                    AutoReportToggle, FeedOverrideReset, FeedOverrideCoarsePlus, FeedOverrideCoarseMinus,
                    FeedOverrideFinePlus, FeedOverrideFineMinus, RapidOverrideReset, RapidOverrideMedium,
                    RapidOverrideLow, RapidOverrideExtraLow, SpindleOverrideReset, SpindleOverrideCoarsePlus,
                    SpindleOverrideCoarseMinus, SpindleOverrideFinePlus, SpindleOverrideFineMinus, SpindleStopToggle,
                    FloodToggle, MistToggle, PidReport, ToolChangeAcknowledge, ProbeConnectedToggle, Macro0, Macro1,
                    Macro2, Macro3, Macro4, Macro5, Macro6, Macro7)

/// One realtime byte: who acts on it, and what it does there.
struct RealtimeRow {
  Realtime byte{};
  std::string_view name;      ///< for people: "feed hold"
  std::string_view text;      ///< the effect and when it is legal
  FirmwareSet known_to{};     ///< who acts on it in a usual build
  FirmwareSet optional_in{};  ///< of those, where a build option, a driver or a plugin decides
  std::optional<Realtime> alternate_of;
  friend constexpr bool operator==(const RealtimeRow&, const RealtimeRow&) = default;
};
BOOST_DESCRIBE_STRUCT(RealtimeRow, (), (byte, name, text, known_to, optional_in, alternate_of))

/// All rows, sorted by byte.
[[nodiscard]] std::span<const RealtimeRow> realtime_rows();

/// The row of `byte`, if it is a realtime byte of any firmware.
[[nodiscard]] const RealtimeRow* find_realtime(std::uint8_t byte);

/// Set of byte values.
class RealtimeSet {
 public:
  constexpr RealtimeSet() = default;

  constexpr RealtimeSet& add(std::uint8_t byte) {
    words_[byte / 64U] |= std::uint64_t{1} << (byte % 64U);
    return *this;
  }
  constexpr RealtimeSet& add(Realtime byte) { return add(static_cast<std::uint8_t>(byte)); }
  /// Adds every value from `first` to `last`, both included.
  constexpr RealtimeSet& add_range(std::uint8_t first, std::uint8_t last) {
    for (unsigned byte = first; byte <= last; ++byte) add(static_cast<std::uint8_t>(byte));
    return *this;
  }
  [[nodiscard]] constexpr bool contains(std::uint8_t byte) const {
    return ((words_[byte / 64U] >> (byte % 64U)) & 1U) != 0;
  }
  [[nodiscard]] constexpr bool contains(Realtime byte) const { return contains(static_cast<std::uint8_t>(byte)); }
  friend constexpr bool operator==(const RealtimeSet&, const RealtimeSet&) = default;

 private:
  std::array<std::uint64_t, 4> words_{};
};

/// The bytes that `firmware` has an action for (those that it only drops are not in it).
[[nodiscard]] bool acts_on(Firmware firmware, Realtime byte);

}  // namespace kerf::vocabulary
