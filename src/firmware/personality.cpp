#include "firmware/personality.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "common/base/text.hpp"
#include "firmware/personalities/personalities.hpp"

namespace kerf::firmware {

namespace {

constexpr std::array<const Personality*, 3> kAll = {&kGrbl, &kRabbit, &kGrblHal};
constexpr std::array<const Personality*, 4> kAllBuilds = {&kGrbl, &kRabbit, &kGrblHal, &kGrblHalExpressions};

}  // namespace

std::span<const Personality* const> all_personalities() {
  return kAll;
}

const Personality& personality_of(vocabulary::Firmware firmware) {
  const auto found = std::ranges::find(kAll, firmware, &Personality::firmware);
  return found == kAll.end() ? kGrbl : **found;
}

namespace {

bool fit(const gcode::PortCounts& wanted, const gcode::PortCounts& most) {
  return wanted.digital_inputs <= most.digital_inputs && wanted.digital_outputs <= most.digital_outputs &&
         wanted.analog_inputs <= most.analog_inputs && wanted.analog_outputs <= most.analog_outputs;
}

}  // namespace

std::optional<HardwareFault> fault_in(const Hardware& wanted, const Personality& personality) {
  const Hardware& most = personality.most;
  const bool counts_axes = wanted.axes != 0;
  if (counts_axes && (wanted.axes < kFewestAxes || wanted.axes > personality.dialect().axes_max)) {
    return HardwareFault::Axes;
  }
  if (wanted.tools > most.tools) return HardwareFault::Tools;
  if (!fit(wanted.ports, most.ports)) return HardwareFault::Ports;
  if (wanted.slow_memory && !most.slow_memory) return HardwareFault::SlowMemory;
  if (wanted.spindle_encoder && !most.spindle_encoder) return HardwareFault::SpindleEncoder;
  return std::nullopt;
}

Personality built_with(const Personality& personality, const Hardware& hardware) {
  Personality built = personality;
  const Hardware& most = personality.most;
  if (hardware.axes != 0) built.hardware.axes = std::min(hardware.axes, personality.dialect().axes_max);
  if (hardware.tools != 0) built.hardware.tools = std::min(hardware.tools, most.tools);
  if (fit(hardware.ports, most.ports) && hardware.ports != gcode::PortCounts{}) built.hardware.ports = hardware.ports;
  built.hardware.slow_memory = hardware.slow_memory && most.slow_memory;
  built.hardware.spindle_encoder = hardware.spindle_encoder && most.spindle_encoder;
  return built;
}

const Personality* personality_named(std::string_view name) {
  const auto found =
      std::ranges::find_if(kAllBuilds, [&](const Personality* one) { return base::iequals(one->key(), name); });
  return found == kAllBuilds.end() ? nullptr : *found;
}

std::string personality_names() {
  return personality_names_for({});
}

std::string personality_names_for(const Hardware& wanted) {
  std::vector<std::string_view> keys;
  for (const Personality* one : kAllBuilds) {
    if (!fault_in(wanted, *one)) keys.push_back(one->key());
  }
  std::string names;
  for (const std::string_view& key : keys) {
    if (!names.empty()) names += &key == &keys.back() ? " or " : ", ";
    names += key;
  }
  return names;
}

}  // namespace kerf::firmware
