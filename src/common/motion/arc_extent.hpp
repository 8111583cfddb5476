#pragma once
// How far an arc goes beyond its ends.

#include <vector>

#include "common/motion/arc.hpp"

namespace kerf::motion {

/// The points between start and target where the arc goes farthest along one of its plane's axes, in machine
/// coordinates, mm; none where its ends are the farthest.
[[nodiscard]] std::vector<AxisValues> extremes_of(const Arc& arc);

}  // namespace kerf::motion
