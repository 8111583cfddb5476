#pragma once
// The machine that `kerf conform`, `kerf simulate` and `kerf estimate` run things on, from what the command line says
// about it.

#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::apps {

/// Says what is wrong on standard error and gives nothing. A setting that this firmware refuses is named and left out.
[[nodiscard]] std::optional<simulation::CaseMachine> load_case_machine(const CaseMachineOptions& options);

/// `T:0xBB` or `T:BB`: seconds, and a byte in hex.
[[nodiscard]] std::optional<simulation::InjectedByte> parse_injection(const std::string& text);

/// All of them; says which one is wrong.
[[nodiscard]] std::optional<std::vector<simulation::InjectedByte>> parse_injections(
    const std::vector<std::string>& texts);

/// `saturated`, or a baud rate; says what is wrong.
[[nodiscard]] std::optional<simulation::ProgramLink> parse_link(const std::string& text);

}  // namespace kerf::apps
