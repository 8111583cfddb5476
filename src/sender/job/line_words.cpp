#include "sender/job/line_words.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

bool is_letter(char letter) {
  return letter >= 'A' && letter <= 'Z';
}

bool is_of_number(char letter) {
  return base::is_digit(letter) || letter == '.' || letter == '-' || letter == '+';
}

/// The number without zeros that say nothing: "01" is "1", "38.20" is "38.2".
double number_of(std::string_view digits) {
  return base::parse_decimal(digits).value_or(-1);
}

template <std::size_t N>
bool is_one_of(double number, const std::array<double, N>& numbers) {
  return std::ranges::find(numbers, number) != numbers.end();
}

/// Words that take the axis words for themselves.
bool takes_axes(const LineWord& word) {
  constexpr std::array<double, 9> kTaking{10, 28, 30, 43.1, 43.2, 51, 52, 92, 65};
  return word.letter == 'G' && is_one_of(number_of(word.digits), kTaking);
}

bool calls_macro(const LineWord& word) {
  constexpr std::array<double, 3> kGCalls{65, 66, 67};
  constexpr std::array<double, 2> kMCalls{98, 99};
  if (word.letter == 'G') return is_one_of(number_of(word.digits), kGCalls);
  return word.letter == 'M' && is_one_of(number_of(word.digits), kMCalls);
}

}  // namespace

std::vector<LineWord> words_of(std::string_view line) {
  std::vector<LineWord> words;
  if (line.starts_with('$')) return words;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ';') break;
    if (line[at] == '(') {
      at = std::min(line.find(')', at), line.size() - 1) + 1;
      continue;
    }
    const char letter = base::to_upper(line[at++]);
    if (!is_letter(letter)) continue;
    const std::size_t first = at;
    while (at < line.size() && is_of_number(line[at])) ++at;
    words.push_back({.letter = letter, .digits = line.substr(first, at - first)});
  }
  return words;
}

bool sets_motion(const LineWord& word) {
  constexpr std::array<double, 23> kMotions{0,    1,  2,  3,  5,  5.1, 33, 33.1, 38.1, 38.2, 38.3, 38.4,
                                            38.5, 73, 76, 80, 81, 82,  83, 84,   85,   86,   89};
  return word.letter == 'G' && is_one_of(number_of(word.digits), kMotions);
}

bool continues_motion(const std::vector<LineWord>& words) {
  constexpr std::string_view kAxisAndArcLetters = "XYZABCUVWIJKR";
  if (std::ranges::any_of(words, [](const LineWord& word) { return sets_motion(word) || takes_axes(word); })) {
    return false;
  }
  return std::ranges::any_of(words, [&](const LineWord& word) { return kAxisAndArcLetters.contains(word.letter); });
}

bool needs_a_computer(std::string_view line, const std::vector<LineWord>& words) {
  if (line.starts_with('$')) return false;
  const std::string_view plain = line.substr(0, line.find('('));
  if (plain.find_first_of("#[") != std::string_view::npos) return true;
  return std::ranges::any_of(words, [](const LineWord& word) { return word.letter == 'O' || calls_macro(word); });
}

}  // namespace kerf::job
