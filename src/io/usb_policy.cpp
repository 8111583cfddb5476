#include "io/usb_policy.hpp"

#include <algorithm>
#include <array>

namespace kerf::io {
namespace {

using enum ControlLines;

constexpr std::string_view kBoardsTxt = "ArduinoCore-avr boards.txt; Uno schematic: DTR through 100 nF to RESET";
constexpr std::string_view kEspCircuit =
    "esptool documentation, Boot Mode Selection: two transistors, nothing happens while DTR and RTS are alike";
constexpr std::string_view kTinyUsb = "TinyUSB tud_cdc_connected() is DTR";

// More special rows first.
constexpr std::array kPolicies{
    UsbPolicy{"2341", "8036", "Arduino Leonardo", DtrTalks,
              "ArduinoCore-avr CDC.cpp: lineState, reset at 1200 baud only"},
    UsbPolicy{"2341", "8037", "Arduino Micro", DtrTalks, "ArduinoCore-avr CDC.cpp: lineState, reset at 1200 baud only"},
    UsbPolicy{"2341", "003e", "Arduino Due, native port", DtrTalks, "ArduinoCore-sam CDC.cpp: reset at 1200 baud only"},
    UsbPolicy{"2341", "", "Arduino", DtrResets, kBoardsTxt},
    UsbPolicy{"2a03", "", "Arduino", DtrResets, kBoardsTxt},
    UsbPolicy{"0403", "6001", "FT232R", DtrResets, "Arduino Nano 3 schematic: DTR through 100 nF to RESET"},
    UsbPolicy{"0403", "6015", "FT231X", DtrResets, "SparkFun RedBoard schematic: DTR through 100 nF to RESET"},
    UsbPolicy{"1a86", "7523", "CH340", Depends, "clones of the Uno (as boards.txt) and ESP32 boards (as esptool)"},
    UsbPolicy{"1a86", "5523", "CH341", Depends, "clones of the Uno (as boards.txt) and ESP32 boards (as esptool)"},
    UsbPolicy{"1a86", "55d4", "CH9102", EitherAlone, kEspCircuit},
    UsbPolicy{"10c4", "ea60", "CP210x", EitherAlone, kEspCircuit},
    UsbPolicy{"303a", "", "Espressif USB", EitherAlone,
              "ESP32-S3 and -C3 technical reference, USB Serial/JTAG: RTS without DTR resets the chip"},
    UsbPolicy{"0483", "5740", "STM32 USB", DtrTalks, "Arduino_Core_STM32 USBSerial: writes while DTR is up"},
    UsbPolicy{"16c0", "0483", "Teensy", DtrTalks, "Teensy cores usb_serial.c: DTR is kept in usb_cdc_line_rtsdtr"},
    UsbPolicy{"2e8a", "", "RP2040 or RP2350", DtrTalks, kTinyUsb},
    UsbPolicy{"1fc9", "", "LPC USB", DtrTalks,
              "CDC 1.2, 6.3.12 SetControlLineState: DTR says that a terminal is there"},
    UsbPolicy{"067b", "", "PL2303", Unknown, "a bare cable: what its DTR is wired to depends on the board"},
    UsbPolicy{"", "", "", Unknown, "not in this table"},
};

std::string_view effect_of(ControlLines lines, bool lines_fell) {
  switch (lines) {
    case DtrResets:
      return lines_fell ? "that restarts the controller" : "they were up already, so the controller is not restarted";
    case EitherAlone: return "together they leave the controller alone";
    case Depends: return "that restarts an Arduino and leaves an ESP32 alone";
    case DtrTalks: return "the controller talks as long as DTR is up, and is not restarted";
    case Unknown: break;
  }
  return "whether that restarts the controller is not known";
}

bool matches(std::string_view wanted, std::string_view found) {
  return wanted.empty() || wanted == found;
}

}  // namespace

std::span<const UsbPolicy> usb_policies() {
  return kPolicies;
}

const UsbPolicy& policy_for(const SerialPort& port) {
  const auto* const row = std::ranges::find_if(kPolicies, [&port](const UsbPolicy& policy) {
    return matches(policy.vendor, port.vendor) && matches(policy.product, port.product);
  });
  return *row;
}

machine::LinkOpening opening_of(const SerialPort& port, bool lines_fell) {
  const UsbPolicy& policy = policy_for(port);
  std::string who = port.path;
  if (!port.vendor.empty()) {
    who += " (" + std::string{policy.name} + (policy.name.empty() ? "" : ", ") + "USB " + port.vendor + ":" +
           port.product + ")";
  }
  const bool may_restart = policy.lines == DtrResets || policy.lines == Depends;
  return {.sentence = "DTR and RTS are up on " + who + ": " + std::string{effect_of(policy.lines, lines_fell)} +
                      ". They stay up when Kerf closes the port.",
          .may_restart = may_restart && lines_fell};
}

}  // namespace kerf::io
