#pragma once
// What a silence of the link leaves behind: lines may have got lost in it that nobody counts, because every answer is
// taken for the oldest line's.

#include <algorithm>
#include <cstdint>
#include <optional>

#include "sender/job/executing_lines.hpp"

namespace kerf::job {

/// From the first silence on with lines under way, until a question behind them proves that all of them were answered.
class LinkDoubt {
 public:
  /// The link fell silent; `oldest_line` is the first one of the job without an answer.
  void on_silence(std::uint32_t oldest_line) {
    if (!from_) from_ = oldest_line;
    question_due_ = true;
  }
  /// True once for each silence: ask.
  [[nodiscard]] bool is_question_due() const { return question_due_; }
  void on_asked() { question_due_ = false; }
  /// The question was answered, and lines before it were not; or nothing is owed any more.
  void on_lines_lost() { is_proven_ = from_.has_value(); }
  void on_account_settled() {
    if (!is_proven_) *this = {};
  }

  /// Some line from here on may never have arrived.
  [[nodiscard]] std::optional<std::uint32_t> from_line() const { return from_; }
  [[nodiscard]] ExecutingLines widened(ExecutingLines lines) const {
    if (!from_ || *from_ >= lines.from) return lines;
    return {.from = *from_, .to = std::max(lines.to, *from_), .known_by = ExecutingKnownBy::Silence};
  }

 private:
  std::optional<std::uint32_t> from_;
  bool question_due_ = false;
  bool is_proven_ = false;
};

}  // namespace kerf::job
