#pragma once
// Whether a machine keeps to the path of its job, told by its motors, and whether its sender notices when it does not.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "simulation/stock.hpp"
#include "simulation/world.hpp"

namespace kerf::simulation {

/// Follows a machine along the path that an undisturbed one takes for the same job, forwards only. Off it by more than
/// kOffMm, the job must not run on: the first report that was made there, and one that was on its way before, is all
/// that the sender is allowed. While a door is open or a tool is changed nobody judges.
class DepartureWatch {
 public:
  /// What Kerf promises to find, and what two homings differ by.
  static constexpr double kOffMm = 0.05 + 0.02;

  /// `path`: ends of straight pieces, machine coordinates. `on_the_way`: a report that arrives so much later than the
  /// machine left its path may have been made before.
  DepartureWatch(std::vector<Point> path, double steps_per_mm, Duration on_the_way)
      : path_(std::move(path)), steps_per_mm_(steps_per_mm), on_the_way_(on_the_way) {}

  /// From the first line of the job on.
  void look(const World& world);

  /// It was off its path at some time.
  [[nodiscard]] bool was_off() const { return was_off_; }
  /// While the job ran.
  [[nodiscard]] bool was_off_in_job() const { return was_off_in_job_; }
  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  [[nodiscard]] double distance_to_path(const Point& at);

  std::vector<Point> path_;
  double steps_per_mm_ = 1;
  Duration on_the_way_{};
  std::size_t reached_ = 0;
  vocabulary::AxisSteps steps_{};
  std::optional<Instant> since_;
  std::uint64_t reports_then_ = 0;
  bool was_off_ = false;
  bool was_off_in_job_ = false;
  std::vector<std::string> complaints_;
};

}  // namespace kerf::simulation
