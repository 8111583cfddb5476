#include "rehearsal/zero_rewriter.hpp"

#include <utility>

namespace kerf::rehearsal {

std::expected<void, TransformRefusal> ZeroRewriter::on_line(SourceLine line, LineQueue& out) {
  LineText text(std::move(line.text));
  constexpr double kFirst = 54;
  constexpr double kBehindLast = 60;
  for (const PlacedWord& word : text.words()) {
    if (word.letter == 'G' && word.value >= kFirst && word.value < kBehindLast) text.replace(word, zero_);
  }
  line.text = text.text();
  out.put(std::move(line));
  return {};
}

}  // namespace kerf::rehearsal
