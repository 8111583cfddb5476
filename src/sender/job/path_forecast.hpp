#pragma once
// Where the machine has to be while it executes the lines that were sent: the path of the program itself, whatever
// became of its bytes on the wire.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/gcode/line_reader.hpp"
#include "common/motion/rules.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::job {

using vocabulary::AxisMask;
using vocabulary::AxisValues;

/// What the forecast needs to know about how the machine moves.
struct PathRules {
  motion::MotionRules motion{};
  motion::MotionSettings settings{};
  /// Blocks that can wait behind the one that is executing.
  int planner_blocks = 0;
};

/// A straight piece of the path, machine coordinates, mm. A piece of no length is a pause.
struct PathPiece {
  AxisValues start_mm{};
  AxisValues end_mm{};
  /// Axes whose place is not known here: behind a probe, a tool change.
  AxisMask unknown_axes = 0;
  std::uint32_t file_line = 0;
  /// N word; 0 without one.
  std::int32_t line_number = 0;
  /// Programmed speed along the piece; 0 where it says nothing about the speed of the tool (rapids, threads, pauses).
  float feed_mm_per_min = 0;
  /// Programmed spindle speed; empty while it is off or follows something else.
  std::optional<float> spindle_rpm{};
  bool rapid = false;
  /// Nobody gets here in less time, counted from the beginning of the forecast, whatever the overrides.
  double reached_s = 0;
  double least_s = 0;
  /// Planner blocks up to and including this one.
  std::uint64_t blocks = 0;
};

/// Reads lines as they are sent with the controller's own interpreter, and keeps the path between what has surely been
/// executed and what was sent last. From a line on that it cannot follow (an expression, a macro, a refused line) it
/// says nothing more: the path is open there.
class PathForecast {
 public:
  /// `reader` stands where the last line leads; the machine was last seen at `at_mm`, and may still be on its way.
  void begin(const gcode::Interpreter& reader, const AxisValues& at_mm, const PathRules& rules);
  /// Knows nothing from here on, and says why.
  void open(std::uint32_t file_line, std::string_view reason);

  /// The operator sends a line by hand while the job waits for its tool: the place, and what else the line may set, are
  /// known again once the machine is seen at rest.
  void on_work_by_hand(std::string_view text);
  /// The controller changes a tool, and moves as it likes.
  void on_tool_state();
  /// Some place is not known, and nothing is on its way that could change it.
  [[nodiscard]] bool seeks_place() const { return shadow_.has_value() && unanswered_.empty(); }
  /// The machine rests at `at_mm`, everything is answered, and machine positions are `offset_mm` more than work
  /// positions: from here on the place is known again. False where that does not tell enough.
  bool stand(const AxisValues& at_mm, const AxisValues& offset_mm);

  /// A line leaves: nothing of it can have been executed before.
  void on_sent(std::uint32_t file_line, std::string_view text);
  /// The oldest line that was sent and not yet answered has its `ok`.
  void on_acknowledged();

  /// Pieces that may not have been executed yet, oldest first.
  [[nodiscard]] const std::deque<PathPiece>& pieces() const { return pieces_; }
  /// Number of the first of them, counted from the beginning.
  [[nodiscard]] std::uint64_t first_piece() const { return first_piece_; }
  /// The first piece that need not be over yet, as far as answers tell: a line that waits for the end of motion was
  /// answered, or the planner cannot hold more.
  [[nodiscard]] std::uint64_t surely_over() const { return surely_over_; }
  /// The pieces before `piece` have been executed.
  void forget_before(std::uint64_t piece);

  /// The path is not known behind the last piece.
  [[nodiscard]] bool is_open() const { return open_reason_.has_value(); }
  [[nodiscard]] std::uint32_t open_from_line() const { return open_from_line_; }
  /// Why, as the end of a sentence; empty while the path is known.
  [[nodiscard]] std::string open_reason() const { return open_reason_.value_or(""); }

  /// Line sent last, and line answered last; 0 before the first.
  [[nodiscard]] std::uint32_t line_sent() const { return line_sent_; }
  [[nodiscard]] std::uint32_t line_acknowledged() const { return line_acknowledged_; }
  /// An offset between work and machine positions, and the line that sets it, counted in lines sent.
  struct WorkOffset {
    std::uint64_t line = 0;
    AxisValues mm{};
  };
  /// Those that may be in force: Grbl already counts with a new one while it waits for the motion before it, and tells
  /// it afterwards (gnea/grbl gcode.c, system.c).
  [[nodiscard]] const std::deque<WorkOffset>& work_offsets() const { return work_offsets_; }
  [[nodiscard]] const PathRules& rules() const { return rules_; }

 private:
  struct SentLine {
    std::uint32_t file_line = 0;
    /// Number of the piece behind this line's last one.
    std::uint64_t end = 0;
    bool waits_for_motion = false;
  };

  [[nodiscard]] std::optional<std::string_view> why_unreadable(std::string_view text) const;
  [[nodiscard]] std::string_view as_read(std::string_view text);
  [[nodiscard]] std::optional<std::string_view> read(SentLine& line, std::string_view text);
  [[nodiscard]] std::optional<std::string_view> read_shadow(std::string_view text);
  [[nodiscard]] std::optional<std::string_view> add(const gcode::Action& action, std::size_t index, SentLine& line);
  void add_line(const AxisValues& end_mm, const gcode::Feed& feed, std::uint32_t file_line, AxisMask unknown);
  [[nodiscard]] std::optional<std::string_view> add_arc(const gcode::ArcMove& move, std::uint32_t file_line,
                                                        AxisMask unknown);
  /// Whether a hole is drilled once more hangs on the last bit of offsets that are told with three digits
  /// (gcode/act_cycle.cpp): behind the move of a drilling cycle at `index` a second stroke may come, or not.
  void add_strokes_by_chance(std::size_t index, std::uint32_t file_line);
  void add_pause(std::uint32_t file_line);
  void begin_doubt(const AxisValues& from_mm);
  void begin_doubt_everywhere();
  /// Neither place nor tool length is known.
  void begin_tool_doubt();
  [[nodiscard]] AxisMask doubt_about(std::size_t index) const;
  void note_work_offset();
  [[nodiscard]] double least_time_s(const AxisValues& way_mm, double length_mm, const gcode::Feed& feed) const;

  std::optional<gcode::Interpreter> reader_;
  std::optional<gcode::LineReader> lines_;
  /// Reads the same lines from another place, after a motion of which the end is not known: axes on which the two agree
  /// are known all the same.
  std::optional<gcode::Interpreter> shadow_;
  PathRules rules_;
  AxisValues at_mm_{};
  AxisMask doubtful_at_ = 0;
  /// More than one offset may have been set, and the controller told their sum.
  bool knows_only_sum_ = false;
  double reached_s_ = 0;
  std::uint64_t blocks_ = 0;
  std::deque<PathPiece> pieces_;
  std::uint64_t first_piece_ = 0;
  std::uint64_t surely_over_ = 0;
  std::deque<SentLine> unanswered_;
  std::deque<WorkOffset> work_offsets_;
  std::uint64_t lines_sent_ = 0;
  std::uint64_t lines_answered_ = 0;
  std::uint32_t line_sent_ = 0;
  std::uint32_t line_acknowledged_ = 0;
  std::optional<std::string> open_reason_;
  std::uint32_t open_from_line_ = 0;
  /// Of one line, kept for their memory.
  std::vector<gcode::Action> actions_;
  std::vector<gcode::Action> shadow_actions_;
};

}  // namespace kerf::job
