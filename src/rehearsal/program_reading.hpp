#pragma once
// Reads a program line by line with a controller's own interpreter, for transforms: what each line does with its axis
// words, in which modes, and where it leads in the program's own coordinates, as exactly as they were written.

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/gcode/interpreter.hpp"
#include "common/vocabulary/dialect.hpp"
#include "rehearsal/line_text.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::rehearsal {

using vocabulary::AxisMask;

/// Why a program cannot be transformed.
struct TransformRefusal {
  /// Of the file; 0 where no line is to blame.
  std::uint32_t line = 0;
  /// Whole sentences: what stands in the way, and what to do.
  std::string reason{};
  bool operator==(const TransformRefusal&) const = default;
};
BOOST_DESCRIBE_STRUCT(TransformRefusal, (), (line, reason))

/// One value an axis, mm, as exact as the text.
using ExactValues = std::array<double, vocabulary::kMaxAxes>;

inline constexpr double kMmPerInch = 25.4;
inline constexpr std::size_t kX = 0;
inline constexpr std::size_t kY = 1;
inline constexpr std::size_t kZ = 2;

[[nodiscard]] constexpr AxisMask mask_of_axis(std::size_t axis) {
  return static_cast<AxisMask>(1U << axis);
}
[[nodiscard]] constexpr bool has_axis(AxisMask mask, std::size_t axis) {
  return (mask >> axis & 1U) != 0;
}

/// A, B and C: not measured in mm.
[[nodiscard]] constexpr bool turns(std::size_t axis) {
  return axis >= 3 && axis <= 5;
}

/// Where the program is, in the coordinates that its words have at this line; only of known axes.
struct ProgramPlace {
  ExactValues mm{};
  AxisMask known = 0;
};

/// Who takes the axis words of a line.
enum class AxisUse : std::uint8_t {
  Nobody,
  Line,            ///< G0, G1
  Arc,             ///< G2, G3
  Probe,           ///< G38
  Cycle,           ///< G73, G81 to G89
  Spline,          ///< G5, G5.1
  Spindle,         ///< G33, G76
  Machine,         ///< G53
  Home,            ///< G28, G30, on the way there
  NamesPlace,      ///< G92, and G10 L20 of the zero in force: the present place gets this name
  NamesElsewhere,  ///< G10 L20 of another zero
  OffsetValue,     ///< G10 L2
  ToolTable,       ///< G10 L1, L10, L11
  ToolLength,      ///< G43.1
  Scaling,         ///< G51
};

/// What a line does.
struct LineFacts {
  AxisUse use = AxisUse::Nobody;
  /// Modes in which its words are read.
  gcode::ModalState modal{};
  gcode::ModalState before{};
  AxisMask named = 0;
  /// As written, in mm.
  ExactValues words_mm{};
  ProgramPlace from{};
  ProgramPlace to{};
  /// Machine coordinates of a machine whose zeros are all the same; for what the words alone do not tell.
  vocabulary::AxisValues from_machine_mm{};
  bool is_rapid = false;
  /// Coordinates of these axes have other names from here on, by how much is not known.
  AxisMask renamed = 0;
  /// M2 or M30, or a line behind it: nothing below is executed.
  bool ends = false;
  bool is_over = false;
  bool changes_tool = false;
  /// `$` lines.
  bool is_system = false;
  /// G28.1, G30.1.
  bool stores_home = false;
};

/// Millimetres in the unit of a line's words.
[[nodiscard]] inline double unit_mm(const gcode::ModalState& modal) {
  return modal.inches ? kMmPerInch : 1.0;
}

class ProgramReading {
 public:
  explicit ProgramReading(const vocabulary::Dialect& dialect);

  /// `number` is for the refusal.
  std::expected<LineFacts, TransformRefusal> read(const LineText& line, std::uint32_t number);

  /// What the last line asked for.
  [[nodiscard]] const std::vector<gcode::Action>& actions() const { return actions_; }
  /// The arc among them; null where there is none.
  [[nodiscard]] const gcode::ArcMove* arc() const;
  [[nodiscard]] const gcode::Interpreter& interpreter() const { return interpreter_; }
  [[nodiscard]] const ProgramPlace& place() const { return place_; }
  [[nodiscard]] const vocabulary::Dialect& dialect() const { return *dialect_; }

 private:
  std::expected<void, TransformRefusal> read_system(const LineText& line, std::uint32_t number, LineFacts& facts);
  std::expected<void, TransformRefusal> execute(std::string_view words, std::uint32_t number);
  [[nodiscard]] bool is_written_oddly(const LineText& line);
  void settle_actions();
  void note_words(const LineText& line, LineFacts& facts) const;
  void note_renaming(const LineText& line, LineFacts& facts) const;
  void follow(const LineText& line, const LineFacts& facts);
  void follow_cycle(const LineText& line, const LineFacts& facts);

  const vocabulary::Dialect* dialect_;
  job::WireForm form_;
  gcode::Interpreter interpreter_;
  std::vector<gcode::Action> actions_;
  ProgramPlace place_;
  bool is_over_ = false;
  std::string wire_;
};

/// Settings of a machine that has everything: what a transform can read is not limited by equipment.
[[nodiscard]] gcode::InterpreterSettings settings_for_reading(const vocabulary::Dialect& dialect);

/// Where the axis words of a line point, by the words alone: also where the machine then goes on to, or never arrives.
[[nodiscard]] ProgramPlace pointed_at(const LineFacts& facts);

/// The arc of this line is a whole circle, by its words.
[[nodiscard]] bool is_whole_circle(const LineFacts& facts);

/// Of such a circle, where the firmware's floats see none: it has 32 bits to find that out, and what they hold depends
/// on where work zero is.
inline constexpr std::string_view kCircleWarning =
    "A whole circle: at some places this firmware takes it for no arc at all, because its sums are rounded. Two half "
    "circles are safe.";

/// Why an arc cannot be written with other numbers (arc.cpp, kFullCircle).
inline constexpr std::string_view kFragileCircle =
    "whether this arc is a whole circle or nothing hangs on the last bit of the controller's sums. Begin it at a place "
    "that was named with the same numbers, or make two arcs of it.";

/// The angle that an arc runs through, signed, full turns included, in radians.
[[nodiscard]] double swept_rad(const gcode::ArcMove& arc, const vocabulary::AxisValues& from_mm,
                               const vocabulary::Dialect& dialect);

}  // namespace kerf::rehearsal
