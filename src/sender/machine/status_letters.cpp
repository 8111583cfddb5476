#include "sender/machine/status_letters.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::machine {
namespace {

using vocabulary::FeedbackText;
using vocabulary::MachineState;

struct InputLetter {
  char letter;
  bool Inputs::* input;
};
constexpr std::array kInputLetters{
    InputLetter{'P', &Inputs::probe},
    InputLetter{'O', &Inputs::probe_disconnected},
    InputLetter{'D', &Inputs::door},
    InputLetter{'H', &Inputs::feed_hold},
    InputLetter{'S', &Inputs::cycle_start},
    InputLetter{'R', &Inputs::reset},
    InputLetter{'E', &Inputs::emergency_stop},
    InputLetter{'F', &Inputs::motor_fault},
    InputLetter{'M', &Inputs::motor_warning},
    InputLetter{'L', &Inputs::block_delete},
    InputLetter{'T', &Inputs::optional_stop_off},
    InputLetter{'Q', &Inputs::single_block},
};

/// The member that a `[GC:]` word belongs to.
struct ModeWord {
  std::string_view start;  ///< of the word, up to a point or its end
  std::string ParserModes::* mode;
};
constexpr std::array kModeWords{
    ModeWord{"G0", &ParserModes::motion},
    ModeWord{"G1", &ParserModes::motion},
    ModeWord{"G2", &ParserModes::motion},
    ModeWord{"G3", &ParserModes::motion},
    ModeWord{"G5", &ParserModes::motion},
    ModeWord{"G33", &ParserModes::motion},
    ModeWord{"G38", &ParserModes::motion},
    ModeWord{"G73", &ParserModes::motion},
    ModeWord{"G76", &ParserModes::motion},
    ModeWord{"G80", &ParserModes::motion},
    ModeWord{"G81", &ParserModes::motion},
    ModeWord{"G82", &ParserModes::motion},
    ModeWord{"G83", &ParserModes::motion},
    ModeWord{"G84", &ParserModes::motion},
    ModeWord{"G85", &ParserModes::motion},
    ModeWord{"G86", &ParserModes::motion},
    ModeWord{"G89", &ParserModes::motion},
    ModeWord{"G54", &ParserModes::work_coordinates},
    ModeWord{"G55", &ParserModes::work_coordinates},
    ModeWord{"G56", &ParserModes::work_coordinates},
    ModeWord{"G57", &ParserModes::work_coordinates},
    ModeWord{"G58", &ParserModes::work_coordinates},
    ModeWord{"G59", &ParserModes::work_coordinates},
    ModeWord{"G17", &ParserModes::plane},
    ModeWord{"G18", &ParserModes::plane},
    ModeWord{"G19", &ParserModes::plane},
    ModeWord{"G20", &ParserModes::units},
    ModeWord{"G21", &ParserModes::units},
    ModeWord{"G90", &ParserModes::distance},
    ModeWord{"G91", &ParserModes::distance},
    ModeWord{"G93", &ParserModes::feed_mode},
    ModeWord{"G94", &ParserModes::feed_mode},
    ModeWord{"G95", &ParserModes::feed_mode},
    ModeWord{"G43", &ParserModes::tool_length},
    ModeWord{"G49", &ParserModes::tool_length},
    ModeWord{"M3", &ParserModes::spindle},
    ModeWord{"M4", &ParserModes::spindle},
    ModeWord{"M5", &ParserModes::spindle},
    ModeWord{"M7", &ParserModes::coolant},
    ModeWord{"M8", &ParserModes::coolant},
    ModeWord{"M9", &ParserModes::coolant},
};

/// Words after which `$#` may print something else (protocol.md 1.2, 9.1).
constexpr std::array<std::string_view, 9> kOffsetWords{"G10", "G28.1", "G30.1", "G43", "G49",
                                                       "G92", "M6",    "$TPW",  "$TLR"};

bool contains_ignoring_case(std::string_view line, std::string_view word) {
  const auto same = [](char left, char right) { return base::to_upper(left) == right; };
  return !std::ranges::search(line, word, same).empty();
}

}  // namespace

Inputs inputs_of(std::string_view letters) {
  Inputs inputs;
  for (const char letter : letters) {
    const auto* const known = std::ranges::find(kInputLetters, letter, &InputLetter::letter);
    if (known != kInputLetters.end()) {
      inputs.*(known->input) = true;
    } else if (vocabulary::axis_of(letter) || letter == 'W') {
      inputs.limits += letter;
    } else {
      inputs.other += letter;
    }
  }
  return inputs;
}

Accessories accessories_of(std::string_view letters) {
  Accessories on;
  for (const char letter : letters) {
    switch (letter) {
      case 'S': on.spindle = SpindleTurn::Clockwise; break;
      case 'C': on.spindle = SpindleTurn::Counterclockwise; break;
      case 'F': on.flood = true; break;
      case 'M': on.mist = true; break;
      case 'E': on.encoder_fault = true; break;
      case 'T': on.tool_change_pending = true; break;
      default: on.other += letter;
    }
  }
  return on;
}

ParserModes modes_of(const std::vector<std::string>& words, double mm_per_unit) {
  ParserModes modes;
  for (const std::string& word : words) {
    if (word.starts_with('F')) {
      modes.feed_mm_per_min = base::parse_decimal(std::string_view{word}.substr(1));
      if (modes.feed_mm_per_min) *modes.feed_mm_per_min *= mm_per_unit;
    } else if (word.starts_with('S')) {
      modes.spindle_rpm = base::parse_decimal(std::string_view{word}.substr(1));
    }
    const std::string_view start = std::string_view{word}.substr(0, word.find('.'));
    const auto* const known = std::ranges::find(kModeWords, start, &ModeWord::start);
    if (known == kModeWords.end()) continue;
    std::string& mode = modes.*(known->mode);
    mode += (mode.empty() ? "" : " ") + word;
  }
  return modes;
}

LineEffect effect_of(std::string_view line) {
  const std::string_view text = base::trim(line);
  if (text.empty() || text == "%") return {};
  LineEffect effect{.parser_state = !text.starts_with('$'), .offsets = false};
  // Most lines of a job have none of the letters that these words begin with.
  const bool may_have_word = std::ranges::any_of(text, [](char letter) {
    const char upper = base::to_upper(letter);
    return upper == 'G' || upper == 'M' || upper == '$';
  });
  if (!may_have_word) return effect;
  effect.offsets = std::ranges::any_of(kOffsetWords, [&](auto word) { return contains_ignoring_case(text, word); });
  if (base::starts_with_ignoring_case(text, "$RST=")) effect = {.parser_state = true, .offsets = true};
  // Homing Z clears grblHAL's tool length reference.
  if (base::starts_with_ignoring_case(text, "$H")) effect.offsets = true;
  return effect;
}

MachineState waits_in(FeedbackText text) {
  switch (text) {
    case FeedbackText::ResetToContinue:
    case FeedbackText::UnlockRequired:
    case FeedbackText::EmergencyStop:
    case FeedbackText::MotorFault:
    case FeedbackText::HomingRequired: return MachineState::Alarm;
    case FeedbackText::CheckDoor: return MachineState::Door;
    case FeedbackText::ReferenceToolEstablished:
    case FeedbackText::PressCycleStart:
    case FeedbackText::RemoveTouchPlate:
    case FeedbackText::ProbeFailed:
    case FeedbackText::ProbeToolFirst:
    case FeedbackText::PositionForTouchOff: return MachineState::Tool;
    default: return MachineState::Unknown;
  }
}

}  // namespace kerf::machine
