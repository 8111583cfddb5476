// Text that looks like expressions, assignments, O words and printed comments: no crash, no undefined behaviour, no
// endless line. Bytes choose pieces, so that the fuzzer gets deep with few of them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/interpreter.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace kerf::gcode;
  static constexpr std::array<std::string_view, 64> kPieces = {
      "[",     "]",     "#",      "#1",      "#<a>",   "#<_x>",   "#5221",   "=",       "+",    "-",       "*",
      "/",     "**",    "MOD",    "AND",     "OR",     "XOR",     "EQ",      "NE",      "GT",   "GE",      "LT",
      "LE",    "ABS[",  "ACOS[",  "ASIN[",   "ATAN[",  "COS[",    "EXP[",    "FIX[",    "FUP[", "LN[",     "ROUND[",
      "SIN[",  "SQRT[", "TAN[",   "EXISTS[", "PRM[",   "O1",      "O<b>",    "O[",      "IF[",  "ELSEIF[", "ELSE",
      "ENDIF", "CALL",  "ERROR[", "ALARM[",  "WHILE[", "(print,", "(debug,", "(abort,", ")",    "%d",      "%.2f",
      "G65P3", "X",     "G1F1",   "1",       "2.5",    "99999",   "\n",      "N5",      "<"};
  const GcodeRules& rules = rules_for(*kerf::vocabulary::find_dialect("grblhal-expr"));
  Interpreter interpreter(rules, {.prints_debug = true});
  std::vector<Action> actions;
  std::string line;
  const auto finish = [&] {
    actions.clear();
    static_cast<void>(interpreter.interpret(line, actions));
    line.clear();
  };
  for (std::size_t at = 0; at < size; ++at) {
    const std::string_view piece = kPieces.at(bytes[at] % kPieces.size());
    if (piece == "\n" || line.size() + piece.size() > rules.line.length_max) finish();
    if (piece != "\n") line += piece;
  }
  finish();
  return 0;
}
