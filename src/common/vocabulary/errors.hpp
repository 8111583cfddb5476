#pragma once
// The numbers behind `error:` (protocol.md 8). Codes are only unique per firmware: 18, 39, 80 and 81 mean different
// things on Rabbit and grblHAL, so each sense has its own enumerator and its own row.

#include <optional>
#include <span>

#include "common/vocabulary/codes.hpp"

namespace kerf::vocabulary {

/// Union of the three firmwares. `Ok` is not an error.
enum class ErrorCode : int {
  Ok = 0,
  ExpectedCommandLetter = 1,
  BadNumberFormat = 2,
  InvalidStatement = 3,
  NegativeValue = 4,
  HomingDisabled = 5,
  StepPulseTooShort = 6,
  SettingReadFail = 7,
  IdleError = 8,
  SystemLocked = 9,
  SoftLimitNeedsHoming = 10,
  LineTooLong = 11,
  MaxStepRateExceeded = 12,
  CheckDoor = 13,
  StoredLineTooLong = 14,
  TravelExceeded = 15,
  InvalidJogCommand = 16,
  LaserNeedsPwm = 17,
  ResetAsserted = 18,     ///< grblHAL
  HomingNotDefined = 18,  ///< Rabbit
  NonPositiveValue = 19,
  UnsupportedCommand = 20,
  ModalGroupViolation = 21,
  UndefinedFeedRate = 22,
  CommandValueNotInteger = 23,
  AxisCommandConflict = 24,
  WordRepeated = 25,
  NoAxisWords = 26,
  InvalidLineNumber = 27,
  ValueWordMissing = 28,
  UnsupportedCoordinateSystem = 29,
  G53InvalidMotionMode = 30,
  AxisWordsExist = 31,
  NoAxisWordsInPlane = 32,
  InvalidTarget = 33,
  ArcRadiusError = 34,
  NoOffsetsInPlane = 35,
  UnusedWords = 36,
  G43DynamicAxisError = 37,
  IllegalToolNumber = 38,
  ValueOutOfRange = 39,     ///< grblHAL
  ParameterPTooLarge = 39,  ///< Rabbit
  ToolChangePending = 40,
  SpindleNotRunning = 41,
  IllegalPlane = 42,
  MaxFeedRateExceeded = 43,
  SpindleSpeedOutOfRange = 44,
  LimitsEngaged = 45,
  HomingRequired = 46,
  ToolUnknown = 47,
  ValueWordConflict = 48,
  SelfTestFailed = 49,
  EmergencyStop = 50,
  MotorFault = 51,
  SettingOutOfRange = 52,
  SettingDisabled = 53,
  InvalidRetractPosition = 54,
  IllegalHomingConfiguration = 55,
  CoordinateSystemLocked = 56,
  UnexpectedFileDemarcation = 57,
  PortNotAvailable = 58,
  CardMountFailed = 60,
  FileReadFailed = 61,
  DirectoryOpenFailed = 62,
  DirectoryNotFound = 63,
  CardNotMounted = 64,
  FileSystemNotMounted = 65,
  FileSystemReadOnly = 66,
  BluetoothInitFailed = 70,
  ExpressionUnknownOperation = 71,
  ExpressionDivideByZero = 72,
  ExpressionArgumentOutOfRange = 73,
  ExpressionInvalidArgument = 74,
  ExpressionSyntaxError = 75,
  ExpressionInvalidResult = 76,
  AuthenticationRequired = 77,
  AccessDenied = 78,
  NotAllowedInCriticalEvent = 79,
  FlowControlNotExecutingMacro = 80,  ///< grblHAL
  SettingNumberOutOfRange = 80,       ///< Rabbit
  FlowControlSyntaxError = 81,        ///< grblHAL
  SettingTextInvalid = 81,            ///< Rabbit
  FlowControlStackOverflow = 82,
  FlowControlOutOfMemory = 83,
  FileOpenFailed = 84,
  FormatFailed = 85,
  PortNotUsable = 86,
  ToolInSpindle = 87,
  NoToolInSpindle = 88,
  FileDeleteFailed = 89,
  CutterCompensationActive = 90,
  CutterCompensationConflict = 91,
  CutterCompensationInvalid = 92,
  StorageWriteFailed = 100,       ///< Rabbit
  StorageStatisticsFailed = 101,  ///< Rabbit
  AuthenticationFailed = 110,     ///< Rabbit
  EndOfLine = 111,                ///< Rabbit, internal marker
  UserDefined = 253,
};

[[nodiscard]] constexpr int number_of(ErrorCode code) {
  return static_cast<int>(code);
}

/// Every row of every firmware, sorted by code; a clashing code has one row a sense.
[[nodiscard]] std::span<const CodeRow> error_rows();
/// `firmware`'s own table, sorted, codes unique. For an unknown firmware: Grbl's.
[[nodiscard]] std::span<const CodeRow> error_rows(Firmware firmware);

}  // namespace kerf::vocabulary
