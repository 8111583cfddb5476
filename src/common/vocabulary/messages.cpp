#include "common/vocabulary/messages.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kGrbl = FirmwareSet::Grbl;
constexpr auto kRabbitAndHal = FirmwareSet::Rabbit | FirmwareSet::GrblHal;

// protocol.md 4 and 5
constexpr std::array kBrackets{
    BracketRow{"MSG", "text", "A message for the operator.", kAll},
    BracketRow{"GC", "words", "Modes in force: the answer to $G, or pushed.", kAll},
    BracketRow{"G54", "x,y,z", "Work coordinate system 1.", kAll},
    BracketRow{"G55", "x,y,z", "Work coordinate system 2.", kAll},
    BracketRow{"G56", "x,y,z", "Work coordinate system 3.", kAll},
    BracketRow{"G57", "x,y,z", "Work coordinate system 4.", kAll},
    BracketRow{"G58", "x,y,z", "Work coordinate system 5.", kAll},
    BracketRow{"G59", "x,y,z", "Work coordinate system 6.", kAll},
    BracketRow{"G59.1", "x,y,z", "Work coordinate system 7.", kHal},
    BracketRow{"G59.2", "x,y,z", "Work coordinate system 8.", kHal},
    BracketRow{"G59.3", "x,y,z", "Work coordinate system 9.", kHal},
    BracketRow{"G28", "x,y,z", "First stored position, machine coordinates.", kAll},
    BracketRow{"G30", "x,y,z", "Second stored position, machine coordinates.", kAll},
    BracketRow{"G92", "x,y,z", "Shift of the work coordinates.", kAll},
    BracketRow{"HOME", "x,y,z:mask", "Home position and which axes are homed.", kHal},
    BracketRow{"TLO", "z or x,y,z", "Tool length offset: one value, on grblHAL one an axis.", kAll},
    BracketRow{"TLR", "z", "Tool length reference.", kHal},
    BracketRow{"PRB", "x,y,z:0|1", "Where the last probing ended, and whether it made contact.", kAll},
    BracketRow{"G51", "x,y,z", "Scale factors.", kHal},
    BracketRow{"T", "id|offsets|radius|6,0,0|name|pocket", "A row of the tool table.", kHal},
    BracketRow{"PARAM", "n=value", "Value of a numbered or named parameter.", kHal},
    BracketRow{"VER", "version.build[:text]", "Version, build date and the user's text.", kAll},
    BracketRow{"OPT", "letters[,blocks,bytes[,axes,tools]]", "Build options and buffer sizes; letters only on Rabbit.",
               kAll},
    BracketRow{"AXS", "n:letters", "Number of axes and their letters.", kHal},
    BracketRow{"NEWOPT", "tokens", "What this build can do.", kHal},
    BracketRow{"FIRMWARE", "name", "The firmware's name.", kHal},
    BracketRow{"SIGNALS", "letters", "Control inputs that exist.", kHal},
    BracketRow{"SPINDLES", "n", "Number of spindles.", kHal},
    BracketRow{"NVS STORAGE", "[*]kind [nK]", "Settings memory; * if it is buffered in RAM.", kHal},
    BracketRow{"FREE MEMORY", "nK", "Memory that is left.", kHal},
    BracketRow{"DRIVER", "name[@nMHz]", "The board's driver and processor clock.", kHal},
    BracketRow{"DRIVER VERSION", "text", "Version of the driver.", kHal},
    BracketRow{"DRIVER OPTIONS", "text", "Options of the driver.", kHal},
    BracketRow{"BOARD", "text", "The board.", kHal},
    BracketRow{"MAX STEP RATE", "n Hz", "Fastest step rate.", kHal},
    BracketRow{"AUX IO", "din,dout,ain,aout", "Numbers of auxiliary inputs and outputs.", kHal},
    BracketRow{"PLUGIN", "name vX", "A plugin and its version.", kHal},
    BracketRow{"COMPATIBILITY LEVEL", "n", "Above 0: looks more like Grbl.", kHal},
    BracketRow{"IP", "address", "Network address.", kHal},
    BracketRow{"WIFI MAC", "address", "Hardware address.", kHal},
    BracketRow{"HLP", "text", "List of $ commands.", kAll},
    BracketRow{"echo", "line", "The line as received, in debug builds.", kGrbl},
    BracketRow{"ALARMCODE", "id|title|text", "An alarm, answer to $EA; the title is empty on grblHAL.", kRabbitAndHal},
    BracketRow{"ALARM", "id|title|text", "Another spelling of ALARMCODE.", kRabbitAndHal},
    BracketRow{"ERRORCODE", "id|title|text", "An error, answer to $EE; the title is empty on grblHAL.", kRabbitAndHal},
    BracketRow{"ERROR", "id|title|text", "Another spelling of ERRORCODE.", kRabbitAndHal},
    BracketRow{"SETTINGGROUP", "id|parent|name", "A group of settings, answer to $EG.", kHal},
    BracketRow{"SETTING", "id|group|name|unit|type|format|min|max|reboot|allow_null", "A setting, answer to $ES.",
               kHal},
    BracketRow{"SETTINGDESCR", "id|text", "What a setting does, answer to $SED=.", kHal},
    BracketRow{"SPINDLE", "id|num|type|flags|name|min,max", "A spindle, answer to $SPINDLESH.", kHal},
    BracketRow{"SPINDLEENCODER", "index,pulses,errors,angle", "The spindle encoder, answer to $SD.", kHal},
    BracketRow{"PID", "values", "Log of the spindle loop.", kHal},
    BracketRow{"FILE", "path|SIZE:n[|UNUSABLE]", "A file, answer to $F.", kHal},
    BracketRow{"FS", "name@path size, free", "A file system, answer to $FI.", kHal},
    BracketRow{"CWD", "path", "The directory in use, answer to $PWD.", kHal},
    BracketRow{"LASTEVENTS", "letters", "Control inputs that changed last, answer to $LEV.", kHal},
    BracketRow{"LIMITS", "letters", "Limit switches that are pressed, answer to $LIM.", kHal},
    BracketRow{"HOMES", "letters", "Homing switches that are pressed, answer to $HSS.", kHal},
};

