#include "rehearsal/program_reading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/text.hpp"
#include "common/motion/arc.hpp"
#include "common/vocabulary/codes.hpp"
#include "sender/job/line_words.hpp"

namespace kerf::rehearsal {
namespace {

using gcode::MotionMode;
using vocabulary::kAxisLetters;

constexpr AxisMask kAllAxes = 0xFF;
/// A line's place by its words and by the firmware's floats differ by less.
constexpr double kSamePlace_mm = 0.02;
constexpr double kFloatShare = 1e-5;

std::unexpected<TransformRefusal> refuse(std::uint32_t line, std::string reason) {
  return std::unexpected{TransformRefusal{.line = line, .reason = std::move(reason)}};
}

/// G10 by its L; P tells whose.
AxisUse use_of_g10(const LineText& line, const gcode::ModalState& modal) {
  const PlacedWord* const kind = line.find('L');
  const int l = kind == nullptr ? 0 : kind->whole();
  if (l == 2) return AxisUse::OffsetValue;
  if (l != 20) return AxisUse::ToolTable;
  const PlacedWord* const which = line.find('P');
  const int p = which == nullptr ? 0 : which->whole();
  return p == 0 || p == modal.work_offset + 1 ? AxisUse::NamesPlace : AxisUse::NamesElsewhere;
}

AxisUse use_of_motion(MotionMode motion) {
  switch (motion) {
    case MotionMode::Rapid:
    case MotionMode::Linear: return AxisUse::Line;
    case MotionMode::ClockwiseArc:
    case MotionMode::CounterclockwiseArc: return AxisUse::Arc;
    case MotionMode::ProbeToward:
    case MotionMode::ProbeTowardNoError:
    case MotionMode::ProbeAway:
    case MotionMode::ProbeAwayNoError: return AxisUse::Probe;
    case MotionMode::CubicSpline:
    case MotionMode::QuadraticSpline: return AxisUse::Spline;
    case MotionMode::SpindleSynchronized:
    case MotionMode::RigidTap:
    case MotionMode::Thread: return AxisUse::Spindle;
    case MotionMode::None: return AxisUse::Nobody;
    default: return AxisUse::Cycle;
  }
}

AxisUse use_of(const LineText& line, const gcode::ModalState& modal, bool moves) {
  // Most lines are moves and say no G.
  if (!line.has('G')) return moves ? use_of_motion(modal.motion) : AxisUse::Nobody;
  if (line.has_command('G', 10)) return use_of_g10(line, modal);
  if (line.has_command('G', 92)) return AxisUse::NamesPlace;
  if (line.has_command('G', 28) || line.has_command('G', 30)) return AxisUse::Home;
  if (line.has_command('G', 53)) return AxisUse::Machine;
  if (line.has_command('G', 43.1)) return AxisUse::ToolLength;
  if (line.has_command('G', 51)) return AxisUse::Scaling;
  const AxisUse use = use_of_motion(modal.motion);
  // A full circle of grblHAL's names no axis.
  return moves ? use : AxisUse::Nobody;
}

bool is_motion(const gcode::Action& action) {
  return std::holds_alternative<gcode::LinearMove>(action) || std::holds_alternative<gcode::ArcMove>(action) ||
         std::holds_alternative<gcode::ProbeMove>(action);
}

/// `$` lines that leave the program's coordinates alone.
bool is_harmless_command(std::string_view line) {
  return !base::starts_with_ignoring_case(line, "$J") && !base::starts_with_ignoring_case(line, "$RST") &&
         !base::starts_with_ignoring_case(line, "$TLR") && !base::starts_with_ignoring_case(line, "$TPW");
}

}  // namespace

gcode::InterpreterSettings settings_for_reading(const vocabulary::Dialect& dialect) {
  constexpr int kPlenty = 16;
  return {.axes = dialect.axes_max,
          .tools = 250,
          .ports = {.digital_inputs = kPlenty,
                    .digital_outputs = kPlenty,
                    .analog_inputs = kPlenty,
                    .analog_outputs = kPlenty},
          .spindle_encoder = true};
}

double swept_rad(const gcode::ArcMove& arc, const vocabulary::AxisValues& from_mm, const vocabulary::Dialect& dialect) {
  const motion::MotionSettings settings{.axes = dialect.axes_max, .arc_tolerance_mm = 0.002F};
  const motion::ArcChords chords(motion::arc_of(arc, from_mm), motion::rules_of(dialect.firmware), settings);
  const double last = chords.swept_rad();
  const double turns = 2.0 * std::numbers::pi * (std::max(arc.turns, 1) - 1);
  return arc.clockwise ? last - turns : last + turns;
}

bool is_whole_circle(const LineFacts& facts) {
  constexpr double kNothing_mm = 1e-7;
  const gcode::PlaneAxes axes = gcode::axes_of(facts.modal.plane);
  const auto stays = [&](std::size_t axis) {
    return std::abs(facts.to.mm.at(axis) - facts.from.mm.at(axis)) < kNothing_mm;
  };
  return facts.use == AxisUse::Arc && stays(axes.first) && stays(axes.second);
}

ProgramReading::ProgramReading(const vocabulary::Dialect& dialect)
    : dialect_(&dialect),
      form_(job::wire_form_of(dialect)),
      interpreter_(gcode::rules_for(dialect), settings_for_reading(dialect)) {}

const gcode::ArcMove* ProgramReading::arc() const {
  for (const gcode::Action& action : actions_) {
    if (const auto* found = std::get_if<gcode::ArcMove>(&action)) return found;
  }
  return nullptr;
}

bool ProgramReading::is_written_oddly(const LineText& line) {
  // Comments within words, and letters without numbers: what the controller reads is not what stands there.
  wire_.clear();
  job::append_wire_form(wire_, line.line(), form_);
  std::string words;
  for (std::size_t at = 0; at < wire_.size(); ++at) {
    if (wire_[at] == '(') {
      at = std::min(wire_.find(')', at), wire_.size() - 1);
    } else if (wire_[at] != '%' && wire_[at] != '/' && wire_[at] != '+') {
      words += base::to_upper(wire_[at]);
    }
  }
  if (words != line.plain_words()) return true;
  return std::ranges::any_of(line.words(), [](const PlacedWord& word) { return word.digits.empty(); });
}

std::expected<void, TransformRefusal> ProgramReading::execute(std::string_view words, std::uint32_t number) {
  const auto read = interpreter_.interpret(words, actions_);
  if (read) return {};
  const int code = static_cast<int>(read.error());
  const auto* const row = vocabulary::find_code(dialect_->errors, code);
  return refuse(number, std::string{dialect_->name} + " refuses this line with error:" + std::to_string(code) +
                            (row == nullptr ? "" : " (" + std::string{row->title} + ")") +
                            ", so nobody knows what it should do. Correct it first.");
}

void ProgramReading::settle_actions() {
  for (const gcode::Action& action : actions_) {
    if (const auto* probe = std::get_if<gcode::ProbeMove>(&action)) interpreter_.sync_position(probe->target_mm);
    if (std::holds_alternative<gcode::ToolChange>(action)) interpreter_.complete_tool_change();
  }
}

std::expected<void, TransformRefusal> ProgramReading::read_system(const LineText& line, std::uint32_t number,
                                                                  LineFacts& facts) {
  const std::string_view command = base::trim(line.line());
  facts.is_system = true;
  facts.modal = facts.before;
  if (!is_harmless_command(command)) {
    return refuse(number, "'" + std::string{command} +
                              "' moves the machine, or changes what places are called, in a way that cannot be "
                              "followed. Take it out of the program.");
  }
  if (base::starts_with_ignoring_case(command, "$H")) facts.renamed = kAllAxes;
  place_.known &= static_cast<AxisMask>(~facts.renamed);
  facts.to = place_;
  return {};
}

std::expected<LineFacts, TransformRefusal> ProgramReading::read(const LineText& line, std::uint32_t number) {
  LineFacts facts{.before = interpreter_.state().modal,
                  .from = place_,
                  .from_machine_mm = interpreter_.state().position_mm,
                  .is_over = is_over_};
  actions_.clear();
  facts.modal = facts.before;
  facts.to = place_;
  if (is_over_) return facts;
  if (base::trim(line.line()).starts_with('$')) {
    if (auto read = read_system(line, number, facts); !read) return std::unexpected{std::move(read.error())};
    return facts;
  }
  if (is_written_oddly(line)) {
    if (job::needs_a_computer(wire_, job::words_of(wire_))) {
      return refuse(number,
                    "This line uses parameters, expressions or subroutines, whose values are known to the "
                    "controller only. Have the CAM program write plain numbers.");
    }
    return refuse(number,
                  "A letter without a number, or a comment in the middle of a word, stands in this line. "
                  "Correct it first.");
  }
  if (line.words().empty()) return facts;
  constexpr double kFarthest = 1e6;
  constexpr double kFastest = 1e9;
  for (const PlacedWord& word : line.words()) {
    const bool is_rate = word.letter == 'F' || word.letter == 'S';
    const bool is_measure = is_rate || std::string_view{"XYZABCUVWIJKRPQ"}.contains(word.letter);
    if (is_measure && std::abs(word.value) > (is_rate ? kFastest : kFarthest)) {
      return refuse(number, "A number of this line is too large for any machine. Correct it first.");
    }
  }
  if (job::needs_a_computer(wire_, job::words_of(wire_))) {
    return refuse(number,
                  "This line calls a macro or a subroutine, and what that does is known to the controller "
                  "only. Have the CAM program write plain moves.");
  }
  // The end of the program resets the modes in which its line was read. Grbl has no M6: the sender waits there.
  constexpr std::array<int, 3> kApart{2, 30, 6};
  const std::size_t apart = dialect_->tool_change == vocabulary::ToolChangeRule::Refused ? 3 : 2;
  if (auto read = execute(line.plain_words(std::span{kApart}.first(apart)), number); !read)
    return std::unexpected{std::move(read.error())};
  settle_actions();
  note_words(line, facts);
  facts.ends = line.has_command('M', 2) || line.has_command('M', 30);
  is_over_ = facts.ends;
  note_renaming(line, facts);
  follow(line, facts);
  facts.to = place_;
  const auto& offset = interpreter_.work_coordinate_offset();
  const bool moves = facts.use == AxisUse::Line || facts.use == AxisUse::Arc;
  for (std::size_t axis = 0; moves && axis < offset.size(); ++axis) {
    if (!has_axis(facts.named, axis) || !has_axis(place_.known, axis)) continue;
    const double machine = static_cast<double>(interpreter_.state().position_mm.at(axis)) - offset.at(axis);
    if (facts.modal.incremental || facts.modal.scaling) continue;
    if (std::abs(machine - place_.mm.at(axis)) > kSamePlace_mm + kFloatShare * std::abs(machine)) {
      return refuse(number,
                    "The controller reads a number of this line otherwise than it is written. Correct it "
                    "first.");
    }
  }
  return facts;
}

void ProgramReading::note_words(const LineText& line, LineFacts& facts) const {
  facts.modal = interpreter_.state().modal;
  const double unit = unit_mm(facts.modal);
  for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis) {
    const PlacedWord* const word = line.find(kAxisLetters[axis]);
    if (word == nullptr) continue;
    facts.named |= mask_of_axis(axis);
    facts.words_mm.at(axis) = word->value * (turns(axis) ? 1.0 : unit);
  }
  facts.use = use_of(line, facts.modal, std::ranges::any_of(actions_, is_motion));
  if (facts.use == AxisUse::Nobody && facts.named != 0) facts.use = use_of_motion(facts.modal.motion);
  for (const gcode::Action& action : actions_) {
    if (const auto* move = std::get_if<gcode::LinearMove>(&action)) facts.is_rapid = move->feed.rapid;
  }
  facts.stores_home = line.has_command('G', 28.1) || line.has_command('G', 30.1);
}

