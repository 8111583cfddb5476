#pragma once
// A job of three hours: facing passes of long moves, arcs at their ends, a dwell now and then.

#include <string>

namespace kerf::simulation {

/// About `hours` of cutting at 1000 mm/min: each pass of 500 mm takes half a minute.
inline std::string long_job(int hours) {
  std::string text = "%\n(facing)\nG21 G90 G94 G17\nM3 S10000\nG0 Z5\nG1 Z-1 F500\nF1000\n";
  for (int pass = 0; pass < hours * 120; ++pass) {
    const bool out = pass % 2 == 0;
    const std::string y = std::to_string(pass * 4);
    const std::string next = std::to_string(pass * 4 + 4);
    text += "G1 X" + std::string{out ? "500" : "0"} + " Y" + y + "\n";
    text += std::string{out ? "G3" : "G2"} + " X" + (out ? "500" : "0") + " Y" + next + " I0 J2\n";
    if (pass % 60 == 59) text += "G4 P1\n";
  }
  return text + "G0 Z5\nM5\nM30\n%\n";
}

}  // namespace kerf::simulation
