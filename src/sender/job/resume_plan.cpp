#include "sender/job/resume_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.hpp"
#include "sender/job/program_state.hpp"
#include "sender/job/resume_check.hpp"
#include "sender/job/resume_steps.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/controller_rules.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::job {
namespace {

using gcode::MotionMode;

constexpr std::size_t kZ = 2;
constexpr float kSpinUpS = 4.0F;
constexpr float kPlungeMmPerMin = 100.0F;
/// A line after which the state is certain again is looked for so far ahead.
constexpr std::uint32_t kLookAhead = 20'000;
/// Where a job is read twice because the line before the resumed one is needed, this often at most.
constexpr int kMostStepsBack = 8;

template <typename Value>
using Planned = std::expected<Value, ResumeRefusal>;

bool is_on(const machine::Capabilities& capabilities, int setting) {
  return (static_cast<int>(machine::setting_number(capabilities, setting).value_or(0)) & 1) != 0;
}

/// "grblHAL with axes XYZ"
std::string kind_of(const MachineAtStart& machine) {
  return std::string{vocabulary::name_of(machine.firmware)} + " with axes " + machine.axes;
}

/// Builds one plan. Each stage returns what is wrong, or nothing.
class Planning {
 public:
  Planning(const Program& program, const ResumeFacts& facts, const ResumeChoice& choice)
      : program_(program), facts_(facts), choice_(choice) {}

  Planned<ResumePlan> run() {
    using Stage = std::optional<ResumeRefusal> (Planning::*)();
    constexpr Stage kStages[] = {&Planning::check_machine,  &Planning::choose_line,   &Planning::read_starts,
                                 &Planning::read_to_line,   &Planning::check_state,   &Planning::check_offsets,
                                 &Planning::check_position, &Planning::choose_height, &Planning::choose_speeds,
                                 &Planning::make_steps};
    plan_.program = program_.name();
    plan_.executing = facts_.executing;
    plan_.is_homed = is_homed();
    plan_.warnings = facts_.remarks;
    for (std::size_t next = 0; next < std::size(kStages); ++next) {
      const Stage stage = kStages[next];
      if (auto refusal = (this->*stage)()) {
        if (!steps_back_from(*refusal)) return std::unexpected{*std::move(refusal)};
        next = static_cast<std::size_t>(std::ranges::find(kStages, &Planning::read_to_line) - kStages) - 1;
        continue;
      }
      if (!state_ || !plan_.is_from_the_beginning || !is_as_it_began()) continue;
      // A new beginning, too, cuts where the machine believes to be.
      if (auto refusal = check_position()) return std::unexpected{*std::move(refusal)};
      break;
    }
    return std::move(plan_);
  }

 private:
  static std::optional<ResumeRefusal> no(ResumeProblem problem, std::uint32_t line, std::string sentence,
                                         std::string next) {
    return ResumeRefusal{.problem = problem, .line = line, .sentence = std::move(sentence), .next = std::move(next)};
  }

  /// What a line continues that cannot be brought back exactly (a full circle, a mode) may be begun again before it.
  bool steps_back_from(const ResumeRefusal& refusal) {
    const bool may = refusal.problem == ResumeProblem::CannotRestore && !choice_.from_line && line_ > 1 && state_ &&
                     steps_back_ < kMostStepsBack;
    if (!may) return false;
    if (steps_back_++ == 0) {
      plan_.from_because += " Line " + std::to_string(line_) + " cannot be the first, so it goes further back.";
    }
    --line_;
    plan_.steps.clear();
    plan_.path.clear();
    plan_.resume_position_mm.clear();
    plan_.rewritten.reset();
    plan_.warnings = facts_.remarks;
    return true;
  }