void ProgramReading::note_renaming(const LineText& line, LineFacts& facts) const {
  if (facts.modal.work_offset != facts.before.work_offset) facts.renamed = kAllAxes;
  const bool has_command = line.has('G');
  for (const double word : {92.1, 92.2, 92.3, 50.0}) {
    if (has_command && line.has_command('G', word)) facts.renamed = kAllAxes;
  }
  for (const double word : {43.0, 43.1, 43.2, 49.0}) {
    if (!has_command || !line.has_command('G', word)) continue;
    facts.renamed |= mask_of_axis(kZ);
    if (word == 43.1) facts.renamed |= facts.named;
  }
  facts.changes_tool = line.has_command('M', 6);
  if (facts.changes_tool) facts.renamed |= mask_of_axis(kZ);
}

void ProgramReading::follow(const LineText& line, const LineFacts& facts) {
  const auto forget = [this](AxisMask axes) { place_.known &= static_cast<AxisMask>(~axes); };
  forget(facts.renamed);
  switch (facts.use) {
    case AxisUse::Cycle: return follow_cycle(line, facts);
    case AxisUse::Line:
    case AxisUse::Arc:
    case AxisUse::Spline:
      for (std::size_t axis = 0; axis < facts.words_mm.size(); ++axis) {
        if (!has_axis(facts.named, axis)) continue;
        if (facts.modal.incremental) {
          place_.mm.at(axis) += facts.words_mm.at(axis);
        } else {
          place_.mm.at(axis) = facts.words_mm.at(axis);
          place_.known |= mask_of_axis(axis);
        }
      }
      return;
    case AxisUse::NamesPlace:
      for (std::size_t axis = 0; axis < facts.words_mm.size(); ++axis) {
        if (has_axis(facts.named, axis)) place_.mm.at(axis) = facts.words_mm.at(axis);
      }
      place_.known |= facts.named;
      return;
    case AxisUse::Home:
      // Without axis words all of them go.
      return forget(facts.named == 0 ? kAllAxes : facts.named);
    case AxisUse::OffsetValue:
    case AxisUse::Probe:
    case AxisUse::Spindle:
    case AxisUse::Machine:
    case AxisUse::ToolTable:
    case AxisUse::Scaling: return forget(facts.named);
    case AxisUse::NamesElsewhere:
    case AxisUse::ToolLength:
    case AxisUse::Nobody: return;
  }
}

