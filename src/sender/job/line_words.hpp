#pragma once
// The words of one line in wire form, for questions that need no interpreter.

#include <string>
#include <string_view>
#include <vector>

namespace kerf::job {

/// A letter in upper case and the digits behind it, as written.
struct LineWord {
  char letter = 0;
  std::string_view digits{};
  bool operator==(const LineWord&) const = default;
};

/// Words of `line`, comments left out; what is no word is left out too. `$` lines have none.
[[nodiscard]] std::vector<LineWord> words_of(std::string_view line);

/// G0 to G3, cycles, probes: a word that sets the mode of motion.
[[nodiscard]] bool sets_motion(const LineWord& word);

/// The line has axis words that act in the mode of motion in force: no motion word, and no other word that takes them.
[[nodiscard]] bool continues_motion(const std::vector<LineWord>& words);

/// Expressions, parameters, O words, macros and calls: where a line may do something that its words do not say.
[[nodiscard]] bool needs_a_computer(std::string_view line, const std::vector<LineWord>& words);

}  // namespace kerf::job
