#include "firmware/workcell.hpp"

#include <cmath>
#include <numbers>

#include "common/base/overloaded.hpp"

namespace kerf::firmware {

using vocabulary::AxisMask;
using vocabulary::AxisSteps;

namespace {

constexpr std::size_t kZ = 2;

bool has(AxisMask mask, std::size_t axis) {
  return ((mask >> axis) & 1U) != 0;
}

}  // namespace

void Workcell::apply(const WorkcellEvent& event) {
  std::visit(
      base::Overloaded{
          [&](const InputChanged& change) { inputs_.at(static_cast<std::size_t>(change.input)) = change.active; },
          [&](const LimitHeld& limit) {
            const AxisMask bit = vocabulary::mask_of(limit.axis);
            held_limits_ = static_cast<AxisMask>(limit.active ? held_limits_ | bit : held_limits_ & ~bit);
          },
          [&](const HomingSwitchMoved& moved) {
            homing_switches_.at(vocabulary::index_of(moved.axis)) = {.at_travel_end = false,
                                                                     .distance_mm = moved.distance_mm};
          },
          [&](const StepsLost& lost) { uncounted_.at(vocabulary::index_of(lost.axis)) -= lost.steps; },
          [&](const ProbeSurfaceMoved& moved) {
            surface_mm_ = moved.z_mm;
            surface_shape_ = moved.shape;
          },
          [&](const PortInputChanged& change) {
            (change.digital ? digital_ : analog_).at(change.port % kMostPorts) = change.value;
          },
          [&](const SpindleLoaded& loaded) { spindle_share_ = loaded.share; },
          [&](const EncoderPlugged& encoder) { encoder_plugged_ = encoder.plugged; },
      },
      event);
}

float Workcell::port_input(bool digital, std::size_t port) const {
  return (digital ? digital_ : analog_).at(port % kMostPorts);
}

std::optional<std::int32_t> Workcell::homing_switch_step(std::size_t axis, const Geometry& geometry) const {
  const HomingSwitch& homing_switch = homing_switches_.at(axis);
  const auto distance_mm =
      homing_switch.at_travel_end ? std::optional<double>{geometry.travel_mm.at(axis)} : homing_switch.distance_mm;
  if (axis >= geometry.axes || !distance_mm || (homing_switch.at_travel_end && *distance_mm <= 0)) return std::nullopt;
  const double steps = *distance_mm * static_cast<double>(geometry.steps_per_mm.at(axis));
  return static_cast<std::int32_t>(has(geometry.homing_negative, axis) ? -std::ceil(steps) : std::ceil(steps)) -
         uncounted_.at(axis);
}

AxisMask Workcell::limits_at(const AxisSteps& physical, const Geometry& geometry) const {
  AxisMask active = held_limits_;
  for (std::size_t axis = 0; axis < geometry.axes; ++axis) {
    const auto step = homing_switch_step(axis, geometry);
    if (!step) continue;
    const bool closed = has(geometry.homing_negative, axis) ? physical.at(axis) <= *step : physical.at(axis) >= *step;
    if (closed) active = static_cast<AxisMask>(active | (1U << axis));
  }
  return active;
}

std::optional<std::int32_t> Workcell::surface_step(const AxisSteps& physical, const Geometry& geometry) const {
  if (!surface_mm_ || geometry.axes <= kZ) return std::nullopt;
  const auto mm = [&](std::size_t axis) {
    const double steps = static_cast<double>(physical.at(axis)) + static_cast<double>(uncounted_.at(axis));
    return steps / static_cast<double>(geometry.steps_per_mm.at(axis));
  };
  const double turns = 2 * std::numbers::pi / surface_shape_.wave_length_mm;
  const double height_mm = *surface_mm_ + surface_shape_.tilt_x * mm(0) + surface_shape_.tilt_y * mm(1) +
                           surface_shape_.wave_mm * std::sin(turns * mm(0)) * std::sin(turns * mm(1));
  return static_cast<std::int32_t>(std::floor(height_mm * static_cast<double>(geometry.steps_per_mm.at(kZ)))) -
         uncounted_.at(kZ);
}

bool Workcell::probe_at(const AxisSteps& physical, const Geometry& geometry) const {
  if (is_active(Input::Probe)) return true;
  const auto step = surface_step(physical, geometry);
  return step && physical.at(kZ) <= *step;
}

void Workcell::restart_count(const AxisSteps& physical) {
  for (std::size_t axis = 0; axis < physical.size(); ++axis) uncounted_.at(axis) += physical.at(axis);
}

}  // namespace kerf::firmware
