#pragma once
// One interpreter case against the virtual controller, in virtual time: a case in, a record of its answers out.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/base/time.hpp"
#include "firmware/personality.hpp"
#include "firmware/stored_state.hpp"
#include "firmware/workcell.hpp"

namespace kerf::simulation {

/// A realtime byte that arrives on its own, `after` time zero.
struct InjectedByte {
  Duration after{};
  std::uint8_t byte = 0;

  bool operator==(const InjectedByte&) const = default;
};

/// What is asked. Lines carry no line end.
struct InterpreterCase {
  std::string id;
  std::vector<std::string> lines;
  /// Sent before, their answers are not recorded.
  std::vector<std::string> setup{};
  /// Counted from the instant at which the first line is sent.
  std::vector<InjectedByte> inject{};
};

/// What was answered, in the words of the controller.
struct CaseRecord {
  std::string id;
  /// For each line `ok` or `error:N`; `lost` if a reset swallowed it, `none` if no answer came.
  std::vector<std::string> answers;
  std::vector<std::string> alarms;
  /// The last `[GC:…]` line; empty if there was none.
  std::string parser_state;
  /// What `$#` printed, in the end or in a line, and what a probe move printed by itself: name, and everything between
  /// the first colon and the closing bracket.
  std::vector<std::pair<std::string, std::string>> offsets;
  std::vector<std::int32_t> position_steps;
  std::vector<double> position_mm;
  /// Every other line, status reports left out.
  std::vector<std::string> messages;
};

/// The machine that a case is run on: switched on anew, with these settings and surroundings.
struct CaseMachine {
  const firmware::Personality& personality;
  firmware::StoredState stored{};
  std::vector<firmware::WorkcellEvent> workcell{};
  /// Lines that it is told when it is on, before the case begins: settings that act after the next reset only, and a
  /// last line that it refuses.
  std::string told{};
};

/// Runs one case as the recordings of real firmware were made. Each line is sent when the one before is answered, at
/// 115200 baud, and `$G` and `$#` follow in the same way: Grbl and Rabbit refuse `$#` while the axes still move, and
/// `offsets` is empty then. An alarm of Grbl or Rabbit is reset at once, a machine that waits for nothing in sight as
/// well; the line that a reset swallows is `lost`, and the next one follows the welcome. The position is read when all
/// motion has ended.
[[nodiscard]] CaseRecord run_case(const InterpreterCase& asked, const CaseMachine& machine);

}  // namespace kerf::simulation
