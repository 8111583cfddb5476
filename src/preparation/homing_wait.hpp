#pragma once
// Whether a `$H` has done what it is for, from what the session tells. Pure; never waits for ever.

#include <cstdint>
#include <string>

#include "common/base/time.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/event.hpp"

namespace kerf::preparation {

/// One homing, from the command to the machine that says it is homed.
class HomingWait {
 public:
  enum class Verdict {
    Waiting,
    Homed,
    Failed,  ///< sentence() says what became of it
  };

  /// `now` as it is before the command.
  void begin(Instant at, const machine::Snapshot& now);
  void on_event(const session::Event& event);
  [[nodiscard]] Verdict look(Instant at, const machine::Snapshot& now);
  /// Why it failed.
  [[nodiscard]] const std::string& sentence() const { return sentence_; }
  [[nodiscard]] bool has_begun() const { return has_begun_; }

 private:
  [[nodiscard]] Verdict fail(std::string sentence);

  bool has_begun_ = false;
  bool is_answered_ = false;
  bool is_lost_ = false;
  std::string refusal_;
  std::string sentence_;
  std::uint64_t reports_before_ = 0;
  Instant begun_at_{};
  /// Idle, answered and yet not homed since then.
  Instant idle_since_ = kNever;
};

}  // namespace kerf::preparation
