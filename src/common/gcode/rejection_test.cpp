// Properties of the interpreter: rejection changes nothing, any bytes are survived.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

/// Lines out of pieces that are words more often than not.
rc::Gen<std::string> line_gen() {
  const std::vector<std::string> pieces = {
      "G0",    "G1",    "G2",  "G3",  "G4",      "G10",   "G17", "G18",   "G20", "G21",   "G28", "G28.1",
      "G38.2", "G43.1", "G49", "G51", "G53",     "G54",   "G55", "G59.1", "G66", "G73",   "G80", "G81",
      "G83",   "G90",   "G91", "G92", "G92.1",   "G92.3", "G93", "G94",   "G99", "M0",    "M2",  "M3",
      "M5",    "M6",    "M8",  "M9",  "M50",     "M61",   "M70", "M72",   "X1",  "X-2.5", "Y3",  "Z-1",
      "A1",    "I1",    "J1",  "K0",  "R1",      "R-2",   "P1",  "P0",    "Q1",  "L2",    "L20", "F100",
      "F0",    "S500",  "T1",  "N5",  "(MSG,a)", "/",     "%",   ";",     " ",   "#",     "5"};
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces)),
                      [](const std::vector<std::string>& chosen) {
                        std::string line;
                        for (const std::string& piece : chosen) line += piece;
                        return line;
                      });
}

/// What grblHAL and Rabbit change although they reject the line, taken out of the comparison.
ParserState without_slips(ParserState state, const ParserState& before) {
  state.tool = before.tool;
  state.feed_rate = before.feed_rate;
  state.canned = before.canned;
  state.scale_factor = before.scale_factor;
  state.modal.scaling = before.modal.scaling;
  state.modal_macro = before.modal_macro;
  state.arriving_tool = before.arriving_tool;
  return state;
}

RC_GTEST_PROP(InterpreterProperty, RejectionLeavesTheStateAlone, ()) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    for (const std::string& line : *rc::gen::container<std::vector<std::string>>(line_gen())) {
      const ParserState before = bench.state();
      const Offsets offsets = bench.interpreter.offsets();
      const std::vector<Action> actions = bench.actions;
      const bool macro_after_motion = before.modal_macro.has_value();
      if (bench.send(line) == 0 || macro_after_motion) continue;
      RC_ASSERT(without_slips(bench.state(), before) == before);
      RC_ASSERT(bench.interpreter.offsets() == offsets);
      RC_ASSERT(bench.actions == actions);
      if (firmware == Firmware::Grbl) RC_ASSERT(bench.state() == before);
    }
  }
}

RC_GTEST_PROP(InterpreterProperty, TakesAnyBytes, (const std::vector<std::string>& lines)) {
  for (const Firmware firmware : kAllFirmwares) {
    Bench bench(firmware);
    for (const std::string& line : lines) {
      bench.send(line);
      (void)bench.interpreter.interpret_jog(line);
    }
  }
  Bench bench(expression_rules());
  for (const std::string& line : lines) {
    bench.send(line);
    (void)bench.interpreter.interpret_jog(line);
  }
}

}  // namespace
}  // namespace kerf::gcode
