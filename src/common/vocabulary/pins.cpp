#include "common/vocabulary/pins.hpp"

#include <algorithm>
#include <array>

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kRabbitAndHal = FirmwareSet::Rabbit | FirmwareSet::GrblHal;

constexpr std::array kRows{
    PinRow{'X', "X limit", "A limit switch of X is pressed.", kAll},
    PinRow{'Y', "Y limit", "A limit switch of Y is pressed.", kAll},
    PinRow{'Z', "Z limit", "A limit switch of Z is pressed.", kAll},
    PinRow{'A', "A limit", "A limit switch of A is pressed.", kRabbitAndHal},
    PinRow{'B', "B limit", "A limit switch of B is pressed.", kRabbitAndHal},
    PinRow{'C', "C limit", "A limit switch of C is pressed.", kRabbitAndHal},
    PinRow{'U', "U limit", "A limit switch of U is pressed.", kHal},
    PinRow{'V', "V limit", "A limit switch of V is pressed.", kHal},
    PinRow{'W', "W limit", "A limit switch of W is pressed.", kHal},
    PinRow{'R', "reset", "The reset input is active.", kAll},
    PinRow{'H', "feed hold", "The feed hold input is active.", kAll},
    PinRow{'S', "cycle start", "The cycle start input is active.", kAll},
    PinRow{'D', "safety door", "The safety door is open.", kAll},
    PinRow{'L', "block delete", "Lines that start with / are skipped.", kHal},
    PinRow{'T', "optional stop off", "M1 is ignored.", kHal},
    PinRow{'E', "E-stop", "The emergency stop is pressed.", kHal},
    PinRow{'O', "probe disconnected", "No probe is plugged in.", kHal},
    PinRow{'F', "motor fault", "A motor driver reports a fault.", kHal},
    PinRow{'M', "motor warning", "A motor driver reports a warning.", kHal},
    PinRow{'Q', "single block", "The machine holds after each block.", kHal},
    PinRow{'P', "probe", "The probe touches.", kAll},
    PinRow{'0', "macro button 0", "Macro button 0 is pressed.", FirmwareSet::Rabbit},
    PinRow{'1', "macro button 1", "Macro button 1 is pressed.", FirmwareSet::Rabbit},
    PinRow{'2', "macro button 2", "Macro button 2 is pressed.", FirmwareSet::Rabbit},
    PinRow{'3', "macro button 3", "Macro button 3 is pressed.", FirmwareSet::Rabbit},
};

}  // namespace

std::span<const PinRow> pin_rows() {
  return kRows;
}

const PinRow* find_pin(Firmware firmware, char letter) {
  const auto fits = [&](const PinRow& row) {
    return row.letter == letter && (firmware == Firmware::Unknown || contains(row.known_to, firmware));
  };
  const auto at = std::ranges::find_if(kRows, fits);
  return at == kRows.end() ? nullptr : &*at;
}

}  // namespace kerf::vocabulary