  std::optional<ResumeRefusal> check_machine() {
    if (!facts_.file_hash.empty() && facts_.file_hash != program_.hash()) {
      return no(ResumeProblem::OtherProgram, 0, "The file is not the one that was being cut: its content has changed.",
                "Give the original file, or run the new one with --from-line after a look at its lines.");
    }
    const MachineAtStart& present = facts_.present;
    if (facts_.start.firmware != present.firmware || facts_.start.axes != present.axes) {
      return no(ResumeProblem::OtherMachine, 0,
                "The job was cut on a " + kind_of(facts_.start) + ", and this machine is a " + kind_of(present) + ".",
                "Connect to the machine of the job (--machine).");
    }
    if (facts_.silent_for_s) {
      return no(ResumeProblem::MachineNotReady, 0,
                "The machine has not answered for " + base::to_fixed(*facts_.silent_for_s, 0) +
                    " s: what it said last may not be true any more.",
                "Look at its cable and its power. If a reset does not wake it, switch it off and on, and home it.");
    }
    if (!facts_.will_be_homed && present.state != vocabulary::MachineState::Idle) {
      return no(ResumeProblem::MachineNotReady, 0, "The machine is not idle.",
                "Let it come to rest, and clear an alarm by homing.");
    }
    if (!present.offsets_are_current) {
      return no(ResumeProblem::MachineUnknown, 0, "The work offsets of the machine are not known.",
                "Let Kerf ask for them ($#) and try again.");
    }
    return std::nullopt;
  }

  std::optional<ResumeRefusal> choose_line() {
    const bool is_chosen = choice_.from_line.has_value();
    if (!is_chosen && facts_.executing.known_by == ExecutingKnownBy::Nothing) {
      return no(ResumeProblem::StateUnknown, 0, "It is not known which line was executing.",
                "Give the line to go on from with --from-line.");
    }
    line_ = choice_.from_line.value_or(facts_.executing.from);
    if (line_ < 1) line_ = 1;
    if (line_ > program_.line_count()) {
      return is_chosen
                 ? no(ResumeProblem::NoSuchLine, line_,
                      "The program has " + std::to_string(program_.line_count()) + " lines.", "Choose one of them.")
                 : no(ResumeProblem::NothingLeft, 0, "Every line of the program was executed.", "");
    }
    plan_.from_because = is_chosen ? "chosen by the operator."
                                   : "it is the first that may not have been finished; " + facts_.executing_because +
                                         ". Lines that may have been cut are cut again.";
    return std::nullopt;
  }

  std::optional<ResumeRefusal> read_starts() {
    const auto settings = machine::interpreter_settings_of(facts_.capabilities);
    auto start = program_start_of(facts_.start, settings);
    if (!start) {
      return no(ResumeProblem::StartUnknown, 0,
                "Before the first line of the job, " + start.error().what + " was not known.",
                "Choose a line with --from-line and check the offsets by hand.");
    }
    auto present = program_start_of(facts_.present, settings);
    if (!present) {
      return no(ResumeProblem::MachineUnknown, 0, "Of the machine now, " + present.error().what + " is not known.",
                "Let Kerf ask for it and try again.");
    }
    start_ = *std::move(start);
    present_start_ = *std::move(present);
    if (start_.settings.lathe_mode) {
      return no(ResumeProblem::CannotRestore, 0, "The machine is a lathe, where up is not the way out of a cut.",
                "Run the program from its beginning.");
    }
    present_ = interpreter_at(present_start_);
    if (!present_) {
      return no(ResumeProblem::MachineUnknown, 0, "The modes that the machine reports are not understood.",
                "Reset the controller and try again.");
    }
    if (choice_.offsets == OffsetsChoice::Present) take_present_offsets();
    return std::nullopt;
  }

