#pragma once
// The lines in square brackets, and the texts that `[MSG:` is known to carry (protocol.md 4).

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// The name between `[` and `:`.
struct BracketRow {
  std::string_view name;
  std::string_view syntax;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const BracketRow&, const BracketRow&) = default;
};
BOOST_DESCRIBE_STRUCT(BracketRow, (), (name, syntax, text, known_to))

[[nodiscard]] std::span<const BracketRow> bracket_rows();
[[nodiscard]] const BracketRow* find_bracket(std::string_view name);

/// Texts that the firmwares push as `[MSG:`.
enum class FeedbackText : std::uint8_t {
  ResetToContinue,
  UnlockRequired,
  Unlocked,
  Enabled,
  Disabled,
  CheckDoor,
  CheckLimits,
  ProgramEnd,
  RestoringDefaults,
  RestoringSpindle,
  Sleeping,
  EmergencyStop,
  MotorFault,
  HomingRequired,
  Stop,
  RerunJob,
  ReferenceToolEstablished,
  PressCycleStart,
  RemoveTouchPlate,
  ProbeFailed,
  ProbeToolFirst,
  PositionForTouchOff,
  ProbeProtected,
  TelnetActive,
  WebSocketActive,
  BluetoothActive,
  SerialActive,
  ResetDuringFile,
  FileJobTerminated,
};
BOOST_DESCRIBE_ENUM(FeedbackText, ResetToContinue, UnlockRequired, Unlocked, Enabled, Disabled, CheckDoor, CheckLimits,
                    ProgramEnd, RestoringDefaults, RestoringSpindle, Sleeping, EmergencyStop, MotorFault,
                    HomingRequired, Stop, RerunJob, ReferenceToolEstablished, PressCycleStart, RemoveTouchPlate,
                    ProbeFailed, ProbeToolFirst, PositionForTouchOff, ProbeProtected, TelnetActive, WebSocketActive,
                    BluetoothActive, SerialActive, ResetDuringFile, FileJobTerminated)

/// The literal text on each firmware (empty where it does not exist), and what it tells. A text that ends in `: ` is
/// followed by a number.
struct FeedbackRow {
  FeedbackText id{};
  std::string_view grbl;
  std::string_view rabbit;
  std::string_view grblhal;
  std::string_view text;
  friend constexpr bool operator==(const FeedbackRow&, const FeedbackRow&) = default;
};
BOOST_DESCRIBE_STRUCT(FeedbackRow, (), (id, grbl, rabbit, grblhal, text))

/// All rows, in enumerator order.
[[nodiscard]] std::span<const FeedbackRow> feedback_rows();
/// What `firmware` prints for `id`; empty if it has no such message. An unknown firmware speaks like Grbl.
[[nodiscard]] std::string_view feedback_text(Firmware firmware, FeedbackText id);
/// The message that `text` is, on any firmware: case does not count, nor does grblHAL's `Info: ` or `Warning: `.
[[nodiscard]] std::optional<FeedbackText> feedback_of(std::string_view text);

/// grblHAL's message types (report.c 238-268).
enum class FeedbackKind : std::uint8_t { Plain, Info, Warning, Error, Debug };
BOOST_DESCRIBE_ENUM(FeedbackKind, Plain, Info, Warning, Error, Debug)
[[nodiscard]] FeedbackKind feedback_kind(std::string_view text);
/// `text` without the prefix that names its kind.
[[nodiscard]] std::string_view without_kind(std::string_view text);

}  // namespace kerf::vocabulary
