#pragma once
// Milling programs as people run them, made up by chance: faces, pockets, contours and holes in stock with its top at
// Z0.

#include <cstddef>
#include <string>

#include "common/vocabulary/firmware.hpp"
#include "simulation/dice.hpp"

namespace kerf::simulation {

/// What a firmware can do with a program.
struct MillingFeatures {
  bool canned_cycles = false;
  bool tool_changes = false;
  bool program_pauses = true;
};

[[nodiscard]] MillingFeatures features_of(vocabulary::Firmware firmware);

/// Where G55 has its zero, from the zero of G54, in mm.
inline constexpr double kSecondZeroMm[] = {7.0, -3.0, 1.5};

/// A program of about `lines` lines for G54, within X and Y from 0 to 40 and Z from -6 to 10, at the feeds of a small
/// router. It uses inches and millimetres, G90 and G91, G54 and G55, G92 and G10 L20, arcs with I J and with R
/// in all planes, ramps, pauses and tools as the dice fall.
[[nodiscard]] std::string milling_job(Dice& dice, const MillingFeatures& features, std::size_t lines);

}  // namespace kerf::simulation
