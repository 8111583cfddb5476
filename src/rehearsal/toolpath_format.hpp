#pragma once
// Toolpaths as bytes for whoever draws them: docs/toolpath_format.md.
//
// A sequence of sections, each with a tag and its length, so that a reader can show what has come so far and pass over
// what it does not know. Numbers lie in arrays as a graphics card takes them: little-endian, aligned to their size,
// places as 32-bit floats. Steps from vertex to vertex would be half as long, but every reader would have to add them
// up before it could draw. JSON would be four times as long.

#include <array>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "rehearsal/toolpath_levels.hpp"
#include "rehearsal/toolpath_time.hpp"

namespace kerf::rehearsal {

/// Comes first.
struct ToolpathHead {
  /// Of the program, as job::Program::hash() spells it: 32 hex digits.
  std::string hash;
  /// Of the levels from 1 on, ascending.
  std::vector<float> tolerances_mm;
  bool operator==(const ToolpathHead&) const = default;
};

/// By PathVertex::operation.
struct ToolpathNames {
  std::vector<std::string> operations;
  bool operator==(const ToolpathNames&) const = default;
};

struct ToolpathTimes {
  std::vector<TimeMark> marks;
  bool operator==(const ToolpathTimes&) const = default;
};

/// Everything has come.
struct ToolpathEnd {
  std::uint64_t vertices = 0;
  std::uint32_t refused_lines = 0;
  double time_s = 0;
  PathBounds bounds{};
  bool operator==(const ToolpathEnd&) const = default;
};

/// A section whose tag this reader does not know.
struct ToolpathUnknown {
  std::array<char, 4> tag{};
};

using ToolpathItem = std::variant<ToolpathHead, LevelChunk, ToolpathNames, ToolpathTimes, ToolpathEnd, ToolpathUnknown>;

[[nodiscard]] std::string encode(const ToolpathHead& head);
/// Times keep 24 bits, counted from the chunk's beginning.
[[nodiscard]] std::string encode(const LevelChunk& chunk);
[[nodiscard]] std::string encode(const ToolpathNames& names);
[[nodiscard]] std::string encode(const ToolpathTimes& times);
[[nodiscard]] std::string encode(const ToolpathEnd& end);

enum class ToolpathFault {
  Incomplete,  ///< more bytes may make it a section
  NotAligned,  ///< a length that no section has
  WrongSize,   ///< counts that do not fit the section's length
  BadValue,    ///< a number that no encoder writes
};
BOOST_DESCRIBE_ENUM(ToolpathFault, Incomplete, NotAligned, WrongSize, BadValue)

/// Takes the first section off `bytes`, which stays as it is where that fails. Total: any bytes give an item or a
/// fault, and no more memory than a few times their length.
[[nodiscard]] std::expected<ToolpathItem, ToolpathFault> take_toolpath_item(std::string_view& bytes);

}  // namespace kerf::rehearsal