  /// The work was zeroed anew: what the program does is the same in its own coordinates.
  void take_present_offsets() {
    // A machine that was homed again counts as before; another one counts from wherever it was switched on.
    const auto before = is_homed() ? std::nullopt : interpreter_at(start_);
    const std::size_t active = before ? before->state().modal.work_offset : 0;
    for (std::size_t axis = 0; before && axis < start_.position_mm.size(); ++axis) {
      start_.position_mm.at(axis) +=
          present_start_.offsets.work.at(active).at(axis) - start_.offsets.work.at(active).at(axis);
    }
    start_.offsets.work = present_start_.offsets.work;
    const vocabulary::AxisValues none{};
    if (present_start_.offsets.g92 != none) start_.offsets.g92 = present_start_.offsets.g92;
    if (present_start_.offsets.tool_length != none) start_.offsets.tool_length = present_start_.offsets.tool_length;
  }

  /// The state at the beginning of `number`, and then at that line's end and further as `until` says.
  template <typename Until>
  void read(ProgramState& state, std::uint32_t first, const Until& until) const {
    const WireForm form = wire_form_of(*start_.dialect);
    std::string text;
    for (auto line = program_.line(first); line && !until(line->number, state);
         line = program_.line_at(program_.offset_after(*line), line->number + 1)) {
      text.clear();
      append_wire_form(text, line->text, form);
      state.execute(line->number, text);
    }
  }

  std::optional<ResumeRefusal> read_to_line() {
    for (int steps_back = 0; steps_back < kMostStepsBack; ++steps_back) {
      auto reader = interpreter_at(start_);
      if (!reader) {
        return no(ResumeProblem::StartUnknown, 0, "The modes before the first line of the job are not understood.",
                  "Choose a line with --from-line.");
      }
      state_.emplace(*std::move(reader), *start_.dialect);
      read(*state_, 1, [this](std::uint32_t number, const ProgramState&) { return number >= line_; });
      if (!state_->tool_history().highest_cut_mm && !choice_.from_line) return begin_anew();
      if (!state_->tool_history().has_moved) return begin_anew();
      const auto back = line_that_motion_needs();
      if (!back) break;
      plan_.from_because += " Line " + std::to_string(line_) + " continues what line " + std::to_string(*back) +
                            " began, so it goes back to that.";
      line_ = *back;
    }
    plan_.from_line = line_;
    return std::nullopt;
  }

  std::optional<ResumeRefusal> begin_anew() {
    plan_.is_from_the_beginning = true;
    plan_.from_because = "nothing was cut before line " + std::to_string(line_) + ".";
    line_ = line_behind_tape_mark();
    state_.emplace(*interpreter_at(start_), *start_.dialect);
    plan_.from_line = line_;
    return std::nullopt;
  }

  /// A `%` at the beginning would be the end behind the lines of the plan.
  [[nodiscard]] std::uint32_t line_behind_tape_mark() const {
    for (auto line = program_.line(1); line; line = program_.line_at(program_.offset_after(*line), line->number + 1)) {
      const auto text = base::trim(line->text);
      if (text.starts_with('%')) return line->number + 1;
      if (!text.empty()) break;
    }
    return 1;
  }

  /// The machine stands as it stood before the first line, so there is nothing to do first.
  [[nodiscard]] bool is_as_it_began() const {
    const gcode::ParserState& then = state_->parser();
    const gcode::ParserState& now = present_->state();
    return then.modal == now.modal && then.feed_rate == now.feed_rate && then.spindle_rpm == now.spindle_rpm &&
           then.tool == now.tool && stands_where_it_stood() &&
           !first_difference(state_->offsets(), present_->offsets(), *start_.dialect, axes()) &&
           state_->offsets().g92 == present_->offsets().g92 &&
           state_->offsets().tool_length == present_->offsets().tool_length;
  }

  [[nodiscard]] bool stands_where_it_stood() const {
    constexpr float kSameMm = 0.01F;
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      const float away = state_->parser().position_mm.at(axis) - present_->state().position_mm.at(axis);
      if (std::abs(away) > kSameMm) return false;
    }
    return true;
  }

  [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(start_.settings.axes); }

