#pragma once
// The same path with fewer vertices: what can be drawn of ten million motions at once.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rehearsal/straight_run.hpp"
#include "rehearsal/toolpath.hpp"

namespace kerf::rehearsal {

/// A chunk of one level; 0 is the path itself.
struct LevelChunk {
  std::uint32_t level = 0;
  PathChunk chunk{};
};

/// Thins a path out as it is read. On level n, which begins at 1, every place of the path (arcs included) is within
/// `tolerances_mm[n - 1]` of a line of that level, and every vertex of the level is a place of the path with its line
/// and time. Cuts, rapids, tools and operations are never mixed; feeds and speeds within a line are those of its end.
/// Dwells and changes of speed are left out.
class LevelBuilder {
 public:
  static constexpr std::size_t kChunkVertices = 8192;

  /// Ascending.
  explicit LevelBuilder(std::span<const float> tolerances_mm);

  /// The next chunk of the path itself.
  void add(const PathChunk& chunk);
  /// Nothing more comes.
  void finish();
  /// Chunks that are full; after finish(), all that is left.
  [[nodiscard]] std::vector<LevelChunk> take();

 private:
  struct Level {
    StraightRun run;
    PathChunk chunk{};
    /// Given out last.
    PathVertex kept{};
    /// May still be left out.
    PathVertex last{};
    bool is_open = false;
  };

  void add_to(std::size_t level, const PathVertex& vertex);
  void flush(std::size_t level);
  void keep(std::size_t level, const PathVertex& vertex);
  void hand_out(std::size_t level);

  std::vector<Level> levels_;
  float chord_tolerance_mm_ = 0;
  bool has_begun_ = false;
  std::vector<LevelChunk> full_;
  std::vector<Point> chords_;
};

}  // namespace kerf::rehearsal