void ProgramReading::follow_cycle(const LineText& line, const LineFacts& facts) {
  const std::size_t depth = gcode::axes_of(facts.modal.plane).linear;
  const PlacedWord* const repeats = line.find('L');
  const double times = repeats == nullptr ? 1.0 : repeats->value;
  for (std::size_t axis = 0; axis < facts.words_mm.size(); ++axis) {
    if (!has_axis(facts.named, axis) || axis == depth) continue;
    if (facts.modal.incremental) {
      place_.mm.at(axis) += facts.words_mm.at(axis) * times;
    } else {
      place_.mm.at(axis) = facts.words_mm.at(axis);
      place_.known |= mask_of_axis(axis);
    }
  }
  // It ends where it began, or at R; the interpreter knows, and nobody renamed the axis since it did.
  const auto& state = interpreter_.state();
  const double before = facts.from_machine_mm.at(depth);
  const double moved = static_cast<double>(state.position_mm.at(depth)) - before;
  if (std::abs(moved) > 1e-6) place_.mm.at(depth) += moved;
}

ProgramPlace pointed_at(const LineFacts& facts) {
  ProgramPlace place = facts.from;
  place.known &= static_cast<AxisMask>(~facts.renamed);
  for (std::size_t axis = 0; axis < place.mm.size(); ++axis) {
    if (!has_axis(facts.named, axis)) continue;
    if (facts.modal.incremental && facts.use != AxisUse::NamesPlace && facts.use != AxisUse::NamesElsewhere) {
      place.mm.at(axis) += facts.words_mm.at(axis);
    } else {
      place.mm.at(axis) = facts.words_mm.at(axis);
      place.known |= mask_of_axis(axis);
    }
  }
  return place;
}

}  // namespace kerf::rehearsal
