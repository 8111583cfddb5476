#pragma once
// The tables of this folder, one a firmware.

#include "firmware/personality.hpp"

namespace kerf::firmware {

extern const Personality kGrbl;
extern const Personality kRabbit;
extern const Personality kGrblHal;
extern const Personality kGrblHalExpressions;

}  // namespace kerf::firmware
