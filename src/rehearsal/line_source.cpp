#include "rehearsal/line_source.hpp"

#include <algorithm>

namespace kerf::rehearsal {

void LineQueue::warn(std::uint32_t line, std::string text) {
  constexpr std::size_t kMost = 100;
  const bool is_known = std::ranges::find(warnings_, text, &TransformWarning::text) != warnings_.end();
  if (!is_known && warnings_.size() < kMost) warnings_.push_back({.line = line, .text = std::move(text)});
}

SourceLine LineQueue::take() {
  SourceLine line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

std::expected<std::optional<SourceLine>, TransformRefusal> ProgramSource::next() {
  if (!next_) return std::nullopt;
  const std::size_t after = program_.offset_after(*next_);
  const std::size_t end = next_->offset_bytes + next_->text.size();
  SourceLine line{
      .text = std::string{next_->text}, .number = next_->number, .end = program_.text().substr(end, after - end)};
  next_ = program_.line_at(after, next_->number + 1);
  return line;
}

std::expected<void, TransformRefusal> LineRewriter::on_end(LineQueue&) {
  return {};
}

std::expected<std::optional<SourceLine>, TransformRefusal> RewritingSource::next() {
  while (queue_.is_empty() && !ended_) {
    auto line = before_->next();
    if (!line) return std::unexpected{std::move(line.error())};
    ended_ = !line->has_value();
    auto done = ended_ ? rewriter_->on_end(queue_) : rewriter_->on_line(*std::move(*line), queue_);
    if (!done) return std::unexpected{std::move(done.error())};
  }
  if (queue_.is_empty()) return std::nullopt;
  return queue_.take();
}

void RewritingSource::rewind() {
  before_->rewind();
  rewriter_->restart();
  queue_.clear();
  ended_ = false;
}

void RewritingSource::collect_warnings(std::deque<TransformWarning>& out) const {
  before_->collect_warnings(out);
  std::ranges::copy(queue_.warnings(), std::back_inserter(out));
}

}  // namespace kerf::rehearsal
