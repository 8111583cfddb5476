#pragma once
// Overrides as people set them, by a slider, for controllers that know only steps (protocol.md 2): one byte of each
// kind for each report, until the machine says that it is there. Grbl keeps one flag for each byte, so a second one
// before the first is done would be lost.

#include <array>
#include <optional>
#include <string>

#include "common/vocabulary/realtime.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::session {

/// Percent; what is empty stays as it is.
struct OverrideWish {
  std::optional<int> feed{};
  std::optional<int> rapid{};
  std::optional<int> spindle{};
};

class OverridePursuit {
 public:
  /// One sentence where a value cannot be reached: feed and spindle 10 to 200, rapids 100, 50 or 25.
  [[nodiscard]] static std::string why_not(const OverrideWish& wish);

  void aim_at(const OverrideWish& wish);
  /// The machine has told its overrides, or may have: the bytes to send now.
  [[nodiscard]] std::string on_report(const machine::Snapshot& snapshot);
  [[nodiscard]] bool is_over() const { return !wish_.feed && !wish_.rapid && !wish_.spindle; }

 private:
  OverrideWish wish_;
  /// Reports since the last byte: an override is told with some report behind its change, not always with the next.
  int reports_waited_ = 0;
  machine::OverridePercentages told_;
  int steps_without_effect_ = 0;
};

}  // namespace kerf::session
