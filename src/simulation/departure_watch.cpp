#include "simulation/departure_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

double distance(const Point& from, const Point& to, const Point& at) {
  const Point way{.x = to.x - from.x, .y = to.y - from.y, .z = to.z - from.z};
  const double square = way.x * way.x + way.y * way.y + way.z * way.z;
  const double along = way.x * (at.x - from.x) + way.y * (at.y - from.y) + way.z * (at.z - from.z);
  const double part = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  return std::hypot(at.x - from.x - part * way.x, at.y - from.y - part * way.y, at.z - from.z - part * way.z);
}

/// Behind an open door, and in a tool change, a controller moves by rules of its own.
bool follows_program(vocabulary::MachineState state) {
  using vocabulary::MachineState;
  return state == MachineState::Run || state == MachineState::Idle || state == MachineState::Hold;
}

}  // namespace

double DepartureWatch::distance_to_path(const Point& at) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t piece = reached_; piece + 1 < path_.size(); ++piece) {
    const double here = distance(path_[piece], path_[piece + 1], at);
    least = std::min(least, here);
    if (here > kOffMm) continue;
    reached_ = piece;
    break;
  }
  return least;
}

void DepartureWatch::look(const World& world) {
  const auto& steps = world.controller().position_steps();
  if (!follows_program(world.controller().state())) {
    since_.reset();
    // A reset leaves it there: parked, for example.
    steps_ = steps;
    return;
  }
  const auto& session = world.session();
  const bool is_over = !session.job() || job::is_final(session.job()->phase);
  // Where nothing moves, nothing changes but what the sender knows.
  if (steps == steps_ && !since_) return;
  steps_ = steps;
  const Point at{.x = steps[0] / steps_per_mm_, .y = steps[1] / steps_per_mm_, .z = steps[2] / steps_per_mm_};
  const double off = distance_to_path(at);
  if (off <= kOffMm) {
    since_.reset();
    return;
  }
  was_off_ = true;
  was_off_in_job_ = was_off_in_job_ || !is_over;
  if (!since_) since_ = world.now();
  const std::uint64_t reports = session.snapshot().reports;
  if (world.now() <= *since_ + on_the_way_) reports_then_ = reports;
  const bool goes_on = !is_over && session.job()->phase == job::JobPhase::Running && !session.job()->departure;
  if (!goes_on || reports < reports_then_ + 2 || !complaints_.empty()) return;
  complaints_.push_back("at " + base::to_fixed(base::to_seconds(world.now()), 3) + " s: the machine is " +
                        base::to_fixed(off, 3) + " mm off its path for " +
                        base::to_fixed(base::to_seconds(world.now() - *since_), 3) + " s and " +
                        std::to_string(reports - reports_then_) + " reports, and the job goes on");
}

}  // namespace kerf::simulation
