#pragma once
// The motion word in force in a program that is written, so that a line says one where it must.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rehearsal/line_text.hpp"

namespace kerf::rehearsal {

class ModalMotion {
 public:
  /// `line` was written as it is.
  void note(const LineText& line);
  /// The line is to be read with G `word`: an own word is changed, and one is added where another mode is in force.
  void say(LineText& line, int word);

 private:
  /// G0 is in force before the first.
  double word_ = 0;
};

/// Puts `words` in the places of the words with `letters`: each in its own letter's place, others into what is free,
/// the rest behind. Places that are left over are given up.
void put_words(LineText& line, std::string_view letters, std::vector<std::pair<char, std::string>> words);

}  // namespace kerf::rehearsal
