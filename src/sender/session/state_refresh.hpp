#pragma once
// Asks again for what may have changed: modes and offsets after lines, everything after a doubt. Never in motion.

#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

enum class RefreshOrder {
  FullReport,    ///< 0x87
  ParserReport,  ///< 0x83: the modes without an answer that would have to be waited for
  AskParser,     ///< `$G`
  AskOffsets,    ///< `$#`
};

/// What the session knows beyond the snapshot.
struct RefreshSituation {
  const machine::Snapshot& snapshot;
  const vocabulary::Dialect& dialect;
  /// The controller is known, listens to this link, and answers.
  bool is_connected = false;
  /// Nothing is queued, on its way or under way.
  bool is_quiet = false;
};

class StateRefresh {
 public:
  /// What is known and what the machine says may differ: after a silence, a hand-over, a flush.
  void on_doubt() { full_report_ = true; }
  /// A line of the operator or of a job was answered, or somebody else had the machine.
  void on_change(Instant now);
  void forget();

  /// What to ask now. Call after every report and at the deadline.
  [[nodiscard]] std::vector<RefreshOrder> take_orders(Instant now, const RefreshSituation& situation);
  [[nodiscard]] Instant next_deadline() const { return ask_at_; }

 private:
  bool full_report_ = false;
  Instant changed_at_{};
  Instant ask_at_ = kNever;
  int attempts_ = 0;
};

}  // namespace kerf::session
