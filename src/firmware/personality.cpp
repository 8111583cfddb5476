#include "firmware/personality.hpp"

#include <algorithm>
#include <array>

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

Personality built_with(const Personality& personality, const Hardware& hardware) {
  Personality built = personality;
  if (hardware.axes != 0) built.hardware.axes = std::min(hardware.axes, personality.dialect().axes_max);
  if (hardware.tools != 0) built.hardware.tools = hardware.tools;
  if (hardware.ports != gcode::PortCounts{}) built.hardware.ports = hardware.ports;
  built.hardware.slow_memory = hardware.slow_memory;
  return built;
}

const Personality* personality_named(std::string_view name) {
  const auto found =
      std::ranges::find_if(kAllBuilds, [&](const Personality* one) { return base::iequals(one->key(), name); });
  return found == kAllBuilds.end() ? nullptr : *found;
}

std::string personality_names() {
  std::string names;
  for (const Personality* one : kAllBuilds) {
    if (one == kAllBuilds.back())
      names += " or ";
    else if (!names.empty())
      names += ", ";
    names += one->key();
  }
  return names;
}

}  // namespace kerf::firmware
