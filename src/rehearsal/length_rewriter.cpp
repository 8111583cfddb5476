#include "rehearsal/length_rewriter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.hpp"
#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::kAxisLetters;

/// From mm to inches and back, numbers with four decimals come back as they were.
constexpr double kInchTolerance = 5.1e-7;
constexpr double kMmTolerance = 2e-5;
constexpr double kFeedInchTolerance = 5e-5;
constexpr double kFeedMmTolerance = 2e-3;

/// Letters besides the axes that are lengths in such a line.
std::string_view other_lengths(const LineFacts& facts) {
  switch (facts.use) {
    case AxisUse::Arc: return "IJKR";
    case AxisUse::Spline: return "IJPQ";
    case AxisUse::Cycle: return "RQ";
    case AxisUse::ToolTable: return "R";
    default: return "";
  }
}

bool has_length(const LineText& text) {
  return std::ranges::any_of(
      text.words(), [](const PlacedWord& word) { return std::string_view{"XYZUVWIJKRF"}.contains(word.letter); });
}

}  // namespace

LengthRewriter::LengthRewriter(LengthStyle style, const vocabulary::Dialect& dialect)
    : style_(style), dialect_(&dialect), reading_(dialect), proof_(dialect) {}

void LengthRewriter::restart() {
  reading_ = ProgramReading(*dialect_);
  proof_ = ProgramReading(*dialect_);
  owed_mm_ = {};
  unit_is_said_ = false;
}

bool LengthRewriter::inches_out(const LineFacts& facts) const {
  return style_.inches.value_or(facts.modal.inches);
}

std::string LengthRewriter::written(double mm, const LineFacts& facts, const PlacedWord& word) const {
  const bool inches = inches_out(facts);
  if (style_.decimals) return rounded_text(mm / (inches ? kMmPerInch : 1.0), *style_.decimals);
  if (inches == facts.modal.inches) return word.digits;
  return inches ? number_text(mm / kMmPerInch, kInchTolerance) : number_text(mm, kMmTolerance);
}

void LengthRewriter::rewrite_axes(LineText& text, const LineFacts& facts) {
  const bool relative = facts.modal.incremental && facts.use != AxisUse::NamesPlace &&
                        facts.use != AxisUse::NamesElsewhere && facts.use != AxisUse::OffsetValue &&
                        facts.use != AxisUse::ToolLength && facts.use != AxisUse::ToolTable &&
                        facts.use != AxisUse::Machine;
  for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis) {
    const PlacedWord* const word = text.find(kAxisLetters[axis]);
    if (word == nullptr || turns(axis)) continue;
    const double mm = facts.words_mm.at(axis);
    double& owed_mm = owed_mm_.at(axis);
    // A full circle must end where it began.
    const bool stays = relative && mm == 0;
    const std::string digits = stays ? "0" : written(relative ? mm + owed_mm : mm, facts, *word);
    const double out_mm = base::parse_decimal(digits).value_or(0) * (inches_out(facts) ? kMmPerInch : 1.0);
    owed_mm = relative ? owed_mm + mm - out_mm : mm - out_mm;
    if (digits != word->digits) text.replace(*word, word->letter + digits);
  }
}

void LengthRewriter::rewrite_other_lengths(LineText& text, const LineFacts& facts) const {
  for (const char letter : other_lengths(facts)) {
    const PlacedWord* const word = text.find(letter);
    if (word == nullptr) continue;
    const std::string digits = written(word->value * unit_mm(facts.modal), facts, *word);
    if (digits != word->digits) text.replace(*word, letter + digits);
  }
}

void LengthRewriter::rewrite_feed(LineText& text, const LineFacts& facts) const {
  const PlacedWord* const word = text.find('F');
  if (word == nullptr || facts.modal.feed_mode == gcode::FeedMode::InverseTime) return;
  const bool inches = inches_out(facts);
  if (inches == facts.modal.inches) return;
  const bool per_turn = facts.modal.feed_mode == gcode::FeedMode::UnitsPerRevolution;
  const double mm = word->value * unit_mm(facts.modal);
  text.replace(*word, "F" + (inches ? number_text(mm / kMmPerInch, per_turn ? kInchTolerance : kFeedInchTolerance)
                                    : number_text(mm, per_turn ? kMmTolerance : kFeedMmTolerance)));
}

void LengthRewriter::rewrite_unit(LineText& text) const {
  if (!style_.inches) return;
  const PlacedWord* const other = text.find_command('G', *style_.inches ? 21 : 20);
  if (other != nullptr) text.replace(*other, *style_.inches ? "G20" : "G21");
}

