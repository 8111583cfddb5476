#pragma once
// Finds the step at which a limit switch closes, in moves so short that the switch is looked at behind each of them:
// first in coarse ones, then again, from behind, in finer ones, and at last step by step. Always in the same direction,
// so that backlash and the switch's own slack do not count. Pure.

#include <array>
#include <cstddef>
#include <cstdint>

namespace kerf::job {

/// In steps of one axis.
struct SwitchSearch {
  /// +1 or -1: where the switch is.
  int direction = 1;
  /// Length of the moves, the coarsest first; the last one is the resolution.
  std::array<std::int64_t, 3> moves{};
  /// The switch is open again so far behind the place where it closed.
  std::int64_t back_off = 0;
  /// No move goes beyond.
  std::int64_t farthest = 0;
};

class SwitchFinder {
 public:
  enum class Verdict {
    Moving,     ///< go to target(), stand still, and say whether the switch is closed
    Found,      ///< it closes at found()
    NotFound,   ///< still open at the farthest place
    StaysShut,  ///< still closed far behind the place where it closed
    Unsteady,   ///< closes now here, now there
  };

  SwitchFinder() = default;
  /// The axis stands at `at`.
  SwitchFinder(const SwitchSearch& search, std::int64_t at, bool is_closed);

  [[nodiscard]] std::int64_t target() const { return target_; }
  [[nodiscard]] std::int64_t found() const { return found_; }
  [[nodiscard]] Verdict verdict() const { return verdict_; }
  /// The axis stands at target().
  Verdict on_stand(bool is_closed);

 private:
  enum class Phase { Forward, Back, Return };

  void go_forward();
  void go_back();
  void end(Verdict verdict) { verdict_ = verdict; }

  SwitchSearch search_{};
  Verdict verdict_ = Verdict::Moving;
  Phase phase_ = Phase::Forward;
  std::size_t level_ = 0;
  /// The last place where the switch was open on the way forward; unknown as long as it was closed from the start.
  bool knows_open_ = true;
  std::int64_t open_at_ = 0;
  std::int64_t target_ = 0;
  std::int64_t found_ = 0;
  int times_back_ = 0;
  int returns_ = 0;
};

}  // namespace kerf::job
