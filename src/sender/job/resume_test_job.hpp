#pragma once
// Facts about a machine and a job, for tests of plans to resume.

#include <string>
#include <string_view>
#include <vector>

#include "common/vocabulary/dialect.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::job::testing {

/// A homed router with 300 mm of travel, in the modes of a reset, its work zero at (-200, -150, -60).
inline MachineAtStart router(vocabulary::Firmware firmware) {
  MachineAtStart machine{.firmware = firmware, .axes = "XYZ", .planner_blocks = 15};
  machine.state = vocabulary::MachineState::Idle;
  machine.parser_words = {"G0", "G54", "G17", "G21", "G90", "G94", "M5", "M9", "T0", "F0", "S0"};
  machine.modes = {.motion = "G0",
                   .work_coordinates = "G54",
                   .plane = "G17",
                   .units = "G21",
                   .distance = "G90",
                   .feed_mode = "G94",
                   .spindle = "M5",
                   .coolant = "M9",
                   .feed_mm_per_min = 0.0,
                   .spindle_rpm = 0.0};
  machine.modes_are_current = true;
  for (const char* const name : {"G55", "G56", "G57", "G58", "G59", "G28", "G30", "G92"}) {
    machine.offsets_mm[name] = {0, 0, 0};
  }
  machine.offsets_mm["G54"] = {-200, -150, -60};
  machine.offsets_are_current = true;
  machine.tool = 0;
  machine.tool_length.offset_mm = std::vector<double>{0};
  machine.homing.all = true;
  machine.machine_position_mm = std::vector<double>{-1, -1, -1};
  return machine;
}

inline machine::Capabilities settings_of_router(vocabulary::Firmware firmware, std::string_view laser = "0") {
  machine::Capabilities capabilities;
  capabilities.family = firmware;
  capabilities.features.laser.available = true;
  const auto set = [&](std::string_view id, std::string_view value) {
    capabilities.settings.push_back({.id = std::string{id}, .value = std::string{value}});
  };
  set("22", "1");
  set("27", "1.000");
  set("32", laser);
  for (const char* const axis : {"130", "131", "132"}) set(axis, "300.000");
  return capabilities;
}

inline ResumeFacts facts(vocabulary::Firmware firmware, std::uint32_t from, std::string_view laser = "0") {
  return {.start = router(firmware),
          .present = router(firmware),
          .capabilities = settings_of_router(firmware, laser),
          .executing = {.from = from, .to = from + 3, .known_by = ExecutingKnownBy::PlannerBlocks},
          .executing_because = "that is what the planner can hold"};
}

}  // namespace kerf::job::testing
