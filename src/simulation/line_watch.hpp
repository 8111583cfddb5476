#pragma once
// The promise that a sender must keep, checked against the machine itself and not against what the sender believes: no
// line goes to a machine in motion that it did not start, and no machine is reset without a word.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "firmware/rig.hpp"
#include "sender/session/command.hpp"
#include "sender/session/session.hpp"

namespace kerf::simulation {

/// Looks at the true machine whenever a byte leaves the sender. A stretch of motion is the sender's if a line that can
/// move (of a job, or by hand) or a cycle start of this connection came before it, after whatever anybody else did;
/// everything else is foreign: other senders' lines, a pendant, buttons, startup lines, what an earlier connection left
/// running.
class LineWatch {
 public:
  /// A report takes time, and a sender asks only so often: foreign motion that is younger than this cannot be known.
  static constexpr Duration kNotice = std::chrono::milliseconds{1750};

  void on_link_changed() { kerf_moves_ = is_own_ = false; }
  void on_power_changed() { kerf_moves_ = is_own_ = false; }
  /// Somebody else did something that may start motion.
  void on_stranger() { stranger_acted_ = true; }
  void on_command(const session::Command& command);
  /// The machine as it is now.
  void look(Instant now, const firmware::Rig& rig, bool has_job);
  /// What leaves the sender now.
  void on_outbox(Instant now, const session::Outbox& out);

  /// One sentence for each time that the promise was broken.
  [[nodiscard]] const std::vector<std::string>& broken() const { return broken_; }
  /// How often foreign motion began.
  [[nodiscard]] std::size_t foreign_stretches() const { return foreign_stretches_; }
  [[nodiscard]] bool is_in_foreign_motion() const { return moving_since_ && !is_own_; }

 private:
  void on_line(Instant now, const session::LineSent& line);
  void on_reset(Instant now, bool announced);
  [[nodiscard]] bool is_knowably_foreign(Instant now) const;
  void complain(Instant now, std::string_view what);

  std::optional<Instant> moving_since_;
  bool is_own_ = false;
  bool kerf_moves_ = false;
  bool stranger_acted_ = true;
  bool reset_was_asked_for_ = false;
  std::size_t foreign_stretches_ = 0;
  std::vector<std::string> broken_;
};

}  // namespace kerf::simulation
