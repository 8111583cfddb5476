#pragma once
// Numbers as the firmwares print them in reports: each has its own way of rounding, which shows in the last place.

#include <cstdint>
#include <string>

namespace kerf::gcode {

enum class NumberPrinter : std::uint8_t {
  ScaleThenCut,    // Grbl: times 100 and 10 in float, plus a half, cut
  Printf,          // Rabbit: C's printf, half to even
  RoundThenSplit,  // grblHAL: half of the last place added, then whole and fraction; always with a dot
};

/// Appends `value` with `decimals` places (0 to 4). grblHAL prints `12.` for 12 with none.
void append_number(NumberPrinter printer, float value, int decimals, std::string& out);

}  // namespace kerf::gcode