  /// The first line from `line_` on that has axis words but no mode of motion of its own.
  [[nodiscard]] std::optional<ProgramLine> line_without_motion_word() const {
    for (auto line = program_.line(line_); line;
         line = program_.line_at(program_.offset_after(*line), line->number + 1)) {
      const auto words = words_of(line->text);
      if (continues_motion(words)) return line;
      if (std::ranges::any_of(words, sets_motion)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// Modes that cannot be brought back in one line: the program goes on where they began.
  [[nodiscard]] std::optional<std::uint32_t> line_that_motion_needs() const {
    const auto& modal = state_->parser().modal;
    const bool is_plain = modal.motion == MotionMode::Rapid || modal.motion == MotionMode::Linear ||
                          modal.motion == MotionMode::None || modal.motion == MotionMode::ClockwiseArc ||
                          modal.motion == MotionMode::CounterclockwiseArc;
    const bool is_sticky = gcode::is_canned_cycle(modal.motion) && !modal.incremental;
    if (is_plain || is_sticky || state_->motion_word_line() == 0) return std::nullopt;
    if (!line_without_motion_word()) return std::nullopt;
    return state_->motion_word_line();
  }

  std::optional<ResumeRefusal> check_state() {
    if (const auto& doubt = state_->doubt()) {
      ProgramState ahead = *state_;
      std::uint32_t certain_from = 0;
      read(ahead, line_, [&](std::uint32_t number, const ProgramState& state) {
        if (!state.doubt() && certain_from == 0) certain_from = number;
        return certain_from != 0 || number > line_ + kLookAhead;
      });
      return no(ResumeProblem::StateUnknown, doubt->line,
                "Line " + std::to_string(doubt->line) + " " + doubt->because + ": the state at line " +
                    std::to_string(line_) + " is not known.",
                certain_from != 0 ? "From line " + std::to_string(certain_from) + " on it is known again."
                                  : "Go on from a line before it (--from-line).");
    }
    const gcode::ParserState& at = state_->parser();
    const auto cannot = [this](std::string what) {
      return no(
          ResumeProblem::CannotRestore, line_,
          "At line " + std::to_string(line_) + " " + std::move(what) + " is in force, which cannot be brought back.",
          "Go on from a line before it began.");
    };
    if (at.modal.scaling) return cannot("scaling (G51)");
    if (at.modal_macro) return cannot("a macro for every motion (G66)");
    if (at.saved) return cannot("a saved state (M70)");
    if (at.modal.surface_speed || at.modal.diameter) return cannot("a mode of lathes");
    const bool is_probing =
        at.modal.motion >= MotionMode::ProbeToward && at.modal.motion <= MotionMode::ProbeAwayNoError;
    if (is_probing && line_without_motion_word()) return cannot("a probe motion");
    return std::nullopt;
  }

  std::optional<ResumeRefusal> check_offsets() {
    if (choice_.offsets == OffsetsChoice::AsThen) return std::nullopt;
    const auto difference = first_difference(state_->offsets(), present_->offsets(), *start_.dialect, axes());
    if (!difference) return std::nullopt;
    return no(ResumeProblem::OffsetsDiffer, state_->tool_history().offset_line,
              difference->name + " was " + difference->then + " in the job, and is " + difference->now + " now.",
              "If the work or the cutter was zeroed anew, say --offsets present; to put back the old ones, say "
              "--offsets job.");
  }

  [[nodiscard]] bool is_homed() const {
    return facts_.will_be_homed || (facts_.present.homing.all.value_or(false) && is_on(facts_.capabilities, 22));
  }

  std::optional<ResumeRefusal> check_position() {
    const bool can_home = is_on(facts_.capabilities, 22);
    if (is_homed()) {
      position_text_ = facts_.will_be_homed ? "Homes first." : "The machine is homed.";
      return std::nullopt;
    }
    if (choice_.position_is_confirmed) {
      position_text_ = "The operator has said that the machine is where it says.";
      return std::nullopt;
    }
    if (can_home) {
      return no(ResumeProblem::PositionUnknown, 0, "The machine is not homed, so its position is not known.",
                "Home it first ($H), or say --position-is-right if you know better.");
    }
    if (!facts_.position_doubt.empty()) {
      return no(ResumeProblem::PositionUnknown, 0,
                "The position may be wrong (" + facts_.position_doubt + "), and this machine cannot be homed.",
                "Zero the work where it was, then say --position-is-right (and --offsets present).");
    }
    position_text_ = "The machine must stand where it says: it cannot be homed.";
    asks_for_position_ = true;
    return std::nullopt;
  }

  /// The upper end of Z, less the distance that keeps the switch free.
  [[nodiscard]] std::optional<double> travel_top() const {
    if (!is_homed()) return std::nullopt;
    const auto travel = machine::travel_of_axis(kZ, facts_.capabilities, *start_.dialect);
    if (!travel) return std::nullopt;
    constexpr int kPullOff = 27;
    return static_cast<double>(travel->max_mm) -
           std::abs(machine::setting_number(facts_.capabilities, kPullOff).value_or(0));
  }

  std::optional<ResumeRefusal> choose_height() {
    // Lines that may have been executed count as well.
    ProgramState further = *state_;
    const std::uint32_t last = choice_.from_line ? 0 : facts_.executing.to;
    read(further, line_, [last](std::uint32_t number, const ProgramState&) { return number > last; });
    const ToolHistory& history = further.tool_history();
    if (history.highest_cut_mm) plan_.highest_cut_mm = static_cast<double>(*history.highest_cut_mm);
    const double z_now = static_cast<double>(present_->state().position_mm[kZ]);
    const double reached = std::max(static_cast<double>(history.highest_mm), plan_.highest_cut_mm.value_or(-1e9));
    const auto top = travel_top();
    double height = std::max(reached + choice_.clearance_mm, z_now);
    if (top) height = std::max({*top, reached, std::min(z_now, *top)});
    if (choice_.safe_height_mm) {
      if (*choice_.safe_height_mm < plan_.highest_cut_mm.value_or(-1e9) + choice_.clearance_mm) {
        return no(ResumeProblem::NoSafeHeight, 0,
                  "Z" + base::to_fixed(*choice_.safe_height_mm, 3) + " is not above everything that was cut so far (Z" +
                      base::to_fixed(plan_.highest_cut_mm.value_or(0), 3) + ").",
                  "Choose a greater --safe-height, in machine coordinates.");
      }
      height = *choice_.safe_height_mm;
      if (height < reached) plan_.warnings.push_back("The program itself went higher than this safe height.");
    }
    if (z_now > height) height = z_now;
    plan_.safe_height_mm = std::max(height, static_cast<double>(state_->parser().position_mm[kZ]));
    return std::nullopt;
  }

  std::optional<ResumeRefusal> choose_speeds() {
    const ToolHistory& history = state_->tool_history();
    const gcode::ParserState& at = state_->parser();
    float plunge = kPlungeMmPerMin;
    const bool has_plain_feed = at.modal.feed_mode == gcode::FeedMode::UnitsPerMinute && at.feed_rate > 0;
    if (has_plain_feed) plunge = std::min(plunge, at.feed_rate);
    if (history.plunge_mm_per_min) plunge = *history.plunge_mm_per_min;
    plan_.plunge_mm_per_min = choice_.plunge_mm_per_min.value_or(static_cast<double>(plunge));
    const bool turns = at.modal.spindle != gcode::SpindleDirection::Off && !start_.settings.laser_mode;
    const float spin_up = turns ? std::max(history.spin_up_s, kSpinUpS) : 0.0F;
    plan_.spin_up_s = turns ? choice_.spin_up_s.value_or(static_cast<double>(spin_up)) : 0;
    if (!turns && !start_.settings.laser_mode && !plan_.is_from_the_beginning) {
      plan_.warnings.emplace_back("The spindle is off at this line, as the program left it.");
    }
    for (std::size_t axis = 0; axis < axes(); ++axis) {
      plan_.resume_position_mm.push_back(static_cast<double>(at.position_mm.at(axis)));
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string motion_word() const {
    switch (state_->parser().modal.motion) {
      case MotionMode::Rapid: return "G0";
      case MotionMode::Linear: return "G1";
      case MotionMode::None: return "G80";
      case MotionMode::ClockwiseArc: return "G2";
      case MotionMode::CounterclockwiseArc: return "G3";
      default: return state_->motion_word();
    }
  }

  /// Arcs and cycles need axis words, so their mode comes with the first line that relies on it.
  void rewrite_line() {
    const MotionMode motion = state_->parser().modal.motion;
    const auto line = line_without_motion_word();
    if (!line) return;
    if (motion == MotionMode::Rapid || motion == MotionMode::Linear || motion == MotionMode::None) return;
    std::string text;
    append_wire_form(text, line->text, wire_form_of(*start_.dialect));
    const auto words = words_of(text);
    std::string before = motion_word();
    if (gcode::is_canned_cycle(motion)) {
      for (const auto& [letter, digits] : state_->cycle_words()) {
        const bool is_of_cycle = std::string_view{"ZRPQ"}.contains(letter);
        if (!is_of_cycle || std::ranges::count(words, letter, &LineWord::letter) > 0) continue;
        (before += letter) += digits;
      }
    }
    plan_.rewritten = {.line = line->number, .text = before + text};
  }

  std::optional<ResumeRefusal> make_steps() {
    const auto safe = static_cast<float>(plan_.safe_height_mm);
    std::optional<float> rapid_to;
    if (plan_.highest_cut_mm) {
      rapid_to =
          std::max(static_cast<float>(*plan_.highest_cut_mm + choice_.clearance_mm), state_->parser().position_mm[kZ]);
    }
    const MotionMode motion = state_->parser().modal.motion;
    const bool stands_alone = motion == MotionMode::Rapid || motion == MotionMode::Linear || motion == MotionMode::None;
    rewrite_line();
    plan_.steps = steps_to({.state = *state_,
                            .dialect = *start_.dialect,
                            .present = *present_,
                            .safe_height_mm = safe,
                            .rapid_to_mm = rapid_to,
                            .plunge_mm_per_min = static_cast<float>(plan_.plunge_mm_per_min),
                            .spin_up_s = static_cast<float>(plan_.spin_up_s),
                            .motion_word = stands_alone ? motion_word() : std::string{},
                            .is_laser = start_.settings.laser_mode,
                            .writes_offsets = choice_.offsets == OffsetsChoice::AsThen,
                            .asks_for_position = asks_for_position_,
                            .position_text = position_text_});
    plan_.steps.push_back({.kind = ResumeStepKind::GoOn,
                           .text = "Then the program, from line " + std::to_string(line_) + " of " +
                                   std::to_string(program_.line_count()) + ".",
                           .reason = plan_.rewritten
                                         ? "Line " + std::to_string(plan_.rewritten->line) + " is sent as '" +
                                               plan_.rewritten->text + "', because it relies on a line before."
                                         : "As it stands in the file."});
    return check_plan(plan_, {.program = program_,
                              .state = *state_,
                              .present = *present_,
                              .dialect = *start_.dialect,
                              .capabilities = facts_.capabilities});
  }

  const Program& program_;
  const ResumeFacts& facts_;
  const ResumeChoice& choice_;
  ResumePlan plan_;
  std::uint32_t line_ = 1;
  int steps_back_ = 0;
  ProgramStart start_;
  ProgramStart present_start_;
  std::optional<gcode::Interpreter> present_;
  std::optional<ProgramState> state_;
  std::string position_text_;
  bool asks_for_position_ = false;
};

}  // namespace

std::expected<ResumePlan, ResumeRefusal> plan_resume(const Program& program, const ResumeFacts& facts,
                                                     const ResumeChoice& choice) {
  return Planning(program, facts, choice).run();
}

}  // namespace kerf::job
