#include "rehearsal/word_rewriter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/text.hpp"
#include "rehearsal/number_text.hpp"
#include "sender/job/line_words.hpp"

namespace kerf::rehearsal {
namespace {

bool is_for_the_controller(std::string_view comment) {
  constexpr std::array<std::string_view, 4> kStarts{"MSG,", "PRINT,", "DEBUG,", "ABORT,"};
  const std::string_view text = base::trim(comment);
  return std::ranges::any_of(kStarts, [text](auto start) { return base::starts_with_ignoring_case(text, start); });
}

}  // namespace

std::expected<void, TransformRefusal> CommentStripper::on_line(SourceLine line, LineQueue& out) {
  if (line.text.find_first_of("(;") == std::string::npos || base::trim(line.text).starts_with('$')) {
    out.put(std::move(line));
    return {};
  }
  std::string kept;
  for (std::size_t at = 0; at < line.text.size() && line.text[at] != ';';) {
    if (line.text[at] != '(') {
      kept += line.text[at++];
      continue;
    }
    const std::size_t close = line.text.find(')', at);
    if (close == std::string::npos) break;
    const std::string_view comment = std::string_view{line.text}.substr(at, close + 1 - at);
    if (form_.keeps_messages && is_for_the_controller(comment.substr(1))) kept += comment;
    at = close + 1;
  }
  const std::size_t last = kept.find_last_not_of(" \t");
  if (last == std::string::npos) return {};
  kept.resize(last + 1);
  line.text = std::move(kept);
  out.put(std::move(line));
  return {};
}

std::expected<void, TransformRefusal> WordScaler::on_line(SourceLine line, LineQueue& out) {
  LineText text(std::move(line.text));
  const std::string_view trimmed = base::trim(text.line());
  if (!trimmed.starts_with('$') && job::needs_a_computer(trimmed, job::words_of(trimmed))) {
    return std::unexpected{TransformRefusal{.line = line.number,
                                            .reason = std::string{"What "} + letter_ +
                                                      " is in this line only the controller knows: it uses parameters, "
                                                      "expressions, subroutines or macros. Have the CAM program write "
                                                      "plain numbers."}};
  }
  // Fine enough for any motor, and short enough for any line.
  constexpr double kShare = 5e-6;
  if (const PlacedWord* const word = text.find(letter_); word != nullptr && !word->digits.empty()) {
    const double value = word->value * factor_;
    const std::string exact = number_text(value, std::abs(value) * 1e-12);
    const std::string digits =
        exact.size() <= word->digits.size() + 3 ? exact : number_text(value, std::abs(value) * kShare);
    text.replace(*word, letter_ + digits);
  }
  line.text = text.text();
  out.put(std::move(line));
  return {};
}

}  // namespace kerf::rehearsal
