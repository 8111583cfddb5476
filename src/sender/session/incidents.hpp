#pragma once
// Remembers the last lines and where they lead, so that an alarm or an error can be explained.

#include <cstddef>
#include <deque>
#include <optional>
#include <string_view>

#include "sender/machine/capabilities.hpp"
#include "sender/machine/explanation.hpp"
#include "sender/machine/line_tracker.hpp"
#include "sender/streaming/ledger.hpp"

namespace kerf::session {

/// Told of every line that is answered; asked when something happens.
class Incidents {
 public:
  /// Nothing is known about modes and position any more.
  void forget();
  /// The machine rests and everything is answered: lines are followed from here.
  void start_from(const machine::Snapshot& snapshot, const machine::Capabilities& known,
                  const vocabulary::Dialect& dialect);
  void on_accepted(const streaming::OwedLine& line);

  /// An alarm: the oldest line that has no answer is the one being read or executed.
  void on_alarm(int code, const machine::Snapshot& before, const streaming::Ledger& ledger, bool reset_by_kerf);
  /// A report of an alarm that nobody was told of.
  void on_alarm_state(int code, const machine::Snapshot& snapshot);
  [[nodiscard]] machine::Incident refused(int code, const streaming::OwedLine& line,
                                          const machine::Snapshot& before) const;

  /// Behind how many of `owed`, which follow the lines accepted so far, a machine at `position_mm` stands; empty where
  /// that is not known or fits more than one. `told`: its modes, where it has just told them. A controller that started
  /// again meanwhile stands there too, and has others.
  [[nodiscard]] std::optional<std::size_t> lines_behind(const std::vector<streaming::OwedLine>& owed,
                                                        const std::vector<double>& position_mm,
                                                        const machine::ParserModes* told) const;

  /// The alarm that holds the machine, as it was when it came.
  [[nodiscard]] const std::optional<machine::Incident>& alarm() const { return alarm_; }
  void clear_alarm() { alarm_.reset(); }
  /// Reads on behind the last line that was accepted; empty while that is not known.
  [[nodiscard]] const std::optional<gcode::Interpreter>& reader() const { return tracker_.reader(); }

 private:
  [[nodiscard]] std::vector<machine::IncidentLine> recent_lines() const;

  machine::LineTracker tracker_;
  std::deque<streaming::OwedLine> answered_;
  std::optional<machine::Incident> alarm_;
};

}  // namespace kerf::session
