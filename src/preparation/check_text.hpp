#pragma once
// The findings of a check for people and for programs.

#include <string>
#include <string_view>
#include <vector>

#include "io/json.hpp"
#include "rehearsal/check.hpp"

namespace kerf::preparation {

/// All of it, the worst first; `machine` is the name of the firmware.
[[nodiscard]] std::vector<std::string> check_text(const rehearsal::CheckResult& result, std::string_view file,
                                                  std::string_view machine);

/// Before a job: errors in full, each kind of warning in one line, no notes.
[[nodiscard]] std::vector<std::string> check_lines_for_run(const rehearsal::CheckResult& result);

[[nodiscard]] io::Json check_json(const rehearsal::CheckResult& result, std::string_view machine);

}  // namespace kerf::preparation
