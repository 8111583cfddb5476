#pragma once
// A program read line by line as Kerf would send it, by the machine's own interpreter. Nothing is planned, so it is
// fast: who needs times and places to the step asks the virtual controller (job_estimate.hpp).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/gcode/line_reader.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/job/operations.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/wire_form.hpp"
#include "simulation/case_runner.hpp"

namespace kerf::rehearsal {

/// Which tool cuts, as the program tells it: the one of the last M6, or of the last T in programs that only tell
/// numbers.
class ToolInUse {
 public:
  void on_words(const job::FlowWords& words);
  /// Empty before the first is told.
  [[nodiscard]] const std::optional<int>& number() const { return number_; }

 private:
  std::optional<int> selected_;
  std::optional<int> number_;
  bool has_changes_ = false;
};

/// One line of the file.
struct WalkedLine {
  /// From 1.
  std::uint32_t number = 0;
  /// As the file has it, without the line end.
  std::string_view text{};
  /// As the interpreter gets it; empty when nothing is sent.
  std::string_view wire{};
  /// The controller refuses the line, and nothing of it happens.
  std::optional<gcode::ErrorCode> refused{};
  /// Axes that the line names.
  vocabulary::AxisMask axes = 0;
  /// G53, G28 or G30: where that is, only a machine that was homed knows.
  bool in_machine_coordinates = false;
  /// `$H`, or another command to the machine of which nobody knows where it ends.
  bool ends_elsewhere = false;
};

/// The interpreter of `machine`, switched on at its zero, with the offsets that it keeps.
[[nodiscard]] gcode::Interpreter interpreter_of(const simulation::CaseMachine& machine);

/// Reads on whatever a line does: refused lines are passed over, probes touch at their target, tools are changed at
/// once.
class ProgramWalk {
 public:
  /// `text` must outlive it; any line ends. The walk ends with the program (M2, M30, the second `%`).
  ProgramWalk(std::string_view text, gcode::Interpreter reader, const vocabulary::Dialect& dialect);

  /// The next line, valid until the one after it; null at the end.
  const WalkedLine* next();

  /// What the line asks for.
  [[nodiscard]] const std::vector<gcode::Action>& actions() const { return actions_; }
  /// Where the parser stood before the line, and how it stands behind it.
  [[nodiscard]] const gcode::AxisValues& start_mm() const { return start_mm_; }
  [[nodiscard]] const gcode::Interpreter& reader() const { return reader_; }
  [[nodiscard]] const std::optional<int>& tool() const { return tool_.number(); }
  /// Index in `operations()`, of which the first is "": before an operation is named.
  [[nodiscard]] std::uint16_t operation() const { return operation_; }
  [[nodiscard]] const std::vector<std::string>& operations() const { return operations_; }
  [[nodiscard]] std::size_t read_bytes() const { return offset_; }
  [[nodiscard]] std::uint32_t refused_lines() const { return refused_lines_; }

 private:
  bool take_text();
  void note_operation();
  void prepare();
  void execute();
  void execute_system();
  void settle();
  std::string_view as_read(std::string_view wire);

  std::string_view text_;
  std::size_t offset_ = 0;
  gcode::Interpreter reader_;
  const vocabulary::Dialect* dialect_;
  gcode::LineReader lines_;
  job::WireForm form_;
  WalkedLine line_;
  std::string wire_;
  std::vector<gcode::Action> actions_;
  gcode::AxisValues start_mm_{};
  ToolInUse tool_;
  job::OperationFinder finder_;
  std::vector<std::string> operations_{""};
  std::unordered_map<std::string, std::uint16_t> operation_numbers_{{"", 0}};
  std::uint16_t operation_ = 0;
  std::uint32_t refused_lines_ = 0;
  bool has_percent_ = false;
  bool is_over_ = false;
};

}  // namespace kerf::rehearsal