// protocol.md 4.7, 1.3
constexpr std::array kFeedback{
    FeedbackRow{FeedbackText::ResetToContinue, "Reset to continue", "Reset to continue", "Reset to continue",
                "A critical alarm: only a reset helps."},
    FeedbackRow{FeedbackText::UnlockRequired, "'$H'|'$X' to unlock", "'$H'|'$X' to unlock", "'$H'|'$X' to unlock",
                "Started in alarm: home or unlock."},
    FeedbackRow{FeedbackText::Unlocked, "Caution: Unlocked", "Caution: Unlocked", "Caution: Unlocked",
                "The alarm was lifted without homing; the position may be wrong."},
    FeedbackRow{FeedbackText::Enabled, "Enabled", "", "Enabled", "A mode was switched on."},
    FeedbackRow{FeedbackText::Disabled, "Disabled", "", "Disabled", "A mode was switched off."},
    FeedbackRow{FeedbackText::CheckDoor, "Check Door", "Check door", "Check Door", "The safety door was opened."},
    FeedbackRow{FeedbackText::CheckLimits, "Check Limits", "Check limits", "Check Limits",
                "A limit switch is pressed at start."},
    FeedbackRow{FeedbackText::ProgramEnd, "Pgm End", "Program End", "Pgm End", "M2 or M30."},
    FeedbackRow{FeedbackText::RestoringDefaults, "Restoring defaults", "Restoring defaults", "Restoring defaults",
                "$RST= was obeyed."},
    FeedbackRow{FeedbackText::RestoringSpindle, "Restoring spindle", "Restoring spindle", "Restoring spindle",
                "The spindle comes back after a hold."},
    FeedbackRow{FeedbackText::Sleeping, "Sleeping", "Sleeping", "Sleeping", "$SLP was obeyed."},
    FeedbackRow{FeedbackText::EmergencyStop, "", "", "Emergency stop - clear, then reset to continue",
                "The emergency stop is pressed."},
    FeedbackRow{FeedbackText::MotorFault, "", "", "Motor fault - clear, then reset to continue",
                "A motor driver fault."},
    FeedbackRow{FeedbackText::HomingRequired, "", "", "Homing cycle required", "Home before use."},
    FeedbackRow{FeedbackText::Stop, "", "", "Stop", "The stop byte was obeyed."},
    FeedbackRow{FeedbackText::RerunJob, "", "", "Press cycle start to rerun job", "A file can be run again."},
    FeedbackRow{FeedbackText::ReferenceToolEstablished, "", "", "Reference tool length offset established",
                "The next tool is measured against this one."},
    FeedbackRow{FeedbackText::PressCycleStart, "", "", "Press cycle start to continue.", "The tool may be used now."},
    FeedbackRow{FeedbackText::RemoveTouchPlate, "", "", "Remove any touch plate and press cycle start to continue.",
                "The tool is measured."},
    FeedbackRow{FeedbackText::ProbeFailed, "", "", "Probe failed, try again.", "The tool was not measured."},
    FeedbackRow{FeedbackText::ProbeToolFirst, "", "", "Perform a probe with $TPW first!", "The tool must be measured."},
    FeedbackRow{FeedbackText::PositionForTouchOff, "", "", "Press cycle start to position for touch-off.",
                "The machine will move to the tool setter."},
    FeedbackRow{FeedbackText::ProbeProtected, "", "", "Probe protection activated.", "The probe was touched."},
    FeedbackRow{FeedbackText::TelnetActive, "", "", "TELNET STREAM ACTIVE", "Another client took over by telnet."},
    FeedbackRow{FeedbackText::WebSocketActive, "", "", "WEBSOCKET STREAM ACTIVE",
                "Another client took over by websocket."},
    FeedbackRow{FeedbackText::BluetoothActive, "", "", "BLUETOOTH STREAM ACTIVE",
                "Another client took over by Bluetooth."},
    FeedbackRow{FeedbackText::SerialActive, "", "", "SERIAL STREAM ACTIVE", "The serial port took over."},
    FeedbackRow{FeedbackText::ResetDuringFile, "", "",
                "Reset during streaming of file at line: ", "A reset ended a file job."},
    FeedbackRow{FeedbackText::FileJobTerminated, "", "", "Job terminated due to connection change",
                "The connection was lost or taken over during a file job."},
};

