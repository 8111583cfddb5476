#pragma once
// The state of the machine at the start of any line of a program, found by reading the lines before it with the
// controller's own interpreter. It says where it is not sure.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "sender/job/line_words.hpp"
#include "sender/job/program_start.hpp"

namespace kerf::job {

/// Why the state at a line is not known, and since which line.
struct StateDoubt {
  std::uint32_t line = 0;
  /// Ends "Line 12 …": "probes, and where it touched is not in the file".
  std::string because;
  bool operator==(const StateDoubt&) const = default;
};

/// What the tool has done so far. Heights are machine coordinates of Z.
struct ToolHistory {
  /// No cut was made above this: ends of fed motions, their beginnings included.
  std::optional<float> highest_cut_mm;
  /// Highest place that the machine was at.
  float highest_mm = 0;
  /// The slowest feed at which the tool went straight down.
  std::optional<float> plunge_mm_per_min;
  /// The dwell that followed the last start of the spindle.
  float spin_up_s = 0;
  bool has_moved = false;
  std::uint32_t motions = 0;
  /// Last line with T or M6 that changed the tool.
  std::uint32_t tool_line = 0;
  /// The last line that changed work offsets, G92 or the tool length.
  std::uint32_t offset_line = 0;
  /// User outputs as last set: digital or not, and number.
  std::map<std::pair<bool, std::uint8_t>, float> outputs;
};

/// Reads one line after the other. Copy it to keep the state of a line.
class ProgramState {
 public:
  /// `reader` as interpreter_at() made it.
  ProgramState(gcode::Interpreter reader, const vocabulary::Dialect& dialect);

  /// The next line, in wire form; it was executed.
  void execute(std::uint32_t number, std::string_view line);

  [[nodiscard]] const gcode::ParserState& parser() const { return reader_.state(); }
  [[nodiscard]] const gcode::Offsets& offsets() const { return reader_.offsets(); }
  [[nodiscard]] const gcode::Interpreter& reader() const { return reader_; }
  [[nodiscard]] const ToolHistory& tool_history() const { return history_; }
  /// Empty when all of it is certain.
  [[nodiscard]] const std::optional<StateDoubt>& doubt() const { return doubt_; }
  /// Words that a canned cycle keeps (Z, R, P, Q …), as last written.
  [[nodiscard]] const std::map<char, std::string>& cycle_words() const { return cycle_words_; }
  /// The word that set the mode of motion in force, and its line; empty before the first.
  [[nodiscard]] const std::string& motion_word() const { return motion_word_; }
  [[nodiscard]] std::uint32_t motion_word_line() const { return motion_word_line_; }
  /// What the last line asked for.
  [[nodiscard]] const std::vector<gcode::Action>& actions() const { return actions_; }
  /// The last line was acknowledged only after all motion before it had ended.
  [[nodiscard]] bool was_waiting() const { return was_waiting_; }
  /// Length of the motion that the last line asked for, as far as that matters: 0 may not have become a block.
  [[nodiscard]] float moved_mm() const { return moved_mm_; }

 private:
  void execute_system(std::uint32_t number, std::string_view line);
  void note_words(std::uint32_t number, const std::vector<LineWord>& words);
  void note_actions(std::uint32_t number, const vocabulary::AxisValues& from);
  void note_motion(const vocabulary::AxisValues& from, const vocabulary::AxisValues& to, const gcode::Feed& feed,
                   float top_mm);
  void settle_actions(std::uint32_t number);
  void doubt(std::uint32_t number, std::string because);
  void open_alternative(std::uint32_t number, const vocabulary::AxisValues& position_mm, std::string because);
  void compare_alternative();

  gcode::Interpreter reader_;
  const vocabulary::Dialect* dialect_;
  /// Where something is not known (where a probe touched), this reader believes the opposite. When both come to the
  /// same state, it did not matter.
  std::optional<gcode::Interpreter> alternative_;
  std::optional<StateDoubt> doubt_;
  bool is_lost_ = false;
  ToolHistory history_;
  std::map<char, std::string> cycle_words_;
  std::string motion_word_;
  std::uint32_t motion_word_line_ = 0;
  bool spindle_started_ = false;
  bool was_waiting_ = false;
  float moved_mm_ = 0;
  std::vector<gcode::Action> actions_;
  std::vector<gcode::Action> other_actions_;
};

}  // namespace kerf::job
