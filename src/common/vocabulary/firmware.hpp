#pragma once
// The firmwares that Kerf knows by name, and sets of them for "who has this" columns. The tables of this folder
// describe Grbl 1.1h (build 20190830), Rabbit GRBL 1.6.0 (build 20260315) and grblHAL's core of August 2026 at
// compatibility level 0; where another version or level differs, the row says so.

#include <cstdint>
#include <string_view>

#include <boost/describe.hpp>

namespace kerf::vocabulary {

enum class Firmware : std::uint8_t { Unknown, Grbl, Rabbit, GrblHal };
BOOST_DESCRIBE_ENUM(Firmware, Unknown, Grbl, Rabbit, GrblHal)

/// Bit set of firmwares, for tables.
enum class FirmwareSet : std::uint8_t { None = 0, Grbl = 1, Rabbit = 2, GrblHal = 4, All = 7 };

[[nodiscard]] constexpr FirmwareSet operator|(FirmwareSet a, FirmwareSet b) {
  return static_cast<FirmwareSet>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

[[nodiscard]] constexpr bool contains(FirmwareSet set, Firmware firmware) {
  if (firmware == Firmware::Unknown) return false;
  return ((static_cast<unsigned>(set) >> (static_cast<unsigned>(firmware) - 1U)) & 1U) != 0;
}

/// The name that people use: "Grbl", "Rabbit GRBL", "grblHAL".
[[nodiscard]] constexpr std::string_view name_of(Firmware firmware) {
  switch (firmware) {
    case Firmware::Unknown: return "unknown firmware";
    case Firmware::Grbl: return "Grbl";
    case Firmware::Rabbit: return "Rabbit GRBL";
    case Firmware::GrblHal: return "grblHAL";
  }
  return "unknown firmware";
}

}  // namespace kerf::vocabulary
