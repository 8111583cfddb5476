#pragma once
// What there is to say of a whole path before it is drawn: how far it reaches, and with what it is cut.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/toolpath_reader.hpp"

namespace kerf::rehearsal {

/// The least and the most of something; nothing while least is more than most.
struct Extent {
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();

  [[nodiscard]] bool is_empty() const { return least > most; }
  [[nodiscard]] double size() const { return is_empty() ? 0 : most - least; }
  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// A tool, and what it was asked for.
struct ToolUse {
  std::uint16_t number = 0;
  std::uint32_t first_line = 0;
  Extent feed_mm_per_min{};
  Extent spindle_rpm{};
  /// Lowest place of a cut.
  Extent cut_z_mm{};
  double cut_mm = 0;
};

/// Of the motion whose places are known; see PathVertex::unknown_axes.
struct PathSummary {
  PathBounds bounds{};
  /// Of the cuts, without the air above a plunge.
  PathBounds cuts{};
  Extent feed_mm_per_min{};
  Extent spindle_rpm{};
  /// Those that cut, in the order in which they begin.
  std::vector<ToolUse> tools;
  /// Indices into `operation_names`, in the order in which they begin to cut.
  std::vector<std::uint16_t> operations;
  std::vector<std::string> operation_names;
  std::uint64_t cut_count = 0;
  std::uint64_t arc_count = 0;
  std::uint64_t rapid_count = 0;
  double cut_mm = 0;
  double rapid_mm = 0;
  /// As PathVertex::time_s.
  double time_s = 0;
  std::uint32_t refused_lines = 0;
  bool uses_inches = false;
  bool uses_mm = false;
};

/// Adds up chunks in their order.
class PathSummer {
 public:
  void add(const PathChunk& chunk);
  [[nodiscard]] PathSummary finish(const ToolpathReader& reader);

 private:
  void add_cut(const Point& from_mm, const PathVertex& vertex, double length_mm);

  PathSummary sum_;
  std::vector<bool> has_operation_;
};

[[nodiscard]] PathSummary summarize(std::string_view text, const PathStart& start);

}  // namespace kerf::rehearsal
