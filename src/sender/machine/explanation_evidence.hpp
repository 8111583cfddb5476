#pragma once
// The pieces of evidence that explanations are made of: limits of travel, inputs, words of a line.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/vocabulary/travel.hpp"
#include "sender/machine/explanation.hpp"

namespace kerf::machine {

/// "12.1", "-62.4": at most three decimals, none that are zero.
[[nodiscard]] std::string short_number(double value);

/// Value of a numbered setting, where `$$` told it.
[[nodiscard]] std::optional<double> setting_number(const Capabilities& capabilities, int id);

/// Whether a bit of a numbered setting is set; not where `$$` did not tell.
[[nodiscard]] bool is_setting_on(const Capabilities& capabilities, int id, unsigned bit = 0);

/// What the settings say about the travel of an axis, with the pull-off; empty where they do not tell.
[[nodiscard]] std::optional<vocabulary::TravelFacts> travel_facts(std::size_t axis, const Capabilities& capabilities);

/// Where an axis may go once it is homed; empty where the settings do not tell.
[[nodiscard]] std::optional<vocabulary::Travel> travel_of_axis(std::size_t axis, const Capabilities& capabilities,
                                                               const vocabulary::Dialect& dialect);

/// How far a target lies outside of the travel of an axis.
struct Excess {
  std::size_t axis = 0;
  double target_mm = 0;
  /// Negative: below the lower end.
  double excess_mm = 0;
  double travel_min_mm = 0;
  double travel_max_mm = 0;
};
/// The worst axis of all targets; empty where everything lies within, or nothing is known.
[[nodiscard]] std::optional<Excess> worst_excess(const std::vector<std::vector<double>>& targets_mm,
                                                 const MachineKnowledge& machine);
/// "Z-62.4 is 2.4 mm below the travel because the tool length offset is 12.1"
[[nodiscard]] std::string excess_text(const Excess& excess, const Snapshot& before);

/// The axes that stand within `near_mm` of an end of their travel, or beyond it, a sentence each.
[[nodiscard]] std::vector<std::string> nearness_to_ends(const Snapshot& snapshot, const MachineKnowledge& machine);

/// "Active inputs: X limit, probe." or that there are none.
[[nodiscard]] std::string inputs_text(const Snapshot& snapshot, const vocabulary::Dialect& dialect);

/// G and M words of `line` that the firmware does not have, as written: "G77".
[[nodiscard]] std::vector<std::string> unknown_commands(std::string_view line, const vocabulary::Dialect& dialect);

/// "line 8812, 'G1Z-50'" or "'G1Z-50'".
[[nodiscard]] std::string line_text(const IncidentLine& line);

/// "X1.000 Y2.000 Z3.000"
[[nodiscard]] std::string place_text(const std::vector<double>& position_mm);

}  // namespace kerf::machine
