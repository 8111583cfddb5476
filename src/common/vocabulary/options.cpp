#include "common/vocabulary/options.hpp"

#include <algorithm>
#include <array>

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kRabbit = FirmwareSet::Rabbit;
constexpr auto kGrbl = FirmwareSet::Grbl;
constexpr auto kGrblAndHal = FirmwareSet::Grbl | FirmwareSet::GrblHal;
constexpr auto kGrblAndRabbit = FirmwareSet::Grbl | FirmwareSet::Rabbit;

// protocol.md 4.5. In grblHAL most letters follow the settings of the moment instead of the build.
constexpr std::array kOptions{
    OptionRow{'V', "variable spindle", "S words set a speed.", kGrblAndHal},
    OptionRow{'N', "line numbers", "N words are reported.", kGrblAndHal},
    OptionRow{'M', "mist coolant", "M7 works.", kAll},
    OptionRow{'C', "CoreXY", "Two motors drive X and Y together.", kGrblAndHal},
    OptionRow{'P', "parking", "The spindle is lifted away when the door opens.", kAll},
    OptionRow{'Z', "homing sets zero", "The switches' place is machine zero.", kGrblAndHal},
    OptionRow{'H', "single-axis homing", "$HX, $HY and so on work.", kAll},
    OptionRow{'T', "two switches an axis", "Both ends of an axis share an input.", kGrblAndHal},
    OptionRow{'L', "two switches an axis", "Both ends of an axis share an input.", kRabbit},
    OptionRow{'L', "no lock at power-up", "The machine starts without asking for homing.", kGrblAndHal},
    OptionRow{'A', "feed override while probing", "Feed overrides act on probing moves.", kAll},
    OptionRow{'D', "direction pin enables", "The spindle's direction output switches it on.", kGrblAndHal},
    OptionRow{'0', "spindle off at zero speed", "S0 switches the spindle off.", kGrblAndHal},
    OptionRow{'S', "software debounce", "Limit switches are read twice.", kGrblAndHal},
    OptionRow{'R', "parking override", "M56 switches parking on and off.", kAll},
    OptionRow{'+', "safety door", "There is an input for a safety door.", kGrblAndHal},
    OptionRow{'*', "no restore of everything", "$RST=* is switched off.", kAll},
    OptionRow{'$', "no restore of settings", "$RST=$ is switched off.", kAll},
    OptionRow{'#', "no restore of offsets", "$RST=# is switched off.", kAll},
    OptionRow{'I', "no build text", "$I= is switched off.", kGrblAndHal},
    OptionRow{'E', "no wait before storing", "Settings are stored while the machine moves.", kGrblAndRabbit},
    OptionRow{'W', "no wait before offset changes", "Work offsets change while the machine moves.", kAll},
    OptionRow{'2', "dual axis", "One axis has two motors with a switch each.", kGrbl},
    OptionRow{'2', "ganged axes", "At least one axis has two motors.", kHal},
};

// protocol.md 4.6
constexpr std::array kNewOptions{
    NewOptionRow{"ENUMS", "enumerations", "$EA, $EE, $EG and $ES tell alarms, errors and settings.", false, false},
    NewOptionRow{"RT+", "legacy realtime characters", "?, ! and ~ act inside texts too ($39 is 1).", false, false},
    NewOptionRow{"RT-", "realtime characters kept", "?, ! and ~ stay in texts ($39 is 0).", false, false},
    NewOptionRow{"CCMP", "cutter compensation", "G41 and G42 work.", false, false},
    NewOptionRow{"HOME", "homing", "Homing is switched on.", false, false},
    NewOptionRow{"NOPROBE", "no probe", "There is no probe input.", false, false},
    NewOptionRow{"PROBES", "several probes", "Mask of the probe inputs.", true, false},
    NewOptionRow{"PC", "probe connected input", "The controller knows whether a probe is plugged in.", false, false},
    NewOptionRow{"RF", "rotary feed fix", "Feeds of rotary axes are corrected.", false, false},
    NewOptionRow{"OS", "optional stop switch", "There is an input for M1.", false, false},
    NewOptionRow{"BD", "block delete switch", "There is an input for block delete.", false, false},
    NewOptionRow{"ES", "E-stop input", "There is an input for the emergency stop.", false, false},
    NewOptionRow{"MPG", "pendant stream", "A pendant can take control.", false, false},
    NewOptionRow{"LATHE", "lathe", "Lathe mode is possible.", false, false},
    NewOptionRow{"LATHEUVW", "lathe with UVW", "U, V and W are increments in lathe mode.", false, false},
    NewOptionRow{"PPI", "laser pulses per inch", "The laser can fire by distance.", false, false},
    NewOptionRow{"REBOOT", "reboot", "ESC 0x14 restarts the processor.", false, false},
    NewOptionRow{"EXPR", "expressions", "Parameters, expressions and O words work.", false, false},
    NewOptionRow{"TC", "manual tool change", "M6 waits for the operator.", false, false},
    NewOptionRow{"ATC", "tool changer", "1: on line, 0: off line.", true, false},
    NewOptionRow{"SS", "spindle synchronisation", "Threading works.", false, false},
    NewOptionRow{"SED", "setting descriptions", "$SED= tells what a setting does.", false, false},
    NewOptionRow{"RTC", "clock", "There is a real-time clock.", false, false},
    NewOptionRow{"CAN", "CAN bus", "There is a CAN bus.", false, false},
    NewOptionRow{"PID", "PID log", "0xA2 reports the spindle loop.", false, false},
    NewOptionRow{"SD", "SD card", "Jobs run from an SD card.", false, true},
    NewOptionRow{"FS", "file system", "There is a file system.", false, true},
    NewOptionRow{"YM", "YModem", "Files can be sent over the stream.", false, true},
    NewOptionRow{"FTP", "FTP", "Files can be sent by FTP.", false, true},
    NewOptionRow{"ETH", "Ethernet", "There is a wired network.", false, true},
    NewOptionRow{"WIFI", "WiFi", "There is a wireless network.", false, true},
    NewOptionRow{"BT", "Bluetooth", "There is a Bluetooth serial port.", false, true},
    NewOptionRow{"ODO", "odometer", "Hours and distances are counted.", false, true},
    NewOptionRow{"WHB", "wireless pendant", "A wireless hand wheel can take part.", false, true},
};

}  // namespace

std::span<const OptionRow> option_rows() {
  return kOptions;
}

const OptionRow* find_option(Firmware firmware, char letter) {
  const auto fits = [&](const OptionRow& row) {
    return row.letter == letter && (firmware == Firmware::Unknown || contains(row.known_to, firmware));
  };
  const auto at = std::ranges::find_if(kOptions, fits);
  return at == kOptions.end() ? nullptr : &*at;
}

std::span<const NewOptionRow> new_option_rows() {
  return kNewOptions;
}

const NewOptionRow* find_new_option(std::string_view token) {
  const auto at = std::ranges::find(kNewOptions, token.substr(0, token.find('=')), &NewOptionRow::token);
  return at == kNewOptions.end() ? nullptr : &*at;
}

}  // namespace kerf::vocabulary
