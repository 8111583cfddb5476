#pragma once
// Three programs to measure with, the same on every machine: the shapes that senders see most.

#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

struct BenchProgram {
  std::string_view name;
  std::string text;
  /// `$n=value` lines for the machine that it runs on.
  std::string_view settings;
};

/// Parallel passes over a wavy surface: moves of 0.1 to 1 mm, one line each, three axes.
[[nodiscard]] BenchProgram finishing(int lines);
/// Rows of pixels of 0.1 mm with a new S word each, M4.
[[nodiscard]] BenchProgram raster(int lines);
/// Arcs of 1 to 10 mm radius in the XY plane, a line between; each becomes dozens of chords.
[[nodiscard]] BenchProgram arcs(int lines);

/// All three, `lines` lines each.
[[nodiscard]] std::vector<BenchProgram> all_programs(int lines);

}  // namespace kerf::bench
