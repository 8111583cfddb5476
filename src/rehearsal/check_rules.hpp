#pragma once
// The rules of a check: each looks at lines and moves as they come, remembers what it needs, and tells what it finds.
//
// A rule has any of: begin(findings), on_line(line, actions, findings), on_move(move, findings), at_end(findings).

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/action.hpp"
#include "rehearsal/check_machine.hpp"
#include "rehearsal/check_move.hpp"
#include "rehearsal/finding.hpp"

namespace kerf::rehearsal {

using Actions = std::span<const gcode::Action>;

/// A line that may turn out to be a finding later.
struct RememberedLine {
  std::uint32_t number = 0;
  std::string text;

  RememberedLine() = default;
  explicit RememberedLine(const CheckedLine& line);
};

/// Startup lines of the controller that do something.
class StartupRule {
 public:
  explicit StartupRule(const CheckMachine& machine) : machine_(machine) {}
  void begin(Findings& findings) const;

 private:
  const CheckMachine& machine_;
};

/// Moves beyond the soft limits or the travel; where the work zero is not known, programs that fit nowhere.
class TravelRule {
 public:
  explicit TravelRule(const CheckMachine& machine);
  void on_move(const CheckedMove& move, Findings& findings);

 private:
  struct Excess {
    std::size_t axis = 0;
    float place_mm = 0;
    float excess_mm = 0;
  };
  struct Span {
    float min_mm = std::numeric_limits<float>::max();
    float max_mm = std::numeric_limits<float>::lowest();
  };

  [[nodiscard]] std::optional<Excess> excess_at(const AxisValues& place_mm, AxisMask axes, float tolerance_mm) const;
  [[nodiscard]] std::optional<Excess> excess_on_arc(const CheckedMove& move, AxisMask axes, bool as_cut) const;
  [[nodiscard]] AxisMask still_outside(const CheckedMove& move);
  void check_place(const CheckedMove& move, AxisMask axes, FindingKind kind, Findings& findings);
  [[nodiscard]] bool is_within_spans(const CheckedMove& move) const;
  void check_span(const CheckedMove& move, Findings& findings);
  void extend(const CheckedMove& move, const AxisValues& place_mm, AxisMask axes, Findings& findings);

  const CheckMachine& machine_;
  AxisMask guarded_ = 0;
  AxisMask watched_ = 0;
  AxisMask measured_ = 0;
  std::array<Span, kMaxAxes> spans_{};
  AxisMask told_ = 0;
  AxisMask outside_ = 0;
  std::uint32_t frame_ = 0;
};

/// Rapids through the material: sideways at or below the highest cut, or down where nothing has been cut so deep.
class HeightRule {
 public:
  explicit HeightRule(const CheckMachine& machine);
  void on_move(const CheckedMove& move, Findings& findings);
  void at_end(Findings& findings);

 private:
  /// A rapid that is wrong if something higher is cut later.
  struct Suspect {
    RememberedLine line;
    float height_mm = 0;
    float work_mm = 0;
  };

  void forget();
  void on_rapid(const CheckedMove& move, Findings& findings);
  void check_descent(const CheckedMove& move, Findings& findings) const;
  void on_feed(const CheckedMove& move);
  [[nodiscard]] bool goes_sideways_in_stock(const CheckedMove& move, float height_mm) const;
  void suspect(const CheckedMove& move, float height_mm);
  void mark_cut(const CheckedMove& move);
  void mark(float x_mm, float y_mm, float z_mm);
  [[nodiscard]] bool is_cut(const AxisValues& place_mm) const;

  bool is_on_ = true;
  std::uint32_t frame_ = 0;
  bool has_moved_z_ = false;
  bool is_in_cut_ = false;
  std::optional<float> highest_cut_mm_{};
  std::vector<Suspect> suspects_;
  std::optional<Suspect> first_across_{};
  /// The deepest cut in each field of a grid that repeats itself: far apart places may share a field, and then a
  /// finding is missed.
  std::vector<float> deepest_mm_;
};

class FeedRule {
 public:
  explicit FeedRule(const CheckMachine& machine);
  void on_move(const CheckedMove& move, Findings& findings) const;

 private:
  [[nodiscard]] float limit_of(const CheckedMove& move) const;

  const CheckMachine& machine_;
  float slowest_axis_mm_per_min_ = 0;
};

class SpindleRule {
 public:
  explicit SpindleRule(const CheckMachine& machine);
  void on_line(const CheckedLine& line, Actions actions, Findings& findings);
  void on_move(const CheckedMove& move, Findings& findings);
  void at_end(Findings& findings) const;

 private:
  const CheckMachine& machine_;
  bool has_speed_ = false;
  bool was_on_ = false;
  bool has_cut_ = false;
  std::optional<RememberedLine> start_without_speed_{};
  std::optional<RememberedLine> first_feed_{};
};

/// Power that changes in mid-motion, or M4 without any depth: a laser's program.
class LaserRule {
 public:
  explicit LaserRule(const CheckMachine& machine);
  void on_line(const CheckedLine& line, Actions actions, Findings& findings);
  void on_move(const CheckedMove& move, Findings& findings);
  void at_end(Findings& findings) const;

 private:
  bool is_on_ = true;
  bool has_depth_ = false;
  std::optional<RememberedLine> first_power_{};
  std::optional<RememberedLine> dynamic_power_{};
};

/// Units and planes.
class ModeRule {
 public:
  explicit ModeRule(const CheckMachine&) {}
  void on_line(const CheckedLine& line, Actions actions, Findings& findings);
  void on_move(const CheckedMove& move, Findings& findings);

 private:
  bool said_inches_ = false;
  bool said_millimetres_ = false;
  std::optional<gcode::Plane> plane_of_arcs_{};
};

/// G28, G30 and G53 where nobody knows what is there.
class PlaceRule {
 public:
  explicit PlaceRule(const CheckMachine& machine) : machine_(machine) {}
  void on_line(const CheckedLine& line, Actions actions, Findings& findings) const;

 private:
  const CheckMachine& machine_;
};

class ProbeRule {
 public:
  explicit ProbeRule(const CheckMachine& machine) : machine_(machine) {}
  void on_move(const CheckedMove& move, Findings& findings) const;

 private:
  const CheckMachine& machine_;
};

/// Tools, and where the program waits for somebody.
class StopRule {
 public:
  explicit StopRule(const CheckMachine& machine) : machine_(machine) {}
  void on_tool_change(const CheckedLine& line, std::optional<int> tool, Findings& findings);
  void on_line(const CheckedLine& line, Actions actions, Findings& findings);
  void at_end(Findings& findings);

  /// In the order in which they were named; of very many the first.
  [[nodiscard]] const std::vector<int>& tools() const { return tools_; }

 private:
  struct NamedTool {
    RememberedLine line;
    int tool = 0;
  };

  const CheckMachine& machine_;
  std::vector<int> tools_;
  /// Where another tool than the one before was named.
  std::vector<NamedTool> named_;
  std::optional<int> tool_{};
  bool changes_tools_ = false;
};

}  // namespace kerf::rehearsal
