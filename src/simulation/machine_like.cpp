#include "simulation/machine_like.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace kerf::simulation {
namespace {

/// Locks and limits: a rehearsal starts at the machine's zero wherever the real machine stands.
constexpr std::array<std::string_view, 4> kSettingsLeftOut = {"20", "21", "22", "64"};

}  // namespace

CaseMachine machine_like(const machine::Capabilities& capabilities) {
  CaseMachine machine{.personality = firmware::personality_of(capabilities.family)};
  machine.stored.initialised = true;
  for (const auto& setting : capabilities.settings) {
    if (!setting.value || std::ranges::find(kSettingsLeftOut, setting.id) != kSettingsLeftOut.end()) continue;
    machine.stored.settings[setting.id] = *setting.value;
  }
  return machine;
}

}  // namespace kerf::simulation
