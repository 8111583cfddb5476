#include "simulation/cutter_watch.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"
#include "firmware/workcell.hpp"

namespace kerf::simulation {
namespace {

constexpr double kSampleMm = 0.1;

Point between(const Point& from, const Point& to, double share) {
  return {.x = from.x + share * (to.x - from.x),
          .y = from.y + share * (to.y - from.y),
          .z = from.z + share * (to.z - from.z)};
}

}  // namespace

vocabulary::AxisSteps place_of(const firmware::VirtualController& controller) {
  vocabulary::AxisSteps place = controller.motor_steps();
  const vocabulary::AxisSteps& before = controller.workcell().uncounted_steps();
  for (std::size_t axis = 0; axis < place.size(); ++axis) place[axis] += before[axis];
  return place;
}

void CutterWatch::look(Instant now, const firmware::VirtualController& controller, bool commanded) {
  const vocabulary::AxisSteps steps = place_of(controller);
  const bool moving = controller.is_moving();
  if (moving && !was_moving_) {
    complained_about_way_ = false;
    if (!commanded && has_looked_) complain(now, "the machine moves although nobody gave a command");
  }
  // Between two looks the block is the one that was seen first; a motion that begins is seen at its end.
  const bool was_at_rest = !was_moving_;
  const auto way_now = [&] {
    if (controller.is_rapid() || controller.state() == vocabulary::MachineState::Home) return Way::Rapid;
    return controller.is_spindle_on() ? Way::Fed : Way::FedAtRest;
  };
  if (was_at_rest) way_ = way_now();
  if (steps != steps_ || !has_looked_) {
    const auto mm = [&](std::size_t axis) { return (steps[axis] - work_zero_[axis]) / steps_per_mm_; };
    const Point to{.x = mm(0), .y = mm(1), .z = mm(2)};
    if (has_looked_) follow(now, to);
    at_ = to;
    steps_ = steps;
    last_moved_at_ = now;
  }
  way_ = way_now();
  was_moving_ = moving;
  has_looked_ = true;
}

void CutterWatch::follow(Instant now, const Point& to) {
  if (way_ == Way::Fed) {
    if (std::min(at_.z, to.z) < 0) stock_.cut(at_, to);
    return;
  }
  if (complained_about_way_ || std::min(at_.z, to.z) >= 0) return;
  const double length = std::hypot(to.x - at_.x, to.y - at_.y, to.z - at_.z);
  const int samples = 1 + static_cast<int>(length / kSampleMm);
  for (int i = 1; i <= samples; ++i) {
    const Point on_the_way = between(at_, to, static_cast<double>(i) / samples);
    if (!stock_.is_uncut(on_the_way)) continue;
    complained_about_way_ = true;
    complain(now, (way_ == Way::Rapid ? "a rapid through uncut stock at " : "a still tool fed into stock at ") +
                      text_of(on_the_way));
    return;
  }
}

void CutterWatch::complain(Instant now, std::string_view what) {
  complaints_.push_back("at " + base::to_fixed(base::to_seconds(now), 3) + " s: " + std::string{what});
}

}  // namespace kerf::simulation