struct KindRow {
  FeedbackKind kind;
  std::string_view prefix;
};

constexpr std::array kKinds{
    KindRow{FeedbackKind::Info, "Info: "},
    KindRow{FeedbackKind::Warning, "Warning: "},
    KindRow{FeedbackKind::Error, "Error: "},
    KindRow{FeedbackKind::Debug, "Debug: "},
};

}  // namespace

std::span<const BracketRow> bracket_rows() {
  return kBrackets;
}

const BracketRow* find_bracket(std::string_view name) {
  const auto at = std::ranges::find(kBrackets, name, &BracketRow::name);
  return at == kBrackets.end() ? nullptr : &*at;
}

std::span<const FeedbackRow> feedback_rows() {
  return kFeedback;
}

std::string_view feedback_text(Firmware firmware, FeedbackText id) {
  const FeedbackRow& row = kFeedback.at(static_cast<std::size_t>(id));
  switch (firmware) {
    case Firmware::Rabbit: return row.rabbit;
    case Firmware::GrblHal: return row.grblhal;
    case Firmware::Grbl:
    case Firmware::Unknown: break;
  }
  return row.grbl;
}

std::optional<FeedbackText> feedback_of(std::string_view text) {
  const std::string_view plain = without_kind(text);
  if (plain.empty()) return std::nullopt;
  for (const FeedbackRow& row : kFeedback) {
    for (const std::string_view known : {row.grbl, row.rabbit, row.grblhal}) {
      if (base::iequals(known, plain)) return row.id;
      if (known.ends_with(": ") && base::starts_with_ignoring_case(plain, known)) return row.id;
    }
  }
  return std::nullopt;
}

FeedbackKind feedback_kind(std::string_view text) {
  const auto at = std::ranges::find_if(kKinds, [&](const KindRow& row) { return text.starts_with(row.prefix); });
  return at == kKinds.end() ? FeedbackKind::Plain : at->kind;
}

std::string_view without_kind(std::string_view text) {
  const auto at = std::ranges::find_if(kKinds, [&](const KindRow& row) { return text.starts_with(row.prefix); });
  return at == kKinds.end() ? text : text.substr(at->prefix.size());
}

}  // namespace kerf::vocabulary
