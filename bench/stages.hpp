#pragma once
// The stages that a program goes through in Kerf, each on its own.

#include <cstdint>
#include <vector>

#include "common/motion/planner.hpp"
#include "programs.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::bench {

/// A machine with the settings of `program`, its switches nowhere.
[[nodiscard]] simulation::CaseMachine machine_for(const BenchProgram& program, vocabulary::Firmware firmware);

/// Bytes to lines to actions, as the main loop reads them. Returns the number of actions, so that nothing is optimised
/// away.
std::size_t parse(const BenchProgram& program, vocabulary::Firmware firmware);

/// Every line and chord of the program for the planner.
[[nodiscard]] std::vector<motion::PathLine> path_of(const BenchProgram& program,
                                                    const simulation::CaseMachine& machine);

/// Plans them all through a queue that is always full: one block out, one in. Returns a sum of entry speeds.
float plan(const std::vector<motion::PathLine>& path, const simulation::CaseMachine& machine);

/// The same without keeping the path: bytes to blocks, for programs of any length. Returns the number of blocks.
std::size_t plan_whole(const BenchProgram& program, const simulation::CaseMachine& machine);

/// The whole virtual controller in virtual time, as `kerf simulate` runs it.
[[nodiscard]] simulation::MotionTrace simulate(const BenchProgram& program, const simulation::CaseMachine& machine);

}  // namespace kerf::bench
