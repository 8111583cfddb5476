#pragma once
// For the tests: an interpreter behind a line reader, with everything that it answered and did.

#include <string>
#include <utility>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/gcode/line_reader.hpp"

namespace kerf::gcode {

inline constexpr vocabulary::Firmware kAllFirmwares[] = {vocabulary::Firmware::Grbl, vocabulary::Firmware::Rabbit,
                                                         vocabulary::Firmware::GrblHal};

/// grblHAL built with expressions.
inline const GcodeRules& expression_rules() {
  return rules_for(*vocabulary::find_dialect("grblhal-expr"));
}

/// An interpreter that is fed bytes, with what it answered and did.
struct Bench {
  explicit Bench(vocabulary::Firmware firmware, InterpreterSettings settings = {})
      : Bench(rules_for(firmware), settings) {}
  explicit Bench(const GcodeRules& rules, InterpreterSettings settings = {})
      : interpreter(rules, settings), reader(rules.line) {}

  /// The answer to one line: 0 or the error's number.
  int send(std::string line) {
    line += '\n';
    int answer = -1;
    for (const char byte : line) {
      const auto read = reader.push(byte);
      if (!read) continue;
      if (read->overlong) {
        answer = 11;
      } else {
        const auto result = interpreter.interpret(read->text, actions);
        answer = result ? 0 : static_cast<int>(result.error());
      }
    }
    return answer;
  }

  template <typename T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const Action& action : actions)
      if (const T* hit = std::get_if<T>(&action)) found.push_back(*hit);
    return found;
  }

  [[nodiscard]] const ParserState& state() const { return interpreter.state(); }

  Interpreter interpreter;
  LineReader reader;
  std::vector<Action> actions;
};

}  // namespace kerf::gcode