void LengthRewriter::trim_other_numbers(LineText& text) const {
  if (!style_.decimals) return;
  for (const PlacedWord& word : text.words()) {
    constexpr std::string_view kNumbers = "FSABC";
    if (!kNumbers.contains(word.letter) || !word.digits.contains('.')) continue;
    const std::string digits = number_text(word.value, 0);
    if (digits.size() < word.digits.size()) text.replace(word, word.letter + digits);
  }
}

void LengthRewriter::rewrite(LineText& text, const LineFacts& facts) {
  rewrite_unit(text);
  if (facts.use != AxisUse::Scaling) {
    rewrite_axes(text, facts);
    rewrite_other_lengths(text, facts);
  }
  rewrite_feed(text, facts);
  trim_other_numbers(text);
}

bool LengthRewriter::leads_elsewhere(const LineText& text, const LineFacts& facts, std::uint32_t number) {
  constexpr double kSlack_rad = 5e-3;
  const gcode::ArcMove* const meant = reading_.arc();
  if (meant == nullptr) return !proof_.read(text, number).has_value();
  // An arc that is not taken must not be remembered.
  ProgramReading trial = proof_;
  const auto read = trial.read(text, number);
  if (!read || read->use != facts.use) return true;
  const gcode::ArcMove* const got = trial.arc();
  if (got == nullptr) return true;
  // The firmware allows 0.005 mm between the radii of both ends.
  constexpr double kSlack_mm = 2e-3;
  // Then the words say the same, and what the firmware makes of them is its own affair.
  const bool both_whole = is_whole_circle(facts) && is_whole_circle(*read);
  const double want = swept_rad(*meant, facts.from_machine_mm, *dialect_);
  const double is = swept_rad(*got, read->from_machine_mm, *dialect_);
  const double radius_mm = std::max(static_cast<double>(got->radius_mm), 1e-3);
  const double off_mm = std::abs(static_cast<double>(meant->center_offset_mm[0] - got->center_offset_mm[0])) +
                        std::abs(static_cast<double>(meant->center_offset_mm[1] - got->center_offset_mm[1]));
  if (off_mm > kSlack_mm || (std::abs(want - is) > kSlack_rad + kSlack_mm / radius_mm && !both_whole)) return true;
  proof_ = std::move(trial);
  return false;
}

void LengthRewriter::say_unit(const LineText& text, const SourceLine& line, LineQueue& out) {
  if (text.has_command('G', 20) || text.has_command('G', 21)) unit_is_said_ = true;
  if (!style_.inches || unit_is_said_ || !has_length(text)) return;
  unit_is_said_ = true;
  out.warn(line.number, "No line before says G20 or G21, so the numbers are taken for mm, as after a reset.");
  const std::string word = *style_.inches ? "G20" : "G21";
  out.put_new(word, line);
  static_cast<void>(proof_.read(LineText(word), line.number));
}

std::expected<void, TransformRefusal> LengthRewriter::on_line(SourceLine line, LineQueue& out) {
  LineText text(line.text);
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (facts->is_over || facts->is_system) {
    out.put(std::move(line));
    return {};
  }
  if (style_.inches && facts->use == AxisUse::Spindle) {
    return std::unexpected{TransformRefusal{.line = line.number,
                                            .reason = "The lengths of a thread (G33, G76) stay as they are written. "
                                                      "Have the CAM program write the other unit."}};
  }
  if (style_.inches && text.may_be_skipped() && (text.has_command('G', 20) || text.has_command('G', 21))) {
    return std::unexpected{
        TransformRefusal{.line = line.number,
                         .reason = "The unit may change here or not, as the line begins with '/'. Take that away."}};
  }
  say_unit(text, line, out);
  const ExactValues owed_mm = owed_mm_;
  rewrite(text, *facts);
  const LineText written(text.text());
  if (!leads_elsewhere(written, *facts, line.number)) {
    line.text = written.line();
    out.put(std::move(line));
    return {};
  }
  if (style_.inches || leads_elsewhere(LineText(line.text), *facts, line.number)) {
    return std::unexpected{
        TransformRefusal{.line = line.number,
                         .reason = "Written otherwise this line would lead elsewhere: " + std::string{kFragileCircle}}};
  }
  out.warn(line.number, "Keeps its decimals: with fewer of them the arc would lead elsewhere.");
  owed_mm_ = owed_mm;
  for (std::size_t axis = 0; axis < owed_mm_.size() && !facts->modal.incremental; ++axis) {
    if (has_axis(facts->named, axis)) owed_mm_.at(axis) = 0;
  }
  out.put(std::move(line));
  return {};
}

}  // namespace kerf::rehearsal
