#include "firmware/parking.hpp"

#include <algorithm>

namespace kerf::firmware {

bool Parking::is_enabled() const {
  return board_.settings.flag(setting::kParking) && board_.overrides.parking_acts &&
         !board_.planner.settings().laser_mode;
}

bool Parking::begin() {
  if (!board_.personality.has_extended_settings || !is_enabled()) return false;
  if (!active_) {
    active_ = true;
    work_place_mm_ = board_.position_mm();
  }
  const bool homed = ((board_.homed >> axis()) & 1U) != 0;
  return homed && work_place_mm_.at(axis()) < number(setting::kParkingTarget);
}

bool Parking::pull_out() {
  const float here = restarts_ ? board_.position_mm().at(axis()) : work_place_mm_.at(axis());
  if (!restarts_) waypoint_mm_ = std::min(here + number(setting::kParkingPullOut), number(setting::kParkingTarget));
  const bool moves = here < waypoint_mm_ && start(Leg::PullOut, waypoint_mm_, setting::kParkingPullOutRate);
  if (!restarts_) moved_ = moves;
  return moves;
}

bool Parking::retreat() {
  const float target = number(setting::kParkingTarget);
  return moved_ && board_.position_mm().at(axis()) < target && start(Leg::Retreat, target, setting::kParkingRate);
}

bool Parking::go_back() {
  if (!moved_) return false;
  restarts_ = false;
  return work_place_mm_.at(axis()) <= number(setting::kParkingTarget) &&
         start(Leg::Return, waypoint_mm_, setting::kParkingRate);
}

bool Parking::plunge() {
  restarts_ = false;
  return moved_ && start(Leg::Plunge, work_place_mm_.at(axis()), setting::kParkingPullOutRate);
}

void Parking::abort() {
  restarts_ = active_;
  if (leg_ == Leg::None) return;
  leg_ = Leg::Aborted;
  board_.executor.begin_hold(board_.now);
}

void Parking::leg_ended() {
  leg_ = Leg::None;
}

void Parking::forget() {
  leg_ = Leg::None;
  active_ = restarts_ = moved_ = false;
}

bool Parking::start(Leg leg, float axis_mm, int rate_setting) {
  AxisValues target = work_place_mm_;
  target.at(axis()) = axis_mm;
  const motion::PathLine line = {.target_mm = target,
                                 .feed = {.rate_mm_per_min = number(rate_setting), .no_override = true}};
  const auto added = board_.executor.start_system_motion(board_.now, line, motion::SystemMotion::Parking);
  if (added == motion::Planner::Added::Dropped) return false;
  leg_ = leg;
  return true;
}

}  // namespace kerf::firmware
