#pragma once
// Transforms that look at words and comments only: nothing moves elsewhere.

#include "rehearsal/line_source.hpp"

namespace kerf::rehearsal {

/// Takes comments away, and lines that hold nothing else. What a controller acts on stays: (MSG,...), (PRINT,...).
class CommentStripper : public LineRewriter {
 public:
  explicit CommentStripper(const vocabulary::Dialect& dialect) : form_(job::wire_form_of(dialect)) {}
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override {}

 private:
  job::WireForm form_;
};

/// Multiplies F or S.
class WordScaler : public LineRewriter {
 public:
  WordScaler(char letter, double factor) : letter_(letter), factor_(factor) {}
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override {}

 private:
  char letter_;
  double factor_;
};

}  // namespace kerf::rehearsal
