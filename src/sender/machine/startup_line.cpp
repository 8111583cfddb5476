#include "sender/machine/startup_line.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <vector>

#include "common/base/text.hpp"

namespace kerf::machine {
namespace {

struct Word {
  char letter = 0;
  double value = 0;
};

/// Words of a block in its stored form; nothing when it is more than words: an expression, a `$` command.
std::optional<std::vector<Word>> words_of(std::string_view block) {
  std::vector<Word> words;
  while (!block.empty()) {
    const char letter = block.front();
    const std::size_t end = std::min(block.find_first_not_of("0123456789.+-", 1), block.size());
    const auto value = base::parse_decimal(block.substr(1, end - 1));
    if (letter < 'A' || letter > 'Z' || !value) return std::nullopt;
    words.push_back({.letter = letter, .value = *value});
    block.remove_prefix(end);
  }
  return words;
}

bool has(const std::vector<Word>& words, char letter, std::initializer_list<double> values) {
  return std::ranges::any_of(words, [&](const Word& word) {
    return word.letter == letter && std::ranges::find(values, word.value) != values.end();
  });
}

std::string deed_of_block(std::string_view block) {
  const auto words = words_of(block);
  if (!words) return "may move the axes";
  // Go to a stored place, or probe: they move with axis words and without.
  if (has(*words, 'G', {28, 30, 38.2, 38.3, 38.4, 38.5})) return "moves the axes";
  // Axis words that only set an offset, or a scale.
  const bool sets_only = has(*words, 'G', {10, 28.1, 30.1, 43.1, 50, 51, 52, 92});
  const bool has_axes = std::ranges::any_of(
      *words, [](const Word& word) { return std::string_view{"XYZABCUVWHIJK"}.contains(word.letter); });
  if (has_axes && !sets_only) return "moves the axes";
  if (has(*words, 'M', {3, 4})) return "starts the spindle";
  if (has(*words, 'M', {6})) return "asks for a tool change";
  if (has(*words, 'M', {7, 8})) return "starts the coolant";
  return {};
}

}  // namespace

bool is_startup_line(std::string_view id) {
  return id.size() == 2 && base::to_upper(id[0]) == 'N' && base::is_digit(id[1]);
}

std::string stored_form_of(std::string_view block) {
  std::string stored;
  bool in_comment = false;
  for (const char letter : block) {
    if (letter == ';') break;
    if (letter == '(') in_comment = true;
    if (!in_comment && !base::is_blank(letter)) stored += base::to_upper(letter);
    if (letter == ')') in_comment = false;
  }
  return stored;
}

// grblHAL takes several blocks with `|` between them (protocol.md 8).
std::string deed_of_startup_line(std::string_view block) {
  const std::string stored = stored_form_of(block);
  for (const std::string_view part : base::split(stored, '|')) {
    if (std::string deed = deed_of_block(part); !deed.empty()) return deed;
  }
  return {};
}

}  // namespace kerf::machine
