#pragma once
// Turns a program into a toolpath, chunk by chunk, so that the beginning can be drawn while the rest is read.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/program_walk.hpp"
#include "rehearsal/toolpath.hpp"

namespace kerf::rehearsal {

/// What a path begins with.
struct PathStart {
  const vocabulary::Dialect* dialect = nullptr;
  /// At rest where the program begins, with the offsets in force.
  gcode::Interpreter reader;
  /// The machine was homed and its position is known, so that places in machine coordinates mean something.
  bool knows_place = false;
  /// Nothing moves faster; 0 where that is not known.
  gcode::AxisValues max_rate_mm_per_min{};
};

/// A machine that nobody homed, with its settings.
[[nodiscard]] PathStart path_start_of(const simulation::CaseMachine& machine);

class ToolpathReader {
 public:
  /// `text` (any line ends) must outlive it: a program's, or one that is still being loaded.
  ToolpathReader(std::string_view text, PathStart start);

  /// Reads on until `chunk` holds `most_vertices`, or many lines were read; false when nothing is left to read. The
  /// chunk is cleared before and may stay empty.
  bool read_on(PathChunk& chunk, std::size_t most_vertices);

  /// Of what has been read.
  [[nodiscard]] const PathBounds& bounds() const { return bounds_; }
  [[nodiscard]] std::uint64_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] double time_s() const { return last_.time_s; }
  [[nodiscard]] std::size_t read_bytes() const { return walk_.read_bytes(); }
  [[nodiscard]] std::uint32_t refused_lines() const { return walk_.refused_lines(); }
  /// Motion was told in inches (G20), or in millimetres.
  [[nodiscard]] bool uses_inches() const { return uses_inches_; }
  [[nodiscard]] bool uses_mm() const { return uses_mm_; }
  /// Names by PathVertex::operation; the first is "".
  [[nodiscard]] const std::vector<std::string>& operations() const { return walk_.operations(); }

 private:
  bool fill(PathChunk& chunk, std::size_t most_vertices);
  void begin_line(const WalkedLine& line);
  void add(const gcode::Action& action, PathChunk& chunk);
  void add_move(const gcode::AxisValues& target_mm, const gcode::Feed& feed, PathVertex vertex, PathChunk& chunk);
  void add_event(PathKind kind, double duration_s, PathChunk& chunk);
  [[nodiscard]] PathKind kind_of(const gcode::Feed& feed);
  [[nodiscard]] double seconds_of(const gcode::AxisValues& target_mm, const gcode::Feed& feed, double length_mm) const;
  void push(const PathVertex& vertex, PathChunk& chunk);

  const vocabulary::Dialect* dialect_;
  bool knows_place_;
  gcode::AxisValues max_rate_mm_per_min_;
  gcode::AxisValues origin_mm_;
  gcode::AxisValues at_mm_;
  ProgramWalk walk_;
  const WalkedLine* line_ = nullptr;
  std::size_t next_action_ = 0;
  /// Where the last vertex is, with time and tool.
  PathVertex last_;
  /// Axes that are known, or not, once this line's motion is over.
  vocabulary::AxisMask known_after_ = 0;
  vocabulary::AxisMask unknown_after_ = 0;
  bool uses_inches_ = false;
  bool uses_mm_ = false;
  bool has_had_power_ = false;
  bool tool_is_new_ = false;
  PathBounds bounds_;
  std::uint64_t vertex_count_ = 0;
};

}  // namespace kerf::rehearsal
