#pragma once
// Programs that use everything a controller can do with its axes, made up by chance. They are for machines, not for
// stock: campaigns that look at the part want milling_job.

#include <cstddef>
#include <string>

#include "common/vocabulary/firmware.hpp"
#include "simulation/dice.hpp"

namespace kerf::simulation {

/// What a job may hold besides plain motion.
struct VariedJobParts {
  /// M0 and, where the firmware waits there, M6: somebody has to press cycle start.
  bool pauses = true;
  /// G38: the surface has to lie between Z-1 and Z-4 of the machine's first position.
  bool probing = false;
};

/// A program of `sections` parts, each a handful of lines to some hundred: rasters, arcs in all planes by centre and by
/// radius, helices, tiny segments, inches, increments, inverse time, G92, G10, G28, G43.1, dwells, spindle and coolant,
/// and what only `firmware` has: canned cycles, splines, scaling. It stays within 60 mm of X0 Y0 Z0 of G54.
[[nodiscard]] std::string varied_job(Dice& dice, vocabulary::Firmware firmware, const VariedJobParts& parts,
                                     std::size_t sections);

}  // namespace kerf::simulation
