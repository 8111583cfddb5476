#pragma once
// A program several times, each time a little different: deeper, or at another work zero.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rehearsal/line_source.hpp"
#include "rehearsal/program_survey.hpp"

namespace kerf::rehearsal {

/// What is different in one round.
struct Round {
  /// Said before its first line with words: "G55".
  std::string first_words{};
  /// Null: nothing changes but that.
  std::unique_ptr<LineRewriter> rewriter{};
};

/// The program's end (M2, M30 and all behind) comes once, in the last round. Before each round but the first the modes
/// are those that the program found when it began.
class RepeatingSource : public LineSource {
 public:
  RepeatingSource(std::unique_ptr<LineSource> before, std::vector<Round> rounds, const vocabulary::Dialect& dialect);
  std::expected<std::optional<SourceLine>, TransformRefusal> next() override;
  void rewind() override;
  void collect_warnings(std::deque<TransformWarning>& out) const override;

 private:
  std::expected<void, TransformRefusal> begin();
  /// A line of the program in this round.
  std::expected<void, TransformRefusal> take(SourceLine line);
  bool begin_next_round();

  std::unique_ptr<LineSource> before_;
  std::vector<Round> rounds_;
  const vocabulary::Dialect* dialect_;
  std::size_t round_ = 0;
  bool has_begun_ = false;
  bool has_words_ = false;
  bool ended_ = false;
  LineQueue queue_;
};

}  // namespace kerf::rehearsal
