#pragma once
// The G and M words that a firmware knows, as rows: what a word means, its modal group, and how a strange fraction is
// refused.

#include <array>
#include <cstdint>
#include <span>

#include "common/gcode/block.hpp"

namespace kerf::gcode {

/// What a command word asks for; `CommandRow::argument` says which.
enum class Meaning : std::uint8_t {
  Nothing,  // accepted without effect: G40, G61, G91.1, Rabbit's M6
  Motion,
  NonModal,
  Plane,
  Distance,
  FeedMode,
  Units,
  ToolLength,
  TableToolLength,  // G43 and G43.2 of grblHAL: only with a tool table
  WorkOffset,
  Retract,
  Scaling,
  Macro,
  ProgramFlow,
  OptionalStop,
  Spindle,
  ToolChange,
  ToolSet,
  Coolant,
  Override,
  ParkingOverride,
  SavedState,
  Pin,
  Diameter,      // G7 and G8: only in lathe mode
  SurfaceSpeed,  // G96 and G97: only in lathe mode
  Port,          // grblHAL: only with such a port
};

/// Does a command want the axis words for itself?
enum class Claim : std::uint8_t {
  No,
  IfFree,  // error:24 if another command of the block has them
  Takes,   // without asking
};

struct CommandRow {
  std::uint16_t number = 0;
  /// The fraction, in hundredths: 10 for G28.1.
  std::uint8_t hundredths = 0;
  Group group = Group::None;
  Meaning meaning = Meaning::Nothing;
  std::uint8_t argument = 0;
  Claim claim = Claim::No;
  AxisCommand claims_as = AxisCommand::None;
  /// Answer to a fraction that no row of this number has; Ok where any fraction is taken. Counts in the number's first
  /// row only.
  ErrorCode bad_fraction = ErrorCode::CommandValueNotInteger;
  /// The claim is looked at before the fraction is refused.
  bool claims_before_fraction = false;
};

/// Rows found by number. Rows of one number stand together, in any order of numbers.
class CommandTable {
 public:
  CommandTable(std::span<const CommandRow> g_rows, std::span<const CommandRow> m_rows);

  /// All rows of a G or M number; empty if the firmware does not know it.
  [[nodiscard]] std::span<const CommandRow> g(std::uint64_t number) const { return find(g_rows_, g_first_, number); }
  [[nodiscard]] std::span<const CommandRow> m(std::uint64_t number) const { return find(m_rows_, m_first_, number); }

 private:
  static constexpr std::size_t kNumbers = 100;
  static constexpr std::uint8_t kNone = 0xFF;
  using Index = std::array<std::uint8_t, kNumbers>;

  static Index indexed(std::span<const CommandRow> rows);
  static std::span<const CommandRow> find(std::span<const CommandRow> rows, const Index& first, std::uint64_t number);

  std::span<const CommandRow> g_rows_;
  std::span<const CommandRow> m_rows_;
  Index g_first_;
  Index m_first_;
};

[[nodiscard]] const CommandTable& grbl_commands();
[[nodiscard]] const CommandTable& rabbit_commands();
[[nodiscard]] const CommandTable& grblhal_commands();

}  // namespace kerf::gcode
