#pragma once
// Follows the lines that a controller accepts, so that the target of the next one can be told in machine coordinates.

#include <optional>
#include <string_view>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::machine {

/// Reads lines with the controller's own rules from a known state on. It says nothing rather than something wrong: a
/// line that it cannot follow (a probe, a tool change, a macro) ends its knowledge until the next `seed`.
class LineTracker {
 public:
  /// The machine rests and its modes, offsets and position are known.
  void seed(const Snapshot& snapshot, const vocabulary::Dialect& dialect, gcode::InterpreterSettings settings = {});
  void forget() { interpreter_.reset(); }
  [[nodiscard]] bool knows() const { return interpreter_.has_value(); }
  /// The reader, as it stands behind the last line that was accepted; empty while nothing is known.
  [[nodiscard]] const std::optional<gcode::Interpreter>& reader() const { return interpreter_; }

  /// The controller answered ok.
  void on_accepted(std::string_view line);

  /// Ends of the motions that `line` asks for, machine coordinates in mm, one number for each axis; empty where they
  /// are not known or there are none.
  [[nodiscard]] std::vector<std::vector<double>> targets_of(std::string_view line) const;

 private:
  std::optional<gcode::Interpreter> interpreter_;
  std::size_t axes_ = 0;
  /// Of `on_accepted`, kept for its memory.
  std::vector<gcode::Action> actions_;
};

}  // namespace kerf::machine
