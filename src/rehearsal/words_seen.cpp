#include "rehearsal/words_seen.hpp"

#include <algorithm>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

bool is_letter(char letter) {
  return letter >= 'A' && letter <= 'Z';
}

/// Takes note of a G word by its number: G28.1 and G30.1 only remember a place.
void note_command(WordsSeen& seen, std::string_view digits) {
  constexpr int kTen = 10;
  constexpr int kMost = 1000;
  int number = 0;
  std::size_t at = 0;
  for (; at < digits.size() && base::is_digit(digits[at]); ++at) {
    number = std::min(number * kTen + (digits[at] - '0'), kMost);
  }
  const bool is_whole = at == digits.size() || digits[at] != '.';
  switch (number) {
    case 10:
    case 92: seen.sets_zero = true; break;
    case 20: seen.inches = true; break;
    case 21: seen.millimetres = true; break;
    case 28:
    case 30: seen.machine_place = seen.machine_place || is_whole; break;
    case 53: seen.machine_place = true; break;
    default: break;
  }
}

}  // namespace

AxisMask WordsSeen::axes() const {
  AxisMask mask = 0;
  for (std::size_t axis = 0; axis < vocabulary::kMaxAxes; ++axis) {
    if (has(vocabulary::kAxisLetters[axis])) mask = static_cast<AxisMask>(mask | axis_bit(axis));
  }
  return mask;
}

WordsSeen words_seen_in(std::string_view wire) {
  WordsSeen seen;
  for (std::size_t at = 0; at < wire.size(); ++at) {
    const char letter = base::to_upper(wire[at]);
    if (letter == '(') {
      // Messages for the operator are the only comments left.
      at = std::min(wire.find(')', at), wire.size() - 1);
      continue;
    }
    if (!is_letter(letter)) continue;
    seen.has_lower_case = seen.has_lower_case || letter != wire[at];
    seen.letters |= 1U << static_cast<unsigned>(letter - 'A');
    if (letter == 'G') note_command(seen, wire.substr(at + 1));
  }
  return seen;
}

}  // namespace kerf::rehearsal
