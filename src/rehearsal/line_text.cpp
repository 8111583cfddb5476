#include "rehearsal/line_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

bool is_letter(char letter) {
  return letter >= 'A' && letter <= 'Z';
}

bool is_of_number(char letter) {
  return base::is_digit(letter) || letter == '.' || letter == '-' || letter == '+';
}

/// The word at `at`, which has a letter there.
PlacedWord word_at(std::string_view line, std::size_t at) {
  PlacedWord word{.letter = base::to_upper(line[at]), .begin = at, .end = at + 1};
  for (++at; at < line.size() && (is_of_number(line[at]) || base::is_blank(line[at])); ++at) {
    if (base::is_blank(line[at])) continue;
    word.digits += line[at];
    word.end = at + 1;
  }
  if (word.digits.starts_with('+')) word.digits.erase(0, 1);
  if (const auto value = base::parse_decimal(word.digits)) {
    word.value = *value;
  } else {
    word.digits.clear();
  }
  return word;
}

std::vector<PlacedWord> words_in(std::string_view line) {
  std::vector<PlacedWord> words;
  const std::string_view trimmed = base::trim(line);
  if (trimmed.starts_with('$')) return words;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ';') break;
    if (line[at] == '(') {
      at = std::min(line.find(')', at), line.size() - 1) + 1;
      continue;
    }
    if (!is_letter(base::to_upper(line[at]))) {
      ++at;
      continue;
    }
    words.push_back(word_at(line, at));
    at = words.back().end;
  }
  return words;
}

}  // namespace

int PlacedWord::whole() const {
  constexpr double kMost = 1e9;
  return static_cast<int>(std::clamp(value, -kMost, kMost));
}

LineText::LineText(std::string line) : line_(std::move(line)), words_(words_in(line_)) {
  for (std::size_t at = 1; at < words_.size(); ++at) {
    is_spaced_ = is_spaced_ || words_[at].begin > words_[at - 1].end;
  }
  // One word alone does not tell.
  is_spaced_ = is_spaced_ || words_.size() < 2;
}

const PlacedWord* LineText::find(char letter) const {
  const auto found = std::ranges::find(words_, letter, &PlacedWord::letter);
  return found == words_.end() ? nullptr : &*found;
}

const PlacedWord* LineText::find_command(char letter, double number) const {
  const auto found = std::ranges::find_if(words_, [&](const PlacedWord& word) {
    return word.letter == letter && !word.digits.empty() && std::round(word.value * 10) == std::round(number * 10);
  });
  return found == words_.end() ? nullptr : &*found;
}

std::string LineText::plain_words(std::span<const int> without_m) const {
  std::string plain;
  for (const PlacedWord& word : words_) {
    const bool is_left_out = word.letter == 'M' && !word.digits.empty() && std::trunc(word.value) == word.value &&
                             std::ranges::find(without_m, word.whole()) != without_m.end();
    if (!is_left_out) (plain += word.letter) += word.digits;
  }
  return plain;
}

bool LineText::may_be_skipped() const {
  return base::trim(line_).starts_with('/');
}

void LineText::replace(const PlacedWord& word, std::string_view text) {
  edits_.push_back({.begin = word.begin, .end = word.end, .text = std::string{text}});
}

void LineText::insert_before(const PlacedWord& word, std::string_view text) {
  edits_.push_back({.begin = word.begin, .end = word.begin, .text = std::string{text} + (is_spaced_ ? " " : "")});
}

void LineText::insert_after(const PlacedWord& word, std::string_view text) {
  edits_.push_back({.begin = word.end, .end = word.end, .text = (is_spaced_ ? " " : "") + std::string{text}});
}

void LineText::append(std::string_view text) {
  if (!words_.empty()) {
    insert_after(words_.back(), text);
  } else {
    edits_.push_back({.begin = 0, .end = 0, .text = std::string{text} + (line_.empty() ? "" : " ")});
  }
}

void LineText::erase(const PlacedWord& word) {
  const auto is_gap = [this](std::size_t at) { return line_[at] == ' ' || line_[at] == '\t'; };
  std::size_t begin = word.begin;
  std::size_t end = word.end;
  while (begin > 0 && is_gap(begin - 1)) --begin;
  // The first word gives up the blanks behind it.
  if (begin == 0) {
    begin = word.begin;
    while (end < line_.size() && is_gap(end)) ++end;
  }
  edits_.push_back({.begin = begin, .end = end, .text = {}});
}

std::string LineText::text() const {
  // Of two in one place the earlier comes first.
  std::vector<std::size_t> order(edits_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [this](std::size_t at) { return std::tuple{edits_[at].begin, edits_[at].end, at}; });
  std::string result;
  std::size_t at = 0;
  for (const std::size_t index : order) {
    const Edit& edit = edits_[index];
    if (edit.begin > at) result.append(line_, at, edit.begin - at);
    result += edit.text;
    at = std::max(at, edit.end);
  }
  return result.append(line_, std::min(at, line_.size()));
}

}  // namespace kerf::rehearsal
