#pragma once
// A milling job on a controller that is fed one line at a time by nobody's sender: what the workpiece has to look like.

#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "simulation/campaign_case.hpp"
#include "simulation/cutter_watch.hpp"

namespace kerf::simulation {

struct UndisturbedJob {
  Stock stock;
  Duration takes{};
  /// Ends of its straight pieces, machine coordinates in mm; the first is where it begins.
  std::vector<Point> path;
  /// In motor steps since the first power-on.
  vocabulary::AxisSteps work_zero{};
  vocabulary::AxisSteps machine_zero{};
  /// Refused lines, and what the watch saw: the job itself is no good.
  std::vector<std::string> complaints;
};

[[nodiscard]] UndisturbedJob undisturbed(const CampaignCase& made_up);

}  // namespace kerf::simulation
