#include "common/vocabulary/accessories.hpp"

#include <algorithm>
#include <array>

namespace kerf::vocabulary {
namespace {

constexpr std::array kRows{
    AccessoryRow{'S', "spindle clockwise", "The spindle turns clockwise (M3).", FirmwareSet::All},
    AccessoryRow{'C', "spindle counter-clockwise", "The spindle turns counter-clockwise (M4).", FirmwareSet::All},
    AccessoryRow{'E', "encoder error", "The spindle encoder lost pulses.", FirmwareSet::GrblHal},
    AccessoryRow{'F', "flood", "Flood coolant is on (M8).", FirmwareSet::All},
    AccessoryRow{'M', "mist", "Mist coolant is on (M7).", FirmwareSet::All},
    AccessoryRow{'T', "tool change", "A tool change is pending. Left out of reports that carry T:.",
                 FirmwareSet::GrblHal},
};

}  // namespace

std::span<const AccessoryRow> accessory_rows() {
  return kRows;
}

const AccessoryRow* find_accessory(Firmware firmware, char letter) {
  const auto fits = [&](const AccessoryRow& row) {
    return row.letter == letter && (firmware == Firmware::Unknown || contains(row.known_to, firmware));
  };
  const auto at = std::ranges::find_if(kRows, fits);
  return at == kRows.end() ? nullptr : &*at;
}

}  // namespace kerf::vocabulary
