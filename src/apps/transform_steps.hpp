#pragma once
// The transforms of a command line, from their texts.

#include <expected>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "rehearsal/transform.hpp"

namespace kerf::apps {

/// In the order in which they were written, or a sentence that says which one is wrong.
[[nodiscard]] std::expected<std::vector<rehearsal::TransformStep>, std::string> parse_steps(
    const std::vector<TransformStepText>& texts);

}  // namespace kerf::apps
