#include "apps/virtual_hardware.hpp"

#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "io/card_folder.hpp"

namespace kerf::apps {
namespace {

using firmware::Hardware;
using firmware::HardwareFault;
using firmware::Personality;

/// "leave --tools out, or choose --personality grblhal or grblhal-expr"
std::string way_out(std::string_view option, const Hardware& wanted) {
  const std::string others = firmware::personality_names_for(wanted);
  return others.empty() ? fmt::format("leave {} out", option)
                        : fmt::format("leave {} out, or choose --personality {}", option, others);
}

std::string explain(HardwareFault fault, const Hardware& wanted, const Personality& personality) {
  const std::string_view name = personality.dialect().name;
  const Hardware& most = personality.most;
  switch (fault) {
    case HardwareFault::Axes:
      if (personality.dialect().axes_max == firmware::kFewestAxes) {
        return fmt::format("{} has {} axes: {}.", name, firmware::kFewestAxes,
                           way_out("--axes", {.axes = wanted.axes}));
      }
      return fmt::format("{} has {} to {} axes: give --axes such a number.", name, firmware::kFewestAxes,
                         personality.dialect().axes_max);
    case HardwareFault::Tools:
      if (most.tools == 0) {
        return fmt::format("{} has no tool table: {}.", name, way_out("--tools", {.tools = wanted.tools}));
      }
      return fmt::format("The tool table of {} holds {} tools at most: give --tools such a number.", name, most.tools);
    case HardwareFault::Ports:
      if (most.ports == gcode::PortCounts{}) {
        return fmt::format("{} has no user inputs and outputs: {}.", name, way_out("--ports", {.ports = wanted.ports}));
      }
      return fmt::format("{} has {} inputs and outputs of each kind at most: give --ports such numbers.", name,
                         most.ports.digital_inputs);
    case HardwareFault::SlowMemory:
      return fmt::format("{} goes on while it writes its memory: {}.", name,
                         way_out("--slow-memory", {.slow_memory = true}));
    case HardwareFault::SpindleEncoder:
      return fmt::format("{} knows no spindle encoder: {}.", name,
                         way_out("--spindle-encoder", {.spindle_encoder = true}));
  }
  return {};
}

std::unexpected<std::string> wrong(std::string sentence) {
  return std::unexpected(std::move(sentence));
}

}  // namespace

std::expected<Personality, std::string> build_of(const VirtualOptions& options, const Personality& personality) {
  const std::string_view name = personality.dialect().name;
  if (options.tools && *options.tools < 1) return wrong("--tools wants a number from 1 on: leave it out for no table.");
  Hardware wanted{.axes = options.axes.value_or(0),
                  .tools = options.tools.value_or(0),
                  .ports = {},
                  .slow_memory = options.slow_memory,
                  .spindle_encoder = options.spindle_encoder};
  if (options.axes && *options.axes == 0) wanted.axes = -1;
  if (!options.ports.empty()) {
    const auto ports = firmware::parse_port_counts(options.ports);
    if (!ports) {
      return wrong(
          fmt::format("'{}' are no ports: write digital inputs and outputs, analog inputs and outputs, such as "
                      "--ports 4,4,2,2.",
                      options.ports));
    }
    wanted.ports = *ports;
  }
  if (const auto fault = firmware::fault_in(wanted, personality)) return wrong(explain(*fault, wanted, personality));
  if (options.welcome_on_connect && !personality.dialect().welcome_on_connect) {
    return wrong(fmt::format("{} greets nobody who connects: leave --welcome-on-connect out.", name));
  }
  return firmware::built_with(personality, wanted);
}

std::expected<firmware::Equipment, std::string> equipment_of(const VirtualOptions& options,
                                                             const Personality& personality) {
  firmware::Equipment equipment;
  equipment.pendant = !options.pendant.empty();
  const bool wants_any = equipment.pendant || !options.card_folder.empty();
  if (wants_any && !personality.has_plugins) {
    return wrong(
        fmt::format("{} has {}, or choose --personality grblhal.", personality.dialect().name,
                    equipment.pendant ? "no second stream: leave --pendant out" : "no card slot: leave --card out"));
  }
  if (options.card_folder.empty()) return equipment;
  std::error_code fault;
  if (!std::filesystem::is_directory(options.card_folder, fault)) {
    return wrong(
        fmt::format("{} is no folder that could be a card: make it, or name another one.", options.card_folder));
  }
  equipment.card = std::make_shared<io::CardFolder>(options.card_folder);
  return equipment;
}

}  // namespace kerf::apps
