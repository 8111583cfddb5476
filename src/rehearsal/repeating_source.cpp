#include "rehearsal/repeating_source.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

bool ends_program(const LineText& text) {
  return text.has_command('M', 2) || text.has_command('M', 30);
}

}  // namespace

RepeatingSource::RepeatingSource(std::unique_ptr<LineSource> before, std::vector<Round> rounds,
                                 const vocabulary::Dialect& dialect)
    : before_(std::move(before)), rounds_(std::move(rounds)), dialect_(&dialect) {}

void RepeatingSource::rewind() {
  before_->rewind();
  for (Round& round : rounds_) {
    if (round.rewriter) round.rewriter->restart();
  }
  round_ = 0;
  has_words_ = false;
  ended_ = false;
  queue_.clear();
}

void RepeatingSource::collect_warnings(std::deque<TransformWarning>& out) const {
  before_->collect_warnings(out);
  std::ranges::copy(queue_.warnings(), std::back_inserter(out));
}

std::expected<void, TransformRefusal> RepeatingSource::begin() {
  has_begun_ = true;
  const auto survey = survey_of(*before_, *dialect_);
  if (!survey) return std::unexpected{survey.error()};
  return check_repeatable(*survey);
}

bool RepeatingSource::begin_next_round() {
  if (round_ + 1 >= rounds_.size()) return false;
  ++round_;
  has_words_ = false;
  before_->rewind();
  return true;
}

std::expected<void, TransformRefusal> RepeatingSource::take(SourceLine line) {
  const LineText text(line.text);
  Round& round = rounds_[round_];
  const bool is_last = round_ + 1 == rounds_.size();
  if (!is_last && ends_program(text)) {
    // The rest of the line is not the end.
    LineText rest(line.text);
    for (const double word : {2, 30}) {
      if (const PlacedWord* const end = rest.find_command('M', word)) rest.erase(*end);
    }
    ended_ = !begin_next_round();
    if (LineText(rest.text()).words().empty()) return {};
    return std::unexpected{TransformRefusal{
        .line = line.number, .reason = "M2 or M30 stands in a line with other words. Give it a line of its own."}};
  }
  // The marks around the program stay around the whole.
  if (base::trim(line.text) == "%" && (has_words_ ? !is_last : round_ > 0)) return {};
  if (!has_words_ && !text.words().empty()) {
    has_words_ = true;
    std::string words = round_ == 0 ? "" : mode_words(gcode::ModalState{}) + " G0";
    if (!round.first_words.empty()) words += (words.empty() ? "" : " ") + round.first_words;
    if (!words.empty()) queue_.put_new(std::move(words), line);
  }
  if (round.rewriter) return round.rewriter->on_line(std::move(line), queue_);
  queue_.put(std::move(line));
  return {};
}

std::expected<std::optional<SourceLine>, TransformRefusal> RepeatingSource::next() {
  if (!has_begun_) {
    if (auto begun = begin(); !begun) return std::unexpected{begun.error()};
  }
  while (queue_.is_empty() && !ended_) {
    auto line = before_->next();
    if (!line) return std::unexpected{std::move(line.error())};
    if (!line->has_value()) {
      ended_ = !begin_next_round();
      continue;
    }
    if (auto done = take(*std::move(*line)); !done) return std::unexpected{std::move(done.error())};
  }
  if (queue_.is_empty()) return std::nullopt;
  return queue_.take();
}

}  // namespace kerf::rehearsal
