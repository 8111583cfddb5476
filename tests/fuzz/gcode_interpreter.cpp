// Any bytes through line reader and interpreter of every firmware: no crash, no undefined behaviour, no endless line.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/gcode/line_reader.hpp"
#include "common/gcode/modal_words.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace kerf::gcode;
  using kerf::vocabulary::Firmware;
  if (size == 0) return 0;
  constexpr Firmware kFirmwares[] = {Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};
  const GcodeRules& rules = bytes[0] % 4 == 3 ? rules_for(*kerf::vocabulary::find_dialect("grblhal-expr"))
                                              : rules_for(kFirmwares[bytes[0] % 4]);
  Interpreter interpreter(rules, {.axes = 3 + bytes[0] / 4 % 4, .laser_mode = bytes[0] >= 128});
  LineReader reader(rules.line);
  std::vector<Action> actions;
  std::string words;
  for (std::size_t at = 1; at < size; ++at) {
    const auto line = reader.push(static_cast<char>(bytes[at]));
    if (!line || line->overlong) continue;
    actions.clear();
    words.clear();
    if (line->text.starts_with("$J=")) {
      if (const auto jog = interpreter.interpret_jog(line->text.substr(3))) interpreter.sync_position(jog->target_mm);
    } else if (!interpreter.interpret(line->text, actions)) {
      reader.block_failed();
    }
    append_modal_words(interpreter.state(), interpreter.offsets(), rules, {}, words);
  }
  return 0;
}
