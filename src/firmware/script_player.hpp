#pragma once
// Plays a script: each line waits for its moment, and the next one waits for it.

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/time.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "firmware/workcell_script.hpp"

namespace kerf::firmware {

/// Decides when, not what: its owner carries out what it hands over. Lines may be added while it plays, so that
/// somebody can write a script while it runs.
class ScriptPlayer {
 public:
  /// What timings look at.
  struct View {
    Instant now{};
    Instant first_power_on{};
    vocabulary::MachineState state{};
    std::optional<int> substate;
    std::uint32_t lines_begun = 0;
  };

  void add(Instant now, ScriptLine line) { waiting_.push_back({.added_at = now, .line = std::move(line)}); }
  /// The next line if its moment has come.
  [[nodiscard]] std::optional<ScriptLine> take_due(const View& view);
  [[nodiscard]] Instant next_deadline(Instant first_power_on) const;
  /// The next line waits for something that no deadline tells.
  [[nodiscard]] bool waits_for_machine() const;
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

 private:
  struct Waiting {
    Instant added_at{};
    ScriptLine line;
  };

  [[nodiscard]] Instant due_at(const Waiting& next, Instant first_power_on) const;

  std::deque<Waiting> waiting_;
  Instant last_done_{Instant::min()};
};

}  // namespace kerf::firmware
