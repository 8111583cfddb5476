#include "sender/machine/stranger.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"

namespace kerf::machine {
namespace {

constexpr std::size_t kExcerpt = 60;
constexpr double kMostOddBytes = 0.2;

constexpr std::string_view kFlash = "Put Grbl, Rabbit GRBL or grblHAL on it, or choose another port.";
constexpr std::string_view kOtherPort = "Choose another port.";
constexpr std::string_view kRelease =
    "Release its BOOT button, take away what pulls GPIO0 down, and switch it off and on.";

using enum Certainty;
using Failure = HandshakeFailure;

// Phrases as the programs print them: Espressif's boot ROM (ESP-IDF, "Boot mode selection"), optiboot.c (STK_INSYNC
// STK_OK), Marlin's MarlinCore.cpp, Smoothieware's Kernel.cpp and SimpleShell.cpp, Repetier.ino, TinyG's report.c,
// 3GPP TS 27.007, NMEA 0183.
constexpr std::array kRows{
    StrangerRow{"waiting for download", Certain, Failure::Bootloader,
                "an ESP32 that waits for a firmware instead of running one", kRelease},
    StrangerRow{"DOWNLOAD_BOOT", Certain, Failure::Bootloader,
                "an ESP32 that waits for a firmware instead of running one", kRelease},
    StrangerRow{"DOWNLOAD(", Certain, Failure::Bootloader, "an ESP32 that waits for a firmware instead of running one",
                kRelease},
    StrangerRow{"invalid header: 0x", Certain, Failure::Bootloader, "an ESP32 without a firmware", kFlash},
    StrangerRow{"flash read err", Certain, Failure::Bootloader, "an ESP32 that cannot read its flash memory", kFlash},
    StrangerRow{"rst:0x", Boot, Failure::Restarting, "an ESP32 that starts",
                "Check its power supply: a brown-out shows as BROWN_OUT or POWERON there."},
    StrangerRow{"\x14\x10", Alone, Failure::Bootloader, "the bootloader of an Arduino, and no program behind it",
                kFlash},
    StrangerRow{"Smoothie", Certain, Failure::NotGrbl, "Smoothieware", kFlash},
    StrangerRow{"Build version: ", Certain, Failure::NotGrbl, "Smoothieware", kFlash},
    StrangerRow{"Marlin", Certain, Failure::NotGrbl, "Marlin, a firmware of 3D printers", kFlash},
    StrangerRow{"Repetier", Certain, Failure::NotGrbl, "Repetier, a firmware of 3D printers", kFlash},
    StrangerRow{"RepRapFirmware", Certain, Failure::NotGrbl, "RepRapFirmware", kFlash},
    StrangerRow{"FIRMWARE_NAME:", Certain, Failure::NotGrbl, "a firmware of 3D printers", kFlash},
    StrangerRow{"// Klipper", Certain, Failure::NotGrbl, "Klipper, a firmware of 3D printers", kFlash},
    StrangerRow{"\necho:", Alone, Failure::NotGrbl, "Marlin or a relative, a firmware of 3D printers", kFlash},
    StrangerRow{"{\"r\":", Certain, Failure::NotGrbl, "TinyG or g2core", kFlash},
    StrangerRow{"{\"sr\":", Certain, Failure::NotGrbl, "TinyG or g2core", kFlash},
    StrangerRow{"NO CARRIER", Certain, Failure::NotGrbl, "a modem", kOtherPort},
    StrangerRow{"+CME ERROR", Certain, Failure::NotGrbl, "a modem", kOtherPort},
    StrangerRow{"AT+", Alone, Failure::NotGrbl, "a modem", kOtherPort},
    StrangerRow{"$GP", Alone, Failure::NotGrbl, "a satellite receiver", kOtherPort},
    StrangerRow{"$GN", Alone, Failure::NotGrbl, "a satellite receiver", kOtherPort},
    StrangerRow{"U-Boot", Alone, Failure::NotGrbl, "the console of a computer", kOtherPort},
    StrangerRow{" login:", Alone, Failure::NotGrbl, "the console of a computer", kOtherPort},
    StrangerRow{"MicroPython", Alone, Failure::NotGrbl, "MicroPython", kFlash},
    StrangerRow{"CircuitPython", Alone, Failure::NotGrbl, "CircuitPython", kFlash},
};

bool is_odd(char letter) {
  const bool printable = letter >= ' ' && letter <= '~';
  return !printable && letter != '\r' && letter != '\n' && letter != '\t' && letter != '\x1B';
}

}  // namespace

std::span<const StrangerRow> stranger_rows() {
  return kRows;
}

const StrangerRow* find_stranger(std::string_view text) {
  const auto* const row = std::ranges::find_if(
      kRows, [text](const StrangerRow& known) { return text.find(known.phrase) != std::string_view::npos; });
  return row == kRows.end() ? nullptr : row;
}

void Overheard::hear(std::string_view bytes) {
  count_ += bytes.size();
  text_ += bytes;
  if (text_.size() > kKept) text_.erase(0, text_.size() - kKept);
}

bool Overheard::is_noise() const {
  const auto odd = static_cast<double>(std::ranges::count_if(text_, is_odd));
  return odd > kMostOddBytes * static_cast<double>(text_.size());
}

bool Overheard::is_echo_of(std::string_view sent) const {
  return !text_.empty() && sent.find(text_) != std::string_view::npos;
}

std::string Overheard::excerpt() const {
  return excerpt_of(text_);
}

std::string excerpt_of(std::string_view line) {
  const bool cut = line.size() > kExcerpt;
  return base::escape(line.substr(0, kExcerpt)) + (cut ? "…" : "");
}

}  // namespace kerf::machine
