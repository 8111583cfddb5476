#pragma once
// Runs a talk against the virtual controller of its personality, in virtual time.

#include <optional>
#include <string>

#include "simulation/talk.hpp"
#include "simulation/talk_conversation.hpp"

namespace kerf::simulation {

struct TalkOutcome {
  std::optional<TalkFailure> failure;  ///< none: the talk passed
  std::string record;                  ///< the conversation with its times
  double virtual_s = 0;                ///< how long the talk was, on the virtual clock
};

/// Always ends: a talk has finite patience, and a controller that stops moving time fails the talk.
[[nodiscard]] TalkOutcome run_talk(const Talk& talk);

}  // namespace kerf::simulation
