#pragma once
// Fewer points for a line that nobody can tell from the old one.

#include <array>

namespace kerf::rehearsal {

/// Takes points one by one for as long as the straight line from its beginning to the last of them passes every one
/// within a tolerance. Time and memory of a point are constant.
///
/// The directions that do are a cone around the run's beginning; every point cuts it down to the largest round cone in
/// what is left, so what is taken is always right, and now and then a point is refused that would have done.
class StraightRun {
 public:
  using Place = std::array<double, 3>;

  explicit StraightRun(double tolerance) : tolerance_(tolerance) {}

  void begin(const Place& at);
  /// False: the point does not fit, and nothing has changed.
  bool take(const Place& point);

 private:
  double tolerance_;
  Place begin_{};
  double farthest_ = 0;
  bool has_cone_ = false;
  Place axis_{};
  double half_angle_rad_ = 0;
};

}  // namespace kerf::rehearsal
