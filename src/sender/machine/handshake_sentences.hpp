#pragma once
// What the handshake tells people: one sentence for each outcome, with what to do next.

#include <optional>
#include <string>

#include "common/vocabulary/dialect.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/handshake_orders.hpp"
#include "sender/machine/lexicon.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/machine/stranger.hpp"

namespace kerf::machine {

/// What a machine does that Kerf did not start.
[[nodiscard]] std::string busy_sentence(const Snapshot& snapshot);
[[nodiscard]] std::string pendant_sentence();
/// A machine that is known now: what it is, and the state in which it was found.
[[nodiscard]] std::string found_sentence(const Capabilities& capabilities, const Snapshot& snapshot,
                                         const CodeFact& alarm);
/// Nobody of Grbl's family answers: who or what is there instead.
struct Verdict {
  HandshakeFailure failure{};
  std::string sentence;
};
[[nodiscard]] Verdict verdict_on(const Overheard& overheard, std::string_view sent, std::optional<int> baud);
[[nodiscard]] Verdict verdict_on(const StrangerRow& stranger, std::string_view line);
[[nodiscard]] Verdict fallen_silent();
[[nodiscard]] Verdict too_old(std::string_view line);
[[nodiscard]] std::string restarting_sentence();
[[nodiscard]] std::string unanswered_sentence(const Snapshot& snapshot);

}  // namespace kerf::machine
