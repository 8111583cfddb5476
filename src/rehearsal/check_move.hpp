#pragma once
// What the rules of a check see: lines with the words they have, and moves with what they do to the work.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/gcode/action.hpp"
#include "common/gcode/parser_state.hpp"
#include "common/vocabulary/axis.hpp"
#include "rehearsal/check_machine.hpp"
#include "rehearsal/words_seen.hpp"

namespace kerf::rehearsal {

/// A line that the controller takes.
struct CheckedLine {
  std::uint32_t number = 0;
  std::string_view text;
  std::string_view wire;
  WordsSeen words{};
  /// Before the line, and behind it.
  gcode::ModalState before{};
  const gcode::ParserState& after;
};

/// What a move does to the work.
enum class MoveKind : std::uint8_t {
  Rapid,
  Plunge,    ///< fed straight down into the material
  Approach,  ///< fed straight down, and not below the work zero: through the air, or into stock that stands on it
  Cut,       ///< fed sideways, in the material as far as one can tell
  Air,       ///< fed, but not in the material
  Probe,
};

struct CheckedMove {
  const CheckedLine& line;
  AxisValues from_mm{};
  AxisValues to_mm{};
  const gcode::Feed& feed;
  const gcode::ArcMove* arc = nullptr;  ///< null: a straight line
  MoveKind kind{};
  /// Axes whose place is known where the move begins and where it ends: in work coordinates, and in machine coordinates
  /// if the machine's offsets are known.
  AxisMask known_from = 0;
  AxisMask known_to = 0;
  /// Axes whose place says nothing, not even compared with that of another move.
  AxisMask lost_from = 0;
  AxisMask lost_to = 0;
  /// Machine position less this is the work position.
  AxisValues work_offset_mm{};
  /// Places can be compared as long as this is the same.
  std::uint32_t frame = 0;

  [[nodiscard]] bool goes_sideways() const;
};

constexpr std::size_t kZ = 2;
/// Heights that differ by less are the same.
constexpr float kSameHeightMm = 0.001F;

/// "X 12.5", for people.
[[nodiscard]] std::string place_on(std::size_t axis, float mm);
/// At most three decimals, none that are zero.
[[nodiscard]] std::string short_mm(float mm);

/// Tells cuts from moves through the air: a tool that went down with a feed is in the material until it goes up.
class CutWatch {
 public:
  /// Of a move whose places are set.
  [[nodiscard]] MoveKind kind_of(const CheckedMove& move);

 private:
  bool is_down_ = false;
};

}  // namespace kerf::rehearsal
