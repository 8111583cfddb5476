#include "firmware/parking.hpp"

#include <algorithm>

namespace kerf::firmware {

bool Parking::is_enabled() const {
  if (board_.planner.settings().laser_mode) return false;
  if (board_.personality.fixed_parking) return board_.settings.flag(setting::kHoming);
  return board_.personality.has_extended_settings && board_.settings.flag(setting::kParking) &&
         board_.overrides.parking_acts;
}

ParkingPlace Parking::place() const {
  if (const auto& fixed = board_.personality.fixed_parking) {
    return {.axis = vocabulary::index_of(vocabulary::Axis::Z),
            .target_mm = fixed->target_mm,
            .rate_mm_per_min = fixed->rate_mm_per_min,
            .pull_out_mm = fixed->pull_out_mm,
            .pull_out_rate_mm_per_min = fixed->pull_out_rate_mm_per_min};
  }
  const auto number = [this](int id) { return static_cast<float>(board_.settings.number(id)); };
  return {.axis = board_.settings.mask(setting::kParkingAxis),
          .target_mm = number(setting::kParkingTarget),
          .rate_mm_per_min = number(setting::kParkingRate),
          .pull_out_mm = number(setting::kParkingPullOut),
          .pull_out_rate_mm_per_min = number(setting::kParkingPullOutRate)};
}

bool Parking::begin() {
  if (!is_enabled()) return false;
  if (!active_) {
    active_ = true;
    work_place_mm_ = board_.position_mm();
  }
  const ParkingPlace park = place();
  const bool homed = board_.personality.fixed_parking || ((board_.homed >> park.axis) & 1U) != 0;
  return homed && work_place_mm_.at(park.axis) < park.target_mm;
}

bool Parking::pull_out() {
  const ParkingPlace park = place();
  const float here = restarts_ ? board_.position_mm().at(park.axis) : work_place_mm_.at(park.axis);
  if (!restarts_) waypoint_mm_ = std::min(here + park.pull_out_mm, park.target_mm);
  const bool moves = here < waypoint_mm_ && start(Leg::PullOut, waypoint_mm_, park.pull_out_rate_mm_per_min);
  if (!restarts_) moved_ = moves;
  return moves;
}

bool Parking::retreat() {
  const ParkingPlace park = place();
  return moved_ && board_.position_mm().at(park.axis) < park.target_mm &&
         start(Leg::Retreat, park.target_mm, park.rate_mm_per_min);
}

bool Parking::go_back() {
  if (!moved_) return false;
  restarts_ = false;
  const ParkingPlace park = place();
  return work_place_mm_.at(park.axis) <= park.target_mm && start(Leg::Return, waypoint_mm_, park.rate_mm_per_min);
}

bool Parking::plunge() {
  restarts_ = false;
  const ParkingPlace park = place();
  return moved_ && start(Leg::Plunge, work_place_mm_.at(park.axis), park.pull_out_rate_mm_per_min);
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

bool Parking::start(Leg leg, float axis_mm, float rate_mm_per_min) {
  AxisValues target = work_place_mm_;
  target.at(place().axis) = axis_mm;
  const motion::PathLine line = {.target_mm = target,
                                 .feed = {.rate_mm_per_min = rate_mm_per_min, .no_override = true}};
  const auto added = board_.executor.start_system_motion(board_.now, line, motion::SystemMotion::Parking);
  if (added == motion::Planner::Added::Dropped) return false;
  leg_ = leg;
  return true;
}

}  // namespace kerf::firmware
