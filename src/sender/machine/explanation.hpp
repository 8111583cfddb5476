#pragma once
// Why an alarm or an error came, what shows it, and what is safe to do next.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/vocabulary/dialect.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

enum class IncidentKind { Alarm, Error };
BOOST_DESCRIBE_ENUM(IncidentKind, Alarm, Error)

/// A line that was on its way or had just been answered.
struct IncidentLine {
  /// Line of the file, from 1; 0 for lines that are in no file.
  std::uint32_t file_line = 0;
  std::string text{};
  bool answered = false;
  bool operator==(const IncidentLine&) const = default;
};
BOOST_DESCRIBE_STRUCT(IncidentLine, (), (file_line, text, answered))

/// What was known when it happened.
struct Incident {
  IncidentKind kind = IncidentKind::Alarm;
  /// 0 where the controller says that it is in alarm, but not why.
  int code = 0;
  /// The last lines sent, oldest first.
  std::vector<IncidentLine> lines{};
  /// The line that caused it, as far as that can be told: controllers check lines in order.
  std::optional<IncidentLine> culprit{};
  /// Where that line wanted to go: ends of its motions, machine coordinates.
  std::vector<std::vector<double>> targets_mm{};
  /// As last reported before it happened.
  Snapshot before{};
  /// Kerf had sent a reset.
  bool reset_by_kerf = false;
};

/// How far the position may be trusted afterwards.
enum class PositionTrust {
  Kept,     ///< as reported
  Suspect,  ///< steps may have been lost
  Unknown,  ///< home first
};
BOOST_DESCRIBE_ENUM(PositionTrust, Kept, Suspect, Unknown)

/// For people: a headline, then the rest.
struct Explanation {
  IncidentKind kind = IncidentKind::Alarm;
  int code = 0;
  std::string title{};
  /// The meaning in the controller's own words where it has any, else in ours.
  std::string text{};
  FactSource source = FactSource::Assumed;
  /// One sentence with the particulars: "Alarm 2 at line 8812: Z-62.4 is 2.4 mm below the travel because ...".
  std::string headline{};
  /// What can be seen that bears on it, most telling first.
  std::vector<std::string> evidence{};
  /// What is safe to do, in order.
  std::vector<std::string> next_steps{};
  PositionTrust position = PositionTrust::Kept;
  std::optional<IncidentLine> culprit{};
};
BOOST_DESCRIBE_STRUCT(Explanation, (),
                      (kind, code, title, text, source, headline, evidence, next_steps, position, culprit))

/// What is known about the machine now.
struct MachineKnowledge {
  const vocabulary::Dialect& dialect;
  const Capabilities& capabilities;
  const Snapshot& now;
};

/// Pure. `meaning` of the code comes from the lexicon.
[[nodiscard]] Explanation explain(const Incident& incident, const CodeFact& meaning, const MachineKnowledge& machine);

/// The same without an incident: what the code means and what to do, for lists.
[[nodiscard]] Explanation explain_code(IncidentKind kind, const CodeFact& meaning, const vocabulary::Dialect& dialect);

/// Everything in `explanation` but the headline, a line each, for a terminal or a log.
[[nodiscard]] std::vector<std::string> details_of(const Explanation& explanation);

}  // namespace kerf::machine
