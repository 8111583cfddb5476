#pragma once
// Cuts a program on the virtual controller before the machine does, to know how long each line takes.

#include <memory>

#include "sender/job/program.hpp"
#include "sender/job/timeline.hpp"
#include "sender/machine/capabilities.hpp"

namespace kerf::preparation {

/// The timeline of `program` on a machine like the one that told these capabilities, with its settings. Null when it
/// would say nothing reliable: an unknown firmware, a program that does not run through (a refused line, an alarm), or
/// one so long that the operator would wait for it. Nobody knows how long he takes at M0 or M6: they take no time here.
/// `speed` is how fast the machine's clock runs.
[[nodiscard]] std::shared_ptr<const job::Timeline> rehearse(const job::Program& program,
                                                            const machine::Capabilities& capabilities, double speed);

}  // namespace kerf::preparation
