#pragma once
// Who has the machine: this sender or a pendant (protocol.md 1.5).

#include <optional>
#include <string>

#include "common/base/time.hpp"
#include "common/vocabulary/dialect.hpp"

namespace kerf::session {

enum class ControlChange { None, TakenByPendant, GivenBack };

/// Follows the hand-over, and asks for control back when the operator wants it.
class PendantWatch {
 public:
  /// After each report.
  [[nodiscard]] ControlChange on_report(bool pendant_in_control);
  /// 0x8B goes out now.
  void on_asked_back(Instant now);
  /// True once, when control was asked back and has not come.
  [[nodiscard]] bool take_failure(Instant now);
  void forget();
  [[nodiscard]] Instant next_deadline() const { return give_up_at_; }

 private:
  bool pendant_ = false;
  Instant give_up_at_ = kNever;
};

/// What to do where the controller does not give control back on this link: it listens to the pendant alone (grblHAL
/// stream.c), or to a new network connection.
[[nodiscard]] std::string not_given_back_sentence(bool is_network);

}  // namespace kerf::session
