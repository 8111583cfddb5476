#pragma once
// The words of a program that say where it stops, waits and ends.

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "sender/machine/features.hpp"

namespace kerf::job {

/// What one line asks of whoever sends it.
struct FlowWords {
  bool pauses = false;             ///< M0, M60
  bool pauses_optionally = false;  ///< M1
  bool ends_program = false;       ///< M2, M30
  bool changes_tool = false;       ///< M6
  std::optional<int> tool{};       ///< T
  /// Seconds of G4 P; negative where they are computed.
  std::optional<double> dwell_s{};
  bool operator==(const FlowWords&) const = default;
};
BOOST_DESCRIBE_STRUCT(FlowWords, (), (pauses, pauses_optionally, ends_program, changes_tool, tool, dwell_s))

/// Reads a line in wire form: no blanks, comments only as `(MSG,…)`. Words with computed values are passed over.
[[nodiscard]] FlowWords flow_words_of(std::string_view text);

/// The text of the first `(MSG,…)` of a line as the file has it; empty if there is none.
[[nodiscard]] std::string_view message_in(std::string_view line);

/// `text` (wire form) without every word `letter``number`, such as M6.
[[nodiscard]] std::string without_word(std::string_view text, char letter, int number);

/// Who carries out an M6.
enum class ToolChanges {
  ByController,  ///< its own Tool state, or a changer
  ByOperator,    ///< the controller refuses or overlooks M6: Kerf holds the line back and the operator changes the tool
};
BOOST_DESCRIBE_ENUM(ToolChanges, ByController, ByOperator)

/// A controller whose owner has set it to ignore M6 (a mode, `$341`) does as it is told; one that knows no other way
/// does not change tools, whatever it answers.
[[nodiscard]] ToolChanges tool_changes_on(const machine::ToolChangeFact& controller);

/// A tool change at which the program waits.
struct ToolGate {
  std::uint32_t file_line = 0;
  std::optional<int> tool{};
  /// The operator changes it before the line is sent; else the line is on its way, and what comes behind it waits until
  /// the controller has left its Tool state: nothing then lies unread in its buffer while the operator measures.
  bool by_operator = false;
  bool operator==(const ToolGate&) const = default;
};
BOOST_DESCRIBE_STRUCT(ToolGate, (), (file_line, tool, by_operator))

/// A message to the operator that becomes due once `after_line` is acknowledged.
struct DueMessage {
  std::uint32_t after_line = 0;
  std::uint32_t file_line = 0;
  std::string text{};
  bool operator==(const DueMessage&) const = default;
};
BOOST_DESCRIBE_STRUCT(DueMessage, (), (after_line, file_line, text))

/// What to do with the next line of the file.
enum class Passage {
  Send,
  LeaveOut,
  Wait,  ///< at a tool gate: ask again once it is passed
  End,   ///< behind M2, M30 or the closing `%`: nothing more is sent
};
BOOST_DESCRIBE_ENUM(Passage, Send, LeaveOut, Wait, End)

/// Reads the program along with whoever feeds it, line by line, and tells what the job has to know.
class ProgramFlow {
 public:
  /// `tells_messages`: the controller drops `(MSG,…)`, so Kerf tells them.
  ProgramFlow(ToolChanges changes, bool tells_messages) : changes_(changes), tells_messages_(tells_messages) {}

  /// Line `number` of the file as it stands there, and what of it would go to the wire; M6 is taken out of that where
  /// the operator changes tools.
  [[nodiscard]] Passage admit(std::uint32_t number, std::string_view line, std::string& wire);
  /// Lines from `line` on are read again.
  void go_back_to(std::uint32_t line);

  /// The tool change that holds the next line back.
  [[nodiscard]] const std::optional<ToolGate>& gate() const { return gate_; }
  /// The operator has changed the tool.
  void pass_gate();
  /// The line that ended the program, and what the file still holds behind it is not sent; 0 while there is none.
  [[nodiscard]] std::uint32_t end_line() const { return end_line_; }
  /// Messages of which everything before has been acknowledged.
  [[nodiscard]] std::vector<DueMessage> take_messages(std::uint32_t acknowledged_line);

 private:
  void note_message(std::uint32_t number, std::string_view line);

  ToolChanges changes_;
  bool tells_messages_ = false;
  std::optional<ToolGate> gate_;
  std::uint32_t passed_gate_at_ = 0;
  std::optional<int> tool_;
  std::uint32_t last_sent_ = 0;
  std::uint32_t message_noted_at_ = 0;
  std::uint32_t end_line_ = 0;
  bool has_begun_ = false;
  std::deque<DueMessage> messages_;
};

}  // namespace kerf::job
