#pragma once
// Where a firmware loses steps whenever it goes on in mid-motion: how far its machine may have come off the program by
// that.

#include <cstddef>
#include <span>

#include "common/vocabulary/axis.hpp"
#include "sender/job/path_forecast.hpp"

namespace kerf::job {

/// grblHAL begins the counters of its line algorithm anew when it goes on, so that each axis may end up a step off, and
/// nothing puts that right until the next homing or reset (motion/rules.hpp): after many holds that adds up to tenths
/// of a millimetre, which the controller knows and reports. Each restart widens a box of possible offsets by a step;
/// each report that lies on the path narrows it to what that report allows.
class StepLoss {
 public:
  /// What an earlier job may have lost stays possible: nobody says whether the machine was homed or reset since.
  void begin(const PathRules& rules);
  /// Positions are told but for this.
  void round_by(double mm) { rounding_mm_ = mm; }
  /// The machine goes on in mid-motion, or may have.
  void on_restart();
  /// A report says `at_mm`, and the machine is on one of `pieces`.
  void narrow(std::span<const PathPiece> pieces, const AxisValues& at_mm);

  /// The middle of what is possible, mm, and how far it reaches from there.
  [[nodiscard]] const AxisValues& middle_mm() const { return middle_mm_; }
  [[nodiscard]] double reach_mm() const { return reach_mm_; }

 private:
  struct Box {
    AxisValues least_mm{};
    AxisValues most_mm{};
  };

  /// False where nothing is left.
  [[nodiscard]] bool cut(Box& box, const PathPiece& piece, const AxisValues& at_mm) const;
  void set(const Box& box);

  std::size_t axes_ = 0;
  /// Of one step; 0 where the firmware loses none.
  AxisValues step_mm_{};
  double rounding_mm_ = 0;
  Box box_;
  AxisValues middle_mm_{};
  double reach_mm_ = 0;
};

}  // namespace kerf::job
