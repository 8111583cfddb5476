#include "rehearsal/part_source.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/base/text.hpp"
#include "rehearsal/number_text.hpp"
#include "rehearsal/program_survey.hpp"
#include "sender/job/program_start.hpp"

namespace kerf::rehearsal {
namespace {

constexpr AxisMask kSpace = mask_of_axis(kX) | mask_of_axis(kY) | mask_of_axis(kZ);
/// Of feeds and speeds.
constexpr double kRateTolerance = 1e-3;

std::unexpected<TransformRefusal> refuse(std::uint32_t line, std::string reason) {
  return std::unexpected{TransformRefusal{.line = line, .reason = std::move(reason)}};
}

bool is_cut(const LineFacts& facts) {
  return (facts.use == AxisUse::Line && !facts.is_rapid) || facts.use == AxisUse::Arc || facts.use == AxisUse::Cycle ||
         facts.use == AxisUse::Spline;
}

}  // namespace

PartSource::PartSource(std::unique_ptr<LineSource> before, ProgramPart part, const vocabulary::Dialect& dialect)
    : before_(std::move(before)), part_(part), dialect_(&dialect), past_(fresh_past()), written_(dialect) {}

PartSource::Past PartSource::fresh_past() const {
  gcode::Interpreter interpreter(gcode::rules_for(*dialect_), settings_for_reading(*dialect_));
  return {.reading = ProgramReading(*dialect_), .state = job::ProgramState(std::move(interpreter), *dialect_)};
}

void PartSource::rewind() {
  before_->rewind();
  past_ = fresh_past();
  written_ = ProgramReading(*dialect_);
  motion_ = {};
  has_begun_ = false;
  ended_ = false;
  last_ = {};
  queue_.clear();
}

void PartSource::collect_warnings(std::deque<TransformWarning>& out) const {
  before_->collect_warnings(out);
  std::ranges::copy(queue_.warnings(), std::back_inserter(out));
}

void PartSource::note(const LineText& text, const LineFacts& facts, std::uint32_t number) {
  const bool renames = facts.use == AxisUse::NamesPlace || facts.use == AxisUse::NamesElsewhere ||
                       facts.use == AxisUse::OffsetValue || facts.use == AxisUse::Scaling;
  if (renames) past_.renaming_line = number;
  for (int word = 54; word <= 59; ++word)
    past_.zero_was_selected = past_.zero_was_selected || text.has_command('G', word);
  if (const PlacedWord* const tool = text.find('T')) past_.tool = tool->whole();
  if (facts.changes_tool) past_.tool_in_spindle = past_.tool.value_or(0);
  if (text.has_command('G', 49)) past_.length_word.clear();
  if (text.has_command('G', 43)) {
    const PlacedWord* const entry = text.find('H');
    past_.length_word = entry == nullptr ? "G43" : "G43 H" + entry->digits;
  }
  if (text.has_command('G', 43.1)) {
    const double mm = facts.words_mm[kZ];
    past_.length_word = "G43.1 Z" + number_text(mm, kLengthTolerance_mm);
  }
  if (text.has_command('M', 3) || text.has_command('M', 4)) past_.starts_spindle = true;
  if (const PlacedWord* const dwell = text.find('P'); past_.starts_spindle && text.has_command('G', 4) && dwell) {
    past_.dwell_s = dwell->value;
    past_.starts_spindle = false;
  }
  past_.told |= facts.to.known;
  if (facts.use == AxisUse::Line && has_axis(facts.to.known, kZ)) {
    past_.highest_mm = std::max(past_.highest_mm.value_or(facts.to.mm[kZ]), facts.to.mm[kZ]);
  }
}

PartSource::Done PartSource::pass(const SourceLine& line) {
  const LineText text(line.text);
  const auto facts = past_.reading.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (facts->is_over || facts->ends) {
    return refuse(line.number, "The program ends here, before the part begins. Begin in front of this line.");
  }
  wire_.clear();
  job::append_wire_form(wire_, line.text, job::wire_form_of(*dialect_));
  past_.state.execute(line.number, wire_);
  note(text, *facts, line.number);
  return {};
}

void PartSource::say_modes(const SourceLine& like) {
  gcode::ModalState modes;
  std::string words = mode_words(modes);
  if (past_.zero_was_selected) {
    words += ' ';
    words += job::work_offset_name(past_.reading.interpreter().state().modal.work_offset);
  }
  queue_.put_new(std::move(words), like);
}

void PartSource::say_tool(const SourceLine& like) {
  if (part_.approaches && past_.tool_in_spindle) {
    queue_.put_new("T" + std::to_string(*past_.tool_in_spindle) + " M6", like);
  }
  // Where nothing changes tools, or where the next one is told already.
  if (part_.approaches && past_.tool && past_.tool != past_.tool_in_spindle) {
    queue_.put_new("T" + std::to_string(*past_.tool), like);
  }
  if (!past_.length_word.empty()) queue_.put_new(past_.length_word, like);
}

void PartSource::say_spindle(const SourceLine& like) {
  const auto& state = past_.reading.interpreter().state();
  if (state.spindle_rpm > 0 || state.modal.spindle != gcode::SpindleDirection::Off) {
    std::string words = "S" + number_text(static_cast<double>(state.spindle_rpm), kRateTolerance);
    if (state.modal.spindle == gcode::SpindleDirection::Clockwise) words = "M3 " + words;
    if (state.modal.spindle == gcode::SpindleDirection::Counterclockwise) words = "M4 " + words;
    queue_.put_new(std::move(words), like);
    const bool turns = state.modal.spindle != gcode::SpindleDirection::Off;
    if (turns && past_.dwell_s > 0) queue_.put_new("G4 P" + number_text(past_.dwell_s, kRateTolerance), like);
  }
  if (state.modal.coolant.mist) queue_.put_new("M7", like);
  if (state.modal.coolant.flood) queue_.put_new("M8", like);
}

PartSource::Done PartSource::approach(const SourceLine& like) {
  const ProgramPlace& place = past_.reading.place();
  // A laser's program may never speak of Z.
  constexpr AxisMask kPlane = mask_of_axis(kX) | mask_of_axis(kY);
  if ((place.known & (kPlane | (past_.told & kSpace))) != (kPlane | (past_.told & kSpace))) {
    return refuse(like.number,
                  "No line before has said where X, Y and Z are when it begins (G28, G53, a tool change or a "
                  "probe may have been in between). Begin at a line behind the next move that says it.");
  }
  const auto word = [&](std::size_t axis, double mm) {
    return vocabulary::kAxisLetters[axis] + number_text(mm, kLengthTolerance_mm);
  };
  const double height_mm = place.mm[kZ];
  const double safe_mm = std::max(past_.highest_mm.value_or(height_mm), height_mm);
  const bool has_height = has_axis(past_.told, kZ);
  if (has_height) queue_.put_new("G0 " + word(kZ, safe_mm), like);
  queue_.put_new("G0 " + word(kX, place.mm[kX]) + " " + word(kY, place.mm[kY]), like);
  if (!has_height || height_mm == safe_mm) return {};
  const auto plunge = past_.state.tool_history().plunge_mm_per_min;
  const auto& state = past_.reading.interpreter().state();
  const float feed = plunge.value_or(state.modal.feed_mode == gcode::FeedMode::UnitsPerMinute ? state.feed_rate : 0.0F);
  if (feed <= 0) return refuse(like.number, "It begins deep, and no line before says how fast the tool may plunge.");
  queue_.put_new("G1 " + word(kZ, height_mm) + " F" + number_text(static_cast<double>(feed), kRateTolerance), like);
  return {};
}

PartSource::Done PartSource::begin(const SourceLine& first) {
  has_begun_ = true;
  if (part_.first_line <= 1) return {};
  if (past_.renaming_line != 0) {
    return refuse(past_.renaming_line,
                  "This line moves work zero or scales, and a part that begins behind it would lie "
                  "elsewhere. Do that before the program.");
  }
  if (const auto& doubt = past_.state.doubt()) {
    return refuse(doubt->line, "This line " + doubt->because + "; a part that begins behind it would begin blindly.");
  }
  const auto& state = past_.reading.interpreter().state();
  if (gcode::is_canned_cycle(state.modal.motion)) {
    return refuse(first.number, "A drilling cycle is in force here. Begin at the line that begins it, or behind G80.");
  }
  say_modes(first);
  say_tool(first);
  // A laser must not burn on its way.
  const bool is_laser = !has_axis(past_.told, kZ);
  if (!is_laser) say_spindle(first);
  if (part_.approaches) {
    if (auto done = approach(first); !done) return done;
  }
  if (is_laser) say_spindle(first);
  // And now the modes in which the part was written.
  const bool by_minute = state.modal.feed_mode == gcode::FeedMode::UnitsPerMinute;
  std::string words = mode_words(state.modal);
  if (words != mode_words(gcode::ModalState{})) queue_.put_new(std::move(words), first);
  if (by_minute && state.feed_rate > 0) {
    const double unit = unit_mm(state.modal);
    queue_.put_new("F" + number_text(static_cast<double>(state.feed_rate) / unit, kRateTolerance), first);
  }
  return {};
}

PartSource::Done PartSource::take(SourceLine line) {
  LineText text(line.text);
  const auto facts = past_.reading.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (facts->use == AxisUse::Line) motion_.say(text, facts->is_rapid ? 0 : 1);
  if (const gcode::ArcMove* const arc = past_.reading.arc()) motion_.say(text, arc->clockwise ? 2 : 3);
  const LineText written(text.text());
  motion_.note(written);
  note(text, *facts, line.number);
  const auto read = written_.read(written, line.number);
  if (!read) return std::unexpected{read.error()};
  const auto missing = static_cast<AxisMask>(past_.told & kSpace & ~read->to.known);
  if (part_.first_line > 1 && is_cut(*facts) && missing != 0 && facts->use != AxisUse::Cycle) {
    return refuse(line.number,
                  "It cuts before this part has said where X, Y and Z are; the lines before the part did. "
                  "Have the program go there with G0 X Y and G0 Z behind the tool change.");
  }
  if (facts->ends) ended_ = true;
  line.text = written.line();
  last_ = {.text = {}, .number = line.number, .end = line.end};
  queue_.put(std::move(line));
  return {};
}

void PartSource::end(const SourceLine& like) {
  ended_ = true;
  if (!part_.ends) return;
  const auto& state = past_.reading.interpreter().state();
  const ProgramPlace& place = past_.reading.place();
  if (past_.highest_mm && has_axis(place.known, kZ) && place.mm[kZ] < *past_.highest_mm) {
    const double mm = *past_.highest_mm;
    queue_.put_new("G90 G0 Z" + number_text(mm / unit_mm(state.modal), kLengthTolerance_mm), like);
  }
  queue_.put_new("M5", like);
  queue_.put_new("M9", like);
  queue_.put_new("M30", like);
}

std::expected<std::optional<SourceLine>, TransformRefusal> PartSource::next() {
  while (queue_.is_empty() && !ended_) {
    auto line = before_->next();
    if (!line) return std::unexpected{std::move(line.error())};
    if (!line->has_value() || (*line)->number > part_.last_line) {
      if (!has_begun_) {
        return refuse(0, "The program has no line " + std::to_string(part_.first_line) + ".");
      }
      end(last_);
      continue;
    }
    SourceLine taken = *std::move(*line);
    if (taken.number < part_.first_line) {
      if (auto done = pass(taken); !done) return std::unexpected{done.error()};
      continue;
    }
    if (!has_begun_) {
      if (auto done = begin(taken); !done) return std::unexpected{done.error()};
      // What was said in front of the part is read as it will be.
      LineQueue said;
      while (!queue_.is_empty()) {
        SourceLine words = queue_.take();
        const LineText text(words.text);
        if (auto read = written_.read(text, words.number); !read) return std::unexpected{read.error()};
        motion_.note(text);
        said.put(std::move(words));
      }
      while (!said.is_empty()) queue_.put(said.take());
    }
    if (auto done = take(std::move(taken)); !done) return std::unexpected{std::move(done.error())};
  }
  if (queue_.is_empty()) return std::nullopt;
  return queue_.take();
}

}  // namespace kerf::rehearsal
