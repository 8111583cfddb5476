#pragma once
// The numbers behind `ALARM:` (protocol.md 8). 10 clashes: Grbl's and Rabbit's dual-axis failure, grblHAL's E-stop.

#include <span>

#include "common/vocabulary/codes.hpp"

namespace kerf::vocabulary {

/// Union of the three firmwares. `None` is no alarm.
enum class AlarmCode : int {
  None = 0,
  HardLimit = 1,
  SoftLimit = 2,
  AbortCycle = 3,
  ProbeFailInitial = 4,
  ProbeFailContact = 5,
  HomingFailReset = 6,
  HomingFailDoor = 7,
  HomingFailPulloff = 8,
  HomingFailApproach = 9,
  HomingFailDualApproach = 10,  ///< Grbl, Rabbit
  EmergencyStop = 10,           ///< grblHAL
  HomingRequired = 11,
  LimitsEngaged = 12,
  ProbeProtect = 13,
  SpindleAtSpeedTimeout = 14,
  HomingFailAutoSquaring = 15,
  SelfTestFailed = 16,
  MotorFault = 17,
  HomingFailConfiguration = 18,
  ModbusException = 19,
  ExpanderException = 20,
  StorageFailed = 21,
  BufferOverflow = 22,
};

[[nodiscard]] constexpr int number_of(AlarmCode code) {
  return static_cast<int>(code);
}

/// Every row of every firmware, sorted by code; a clashing code has one row a sense.
[[nodiscard]] std::span<const CodeRow> alarm_rows();
/// `firmware`'s own table, sorted, codes unique. For an unknown firmware: Grbl's.
[[nodiscard]] std::span<const CodeRow> alarm_rows(Firmware firmware);

}  // namespace kerf::vocabulary
