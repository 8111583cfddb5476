#pragma once
// A program as the bytes of its toolpath, piece by piece: what a screen can show grows as the program is read.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/toolpath_format.hpp"
#include "rehearsal/toolpath_levels.hpp"
#include "rehearsal/toolpath_reader.hpp"

namespace kerf::rehearsal {

class ToolpathStream {
 public:
  /// Levels for a part of some hundred millimetres on a screen of some thousand pixels, and for overviews of it.
  static constexpr std::array<float, 3> kUsualTolerances_mm{0.1F, 0.4F, 1.6F};

  /// `text` must outlive it. `hash` is the program's, or empty while nobody has counted it.
  ToolpathStream(std::string_view text, PathStart start, std::string hash,
                 std::span<const float> tolerances_mm = kUsualTolerances_mm);

  /// Some sections more; nothing at the end. The first piece comes after a few thousand lines; memory does not grow
  /// with the program.
  [[nodiscard]] std::optional<std::string> next();

  [[nodiscard]] std::size_t read_bytes() const { return reader_.read_bytes(); }

 private:
  void finish(std::string& bytes);

  ToolpathReader reader_;
  LevelBuilder levels_;
  ToolpathHead head_;
  LevelChunk chunk_;
  bool has_begun_ = false;
  bool is_over_ = false;
};

}  // namespace kerf::rehearsal
