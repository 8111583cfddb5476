#include "rehearsal/program_survey.hpp"

#include <algorithm>

namespace kerf::rehearsal {
namespace {

bool is_motion(AxisUse use) {
  return use == AxisUse::Line || use == AxisUse::Arc || use == AxisUse::Cycle || use == AxisUse::Spline ||
         use == AxisUse::Probe || use == AxisUse::Spindle;
}

class Surveyor {
 public:
  void add(const LineText& text, const LineFacts& facts, std::uint32_t number) {
    if (const PlacedWord* const tool = text.find('T')) survey_.tools.insert(tool->whole());
    if (facts.changes_tool && survey_.tool_change_line == 0) survey_.tool_change_line = number;
    const bool renames = facts.use == AxisUse::NamesPlace || facts.use == AxisUse::NamesElsewhere ||
                         facts.use == AxisUse::OffsetValue || facts.use == AxisUse::ToolTable ||
                         text.has_command('G', 92.1) || text.has_command('G', 92.2) || text.has_command('G', 92.3);
    if (renames && survey_.renaming_line == 0) survey_.renaming_line = number;
    if (facts.modal.work_offset != facts.before.work_offset && survey_.modal_at_motion) {
      survey_.zero_change_line = number;
    }
    if (is_motion(facts.use)) note_motion(facts);
    survey_.modal_at_end = facts.modal;
    survey_.last_height_mm = has_axis(facts.to.known, kZ) ? std::optional{facts.to.mm[kZ]} : std::nullopt;
  }
  [[nodiscard]] const ProgramSurvey& survey() const { return survey_; }

 private:
  void note_motion(const LineFacts& facts) {
    if (!survey_.modal_at_motion) survey_.modal_at_motion = facts.modal;
    const bool goes_along = (facts.named & (mask_of_axis(kX) | mask_of_axis(kY))) != 0;
    if (goes_along && !z_was_told_) survey_.begins_along_xy = true;
    z_was_told_ = z_was_told_ || has_axis(facts.named, kZ);
    if (!has_axis(facts.to.known, kZ)) return;
    survey_.highest_mm = std::max(survey_.highest_mm.value_or(facts.to.mm[kZ]), facts.to.mm[kZ]);
  }

  ProgramSurvey survey_;
  bool z_was_told_ = false;
};

}  // namespace

std::expected<ProgramSurvey, TransformRefusal> survey_of(LineSource& source, const vocabulary::Dialect& dialect) {
  ProgramReading reading(dialect);
  Surveyor surveyor;
  while (true) {
    const auto line = source.next();
    if (!line) return std::unexpected{line.error()};
    if (!*line) break;
    const LineText text((*line)->text);
    const auto facts = reading.read(text, (*line)->number);
    if (!facts) return std::unexpected{facts.error()};
    if (!facts->is_over) surveyor.add(text, *facts, (*line)->number);
  }
  source.rewind();
  return surveyor.survey();
}

std::expected<void, TransformRefusal> check_repeatable(const ProgramSurvey& survey) {
  const auto refuse = [](std::uint32_t line, std::string reason) {
    return std::unexpected{TransformRefusal{.line = line, .reason = std::move(reason)}};
  };
  if (survey.renaming_line != 0) {
    return refuse(survey.renaming_line,
                  "It measures or moves work zero (G92, G10), and would do so again each time. Do "
                  "that before the program.");
  }
  if (survey.zero_change_line != 0) {
    return refuse(survey.zero_change_line,
                  "Behind its first motion the program goes to another work zero (G54 to G59), so "
                  "it cannot be repeated. Repeat the parts for themselves.");
  }
  if (survey.tools.size() > 1) {
    return refuse(survey.tool_change_line,
                  "The program uses several tools. Split it first: --split-tools, then repeat "
                  "each part.");
  }
  if (!survey.modal_at_motion) return refuse(0, "There is no motion to repeat.");
  const bool ends_high = !survey.last_height_mm || !survey.highest_mm || *survey.last_height_mm >= *survey.highest_mm;
  if (survey.begins_along_xy && !ends_high) {
    return refuse(0,
                  "The program begins along X and Y and does not end at its greatest height, so its beginning could "
                  "go through the work the second time. Have it go up at its end.");
  }
  return {};
}

std::string mode_words(const gcode::ModalState& to) {
  std::string words = to.incremental ? "G91" : "G90";
  words += to.inches ? " G20" : " G21";
  words += to.plane == gcode::Plane::XY ? " G17" : to.plane == gcode::Plane::ZX ? " G18" : " G19";
  switch (to.feed_mode) {
    case gcode::FeedMode::UnitsPerMinute: words += " G94"; break;
    case gcode::FeedMode::InverseTime: words += " G93"; break;
    case gcode::FeedMode::UnitsPerRevolution: words += " G95"; break;
  }
  return words;
}

}  // namespace kerf::rehearsal
