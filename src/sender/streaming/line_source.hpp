#pragma once
// Where the lines of a job come from.

#include <cstdint>
#include <optional>
#include <string_view>

namespace kerf::streaming {

/// A line ready for the wire, without its line end. `text` lives until the source moves on.
struct SourceLine {
  std::uint32_t file_line = 0;
  std::uint64_t file_offset_after = 0;
  std::string_view text;
};

/// Gives one line after another. The streamer looks at the next line before there is room for it, hence two functions.
class LineSource {
 public:
  virtual ~LineSource() = default;
  /// The next line, the same until `move_on`; empty at the end.
  [[nodiscard]] virtual std::optional<SourceLine> next() = 0;
  virtual void move_on() = 0;
};

}  // namespace kerf::streaming
