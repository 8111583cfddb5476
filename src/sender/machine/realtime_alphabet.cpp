#include "sender/machine/realtime_alphabet.hpp"

#include <algorithm>
#include <cstddef>

#include "common/base/text.hpp"

namespace kerf::machine {
namespace {

using vocabulary::Realtime;

constexpr std::uint8_t kTopBit = 0x80;

bool is_legacy_realtime(char letter) {
  return letter == static_cast<char>(Realtime::StatusQuery) || letter == static_cast<char>(Realtime::FeedHold) ||
         letter == static_cast<char>(Realtime::CycleStart);
}

bool has_twins(const vocabulary::Dialect& dialect) {
  return acts_on(dialect.firmware, Realtime::FeedHoldAlternate);
}

/// grblHAL keeps them in `$` and `[` lines and in `( )` comments, not behind `;` (protocol.md 2).
bool is_in_text(std::string_view line, std::size_t at) {
  if (line.starts_with('$') || line.starts_with('[')) return true;
  const std::string_view before = line.substr(0, at);
  const auto open = before.rfind('(');
  if (open == std::string_view::npos || before.find(')', open) != std::string_view::npos) return false;
  return before.substr(0, open).find(';') == std::string_view::npos;
}

std::string name_of(char letter) {
  const auto* const row = vocabulary::find_realtime(static_cast<std::uint8_t>(letter));
  return row == nullptr ? "a realtime command" : std::string{row->name};
}

std::string eaten_sentence(char letter, const vocabulary::Dialect& dialect) {
  std::string sentence = std::string{"The line holds '"} + letter + "', which " + std::string{dialect.name} +
                         " obeys at once (" + name_of(letter) + ") instead of storing it";
  return sentence + (has_twins(dialect) ? ": leave it out, or set $39=0 first so that $ lines and ( ) comments keep it."
                                        : ": leave it out.");
}

}  // namespace

bool carries_text(std::string_view line) {
  return line.starts_with('$') || line.starts_with('[') || line.contains('(') || line.contains(';');
}

std::uint8_t byte_for(Realtime command, const vocabulary::Dialect& dialect, bool text_under_way) {
  const auto byte = static_cast<std::uint8_t>(command);
  if (!text_under_way || !is_legacy_realtime(static_cast<char>(byte))) return byte;
  const auto rows = vocabulary::realtime_rows();
  const auto twin = std::ranges::find_if(rows, [&](const vocabulary::RealtimeRow& row) {
    return row.alternate_of == command && static_cast<std::uint8_t>(row.byte) >= kTopBit &&
           acts_on(dialect.firmware, row.byte);
  });
  return twin == rows.end() ? byte : static_cast<std::uint8_t>(twin->byte);
}

std::optional<std::string> why_eaten(std::string_view line, const vocabulary::Dialect& dialect, bool texts_keep) {
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char letter = line[at];
    if (letter < ' ' || letter > '~') {
      return "The line holds " + base::escape(line.substr(at, 1)) +
             ", which is no plain ASCII: controllers drop such bytes or obey them at once. Leave it out.";
    }
    if (!is_legacy_realtime(letter) || (texts_keep && is_in_text(line, at))) continue;
    if (!texts_keep) return eaten_sentence(letter, dialect);
    return std::string{"The line holds '"} + letter + "' outside of a $ line or a ( ) comment, where " +
           std::string{dialect.name} + " obeys it at once (" + name_of(letter) + "): leave it out.";
  }
  return std::nullopt;
}

}  // namespace kerf::machine
