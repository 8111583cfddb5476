#pragma once
// May a line leave? Only to a machine that rests, or that moves because Kerf made it move, and only on fresh knowledge.

#include <optional>

#include "common/base/time.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

enum class GateVerdict {
  Open,
  Blind,          ///< the last report is too old to say anything
  ForeignMotion,  ///< the machine moves, and Kerf did not start it
};

/// Motion is Kerf's own from the first line or cycle start that Kerf sends until a report that was asked for after the
/// last answer says that the machine rests, with nothing owed. What moves then was started by somebody else: a button,
/// another sender, a program of the controller's.
class LineGate {
 public:
  /// After a handshake, which ends with a machine that rests.
  void open(Instant now);
  void on_asked(Instant now);
  /// `is_at_work`: lines are owed, or a job is under way.
  void on_report(Instant now, const machine::Snapshot& snapshot, bool is_at_work);
  /// A line left, an answer came, or a cycle start was sent.
  void on_activity(Instant now);

  [[nodiscard]] GateVerdict verdict(Instant now) const;
  [[nodiscard]] bool sees_foreign_motion() const { return moves_ && !is_own_; }
  /// Kerf started something that no report has yet shown to be over.
  [[nodiscard]] bool may_be_moving() const { return is_own_; }
  /// Foreign motion began: true once for each.
  [[nodiscard]] bool take_notice();

 private:
  std::optional<Instant> asked_at_;
  Instant known_at_{};
  Instant active_at_{};
  bool is_own_ = false;
  bool moves_ = false;
  bool owes_notice_ = false;
};

}  // namespace kerf::session
