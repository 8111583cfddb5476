#pragma once
// Looks at the motors of a machine that mills, whatever its controller or its sender say about them.

#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "common/vocabulary/axis.hpp"
#include "firmware/virtual_controller.hpp"
#include "simulation/stock.hpp"

namespace kerf::simulation {

/// Keeps the workpiece up to date, and complains about what no operator wants to see: a rapid through uncut stock, a
/// tool that is fed into it without turning, motion that begins although nobody gave a command.
class CutterWatch {
 public:
  /// `work_zero` in motor steps since the first power-on.
  CutterWatch(const vocabulary::AxisSteps& work_zero, double steps_per_mm)
      : work_zero_(work_zero), steps_per_mm_(steps_per_mm) {}

  /// The machine as it is now. `commanded`: something that may start motion was sent since the controller started.
  void look(Instant now, const firmware::VirtualController& controller, bool commanded);

  [[nodiscard]] const Stock& stock() const { return stock_; }
  /// From work zero.
  [[nodiscard]] const Point& position() const { return at_; }
  [[nodiscard]] bool is_moving() const { return was_moving_; }
  [[nodiscard]] Instant last_moved_at() const { return last_moved_at_; }
  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  /// What the tool does on its way.
  enum class Way { Fed, FedAtRest, Rapid };

  void follow(Instant now, const Point& to);
  void complain(Instant now, std::string_view what);

  vocabulary::AxisSteps work_zero_{};
  double steps_per_mm_ = 1;
  Stock stock_;
  bool has_looked_ = false;
  vocabulary::AxisSteps steps_{};
  Point at_{};
  Way way_ = Way::Rapid;
  bool was_moving_ = false;
  bool complained_about_way_ = false;
  Instant last_moved_at_{};
  std::vector<std::string> complaints_;
};

/// Where the machine stands: motor steps since the first power-on, whatever happened since.
[[nodiscard]] vocabulary::AxisSteps place_of(const firmware::VirtualController& controller);

}  // namespace kerf::simulation
