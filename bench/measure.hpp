#pragma once
// Time that is worth comparing: of this thread's processor and of the clock on the wall, several times, in the middle.

#include <functional>
#include <vector>

namespace kerf::bench {

/// What one thing took.
struct Took {
  double cpu_s = 0;
  double wall_s = 0;
};

/// Runs `work` once on this thread.
[[nodiscard]] Took time(const std::function<void()>& work);

/// The middle of several measurements, and how far the outer ones lie from it.
struct Middle {
  double median = 0;
  double least = 0;
  double most = 0;

  /// (most - least) / median, in percent.
  [[nodiscard]] double spread_percent() const { return median > 0 ? 100.0 * (most - least) / median : 0.0; }
};

/// Of at least one value.
[[nodiscard]] Middle middle_of(std::vector<double> values);

/// A fixed piece of arithmetic whose time depends on nothing but the machine and its other users.
[[nodiscard]] Took time_yardstick();

}  // namespace kerf::bench
