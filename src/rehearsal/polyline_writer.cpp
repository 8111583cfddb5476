#include "rehearsal/polyline_writer.hpp"

#include <utility>

#include "common/base/text.hpp"
#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::kAxisLetters;

}  // namespace

void PolylineWriter::pass(const LineText& text, const LineFacts& facts) {
  motion_.note(text);
  for (std::size_t axis = 0; axis < written_mm_.size(); ++axis) {
    const bool goes_on = facts.use == AxisUse::Line && facts.modal.incremental;
    const double way_mm = facts.to.mm.at(axis) - facts.from.mm.at(axis);
    if (goes_on) {
      written_mm_.at(axis) += way_mm;
    } else if (has_axis(facts.named, axis) || way_mm != 0) {
      written_mm_.at(axis) = facts.to.mm.at(axis);
    }
  }
}

std::string PolylineWriter::axis_words(const LineFacts& facts, const ExactValues& place_mm, AxisMask axes,
                                       std::string_view gap) {
  std::string words;
  for (std::size_t axis = 0; axis < place_mm.size(); ++axis) {
    if (!has_axis(axes, axis)) continue;
    const double unit = turns(axis) ? 1.0 : unit_mm(facts.modal);
    double& written_mm = written_mm_.at(axis);
    const double from_mm = facts.modal.incremental ? written_mm : 0.0;
    const std::string digits = length_text((place_mm.at(axis) - from_mm) / unit, unit);
    written_mm = from_mm + base::parse_decimal(digits).value_or(0) * unit;
    if (!words.empty()) words += gap;
    (words += kAxisLetters[axis]) += digits;
  }
  return words;
}

void PolylineWriter::put(LineText text, const LineFacts& facts, const SourceLine& line,
                         const std::vector<ExactValues>& places_mm, AxisMask axes, int motion, std::string_view dropped,
                         LineQueue& out) {
  // In inverse time each move has its share of the minutes.
  const PlacedWord* const feed = text.find('F');
  const bool is_timed = feed != nullptr && facts.modal.feed_mode == gcode::FeedMode::InverseTime;
  const double rate = is_timed ? feed->value * static_cast<double>(places_mm.size()) : 0.0;
  constexpr double kShare = 5e-6;
  const std::string timed = is_timed ? "F" + number_text(rate, rate * kShare) : std::string{};
  std::string words = axis_words(facts, places_mm.front(), axes, text.gap());
  motion_.say(text, motion);
  for (const PlacedWord& word : text.words()) {
    const auto axis = vocabulary::axis_of(word.letter);
    if (is_timed && word.letter == 'F') {
      text.replace(word, timed);
    } else if (!dropped.contains(word.letter) && !axis) {
      continue;
    } else if (!words.empty()) {
      text.replace(word, words);
      words.clear();
    } else {
      text.erase(word);
    }
  }
  out.put(
      {.text = text.text(), .number = line.number, .end = places_mm.size() > 1 && line.end.empty() ? "\n" : line.end});
  for (std::size_t at = 1; at < places_mm.size(); ++at) {
    words = axis_words(facts, places_mm[at], axes, text.gap());
    out.put_new(timed.empty() ? std::move(words) : words.append(text.gap()).append(timed), line);
  }
}

}  // namespace kerf::rehearsal
