#include "sender/job/resume_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "common/base/text.hpp"
#include "common/motion/arc.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::job {
namespace {

using vocabulary::AxisValues;
using vocabulary::kAxisLetters;

constexpr std::size_t kZ = 2;
constexpr float kSamePlaceMm = 0.002F;
constexpr float kSameOffsetMm = 0.0025F;
/// So many lines of the program are compared with what they would have done without the interruption.
constexpr std::uint32_t kLinesCompared = 500;
constexpr std::size_t kPointsShown = 5000;

bool near(float a, float b, float tolerance) {
  return std::abs(a - b) <= tolerance + std::abs(a) * 1e-5F;
}

bool near(const AxisValues& a, const AxisValues& b, float tolerance) {
  return std::ranges::equal(a, b, [tolerance](float one, float other) { return near(one, other, tolerance); });
}

bool is_zero(const AxisValues& values) {
  return std::ranges::all_of(values, [](float value) { return value == 0.0F; });
}

std::string text_of_axes(const AxisValues& values, std::size_t axes) {
  std::string text;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    (text += text.empty() ? "" : " ") += kAxisLetters.at(axis);
    text += base::to_fixed(static_cast<double>(values.at(axis)), 3);
  }
  return text;
}

std::vector<double> vector_of(const AxisValues& values, std::size_t axes) {
  std::vector<double> result;
  for (std::size_t axis = 0; axis < axes; ++axis) result.push_back(static_cast<double>(values.at(axis)));
  return result;
}

/// Where a motion ends and how; null for what is no motion.
struct MotionOf {
  struct Seen {
    const AxisValues* target_mm = nullptr;
    const gcode::Feed* feed = nullptr;
  };
  Seen operator()(const gcode::LinearMove& move) const { return {&move.target_mm, &move.feed}; }
  Seen operator()(const gcode::ArcMove& move) const { return {&move.target_mm, &move.feed}; }
  Seen operator()(const gcode::ProbeMove& move) const { return {&move.target_mm, &move.feed}; }
  Seen operator()(const auto&) const { return {}; }
};

bool same_motion(const gcode::Action& one, const gcode::Action& other) {
  const auto a = std::visit(MotionOf{}, one);
  const auto b = std::visit(MotionOf{}, other);
  if (one.index() != other.index()) return false;
  if (a.target_mm == nullptr) return true;
  if (const auto* arc = std::get_if<gcode::ArcMove>(&one)) {
    const auto& then = std::get<gcode::ArcMove>(other);
    if (arc->clockwise != then.clockwise || arc->plane != then.plane || arc->turns != then.turns) return false;
    if (!near(arc->radius_mm, then.radius_mm, kSamePlaceMm)) return false;
  }
  return near(*a.target_mm, *b.target_mm, kSamePlaceMm) && a.feed->rapid == b.feed->rapid &&
         (a.feed->rapid || near(a.feed->rate_mm_per_min, b.feed->rate_mm_per_min, 0.01F)) &&
         a.feed->inverse_time == b.feed->inverse_time && near(a.feed->spindle_rpm, b.feed->spindle_rpm, 0.5F) &&
         a.feed->spindle == b.feed->spindle;
}

/// What a line asks for, and the place where it begins.
struct Motions {
  const std::vector<gcode::Action>& actions;
  AxisValues from_mm{};
};

/// The last bit of a coordinate decides whether an arc back to its beginning is a full circle or nothing.
bool same_sweeps(const Motions& one, const Motions& other, const motion::MotionRules& rules) {
  const auto sweep_of = [&](const Motions& motions, std::size_t index) {
    const auto* const arc = std::get_if<gcode::ArcMove>(&motions.actions[index]);
    if (arc == nullptr) return 0.0F;
    AxisValues start = motions.from_mm;
    for (std::size_t before = 0; before < index; ++before) {
      const auto seen = std::visit(MotionOf{}, motions.actions[before]);
      if (seen.target_mm != nullptr) start = *seen.target_mm;
    }
    return motion::ArcChords{motion::arc_of(*arc, start), rules, {}}.swept_rad();
  };
  for (std::size_t index = 0; index < one.actions.size(); ++index) {
    if (!near(sweep_of(one, index), sweep_of(other, index), 0.1F)) return false;
  }
  return true;
}

bool same_motions(const Motions& one, const Motions& other, const motion::MotionRules& rules) {
  return std::ranges::equal(one.actions, other.actions, same_motion) && same_sweeps(one, other, rules);
}

class Check {
 public:
  Check(ResumePlan& plan, const PlanCheck& with)
      : plan_(plan),
        with_(with),
        axes_(static_cast<std::size_t>(with.state.reader().settings().axes)),
        resumed_(with.present, with.dialect) {}

  std::optional<ResumeRefusal> run() {
    plan_.path.push_back(
        {.kind = ResumeMotion::Rapid, .position_mm = vector_of(with_.present.state().position_mm, axes_)});
    if (auto refusal = read_preamble()) return refusal;
    if (auto refusal = compare_state()) return refusal;
    return compare_rest();
  }

 private:
  static ResumeRefusal fault(ResumeProblem problem, std::uint32_t line, std::string sentence) {
    return {.problem = problem,
            .line = line,
            .sentence = std::move(sentence),
            .next = "Choose another line (--from-line)."};
  }

  std::optional<ResumeRefusal> read_preamble() {
    for (const std::string& line : plan_.preamble()) {
      AxisValues from = resumed_.parser().position_mm;
      resumed_.execute(1, line);
      if (const auto& doubt = resumed_.doubt()) {
        return fault(ResumeProblem::CannotRestore, plan_.from_line,
                     "The line '" + line + "' of the plan " + doubt->because + ".");
      }
      for (const gcode::Action& action : resumed_.actions()) {
        const auto motion = std::visit(MotionOf{}, action);
        if (motion.target_mm == nullptr) continue;
        if (auto refusal = check_motion(from, *motion.target_mm, *motion.feed)) return refusal;
        from = *motion.target_mm;
      }
    }
    return std::nullopt;
  }

  std::optional<ResumeRefusal> check_motion(const AxisValues& from, const AxisValues& to, const gcode::Feed& feed) {
    add_point(to, feed.rapid ? ResumeMotion::Rapid : ResumeMotion::Fed, 0);
    if (auto refusal = check_travel(to, 0)) return refusal;
    if (!feed.rapid) return std::nullopt;
    AxisValues level = from;
    level[kZ] = to[kZ];
    const bool is_upwards = to[kZ] >= from[kZ] && near(level, to, 0.0F);
    const auto highest = static_cast<float>(plan_.highest_cut_mm.value_or(plan_.safe_height_mm));
    if (!is_upwards && std::min(from[kZ], to[kZ]) < highest - kSamePlaceMm) {
      return fault(ResumeProblem::NoSafeHeight, plan_.from_line,
                   "A rapid of the plan would go below what was cut so far.");
    }
    return std::nullopt;
  }

  std::optional<ResumeRefusal> check_travel(const AxisValues& to, std::uint32_t line) const {
    if (!plan_.is_homed) return std::nullopt;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const auto travel = machine::travel_of_axis(axis, with_.capabilities, with_.dialect);
      if (!travel) continue;
      if (to.at(axis) >= travel->min_mm - kSamePlaceMm && to.at(axis) <= travel->max_mm + kSamePlaceMm) continue;
      const std::string place{kAxisLetters.at(axis) + base::to_fixed(static_cast<double>(to.at(axis)), 3)};
      return fault(ResumeProblem::OutsideTravel, line,
                   (line == 0 ? std::string{"The way to the cut"} : "Line " + std::to_string(line)) + " goes to " +
                       place + " in machine coordinates, outside of the travel.");
    }
    return std::nullopt;
  }

  void add_point(const AxisValues& to, ResumeMotion kind, std::uint32_t line) {
    if (plan_.path.size() >= kPointsShown) return;
    plan_.path.push_back({.kind = kind, .position_mm = vector_of(to, axes_), .line = line});
  }

  [[nodiscard]] std::optional<ResumeRefusal> compare_state() const {
    const gcode::ParserState& then = with_.state.parser();
    const gcode::ParserState& now = resumed_.parser();
    const auto differs = [this](std::string_view what) {
      return fault(ResumeProblem::CannotRestore, plan_.from_line,
                   "The plan would not bring back " + std::string{what} + ".");
    };
    gcode::ModalState modal = now.modal;
    // With a line of its own, or by the rewritten line; and a tool length counts by its value.
    modal.motion = then.modal.motion;
    modal.canned_cycle = then.modal.canned_cycle;
    modal.tool_length = then.modal.tool_length;
    if (modal != then.modal) return differs("all modes");
    const bool has_rate = then.modal.feed_mode != gcode::FeedMode::InverseTime && then.feed_rate > 0;
    if (has_rate && !near(then.feed_rate, now.feed_rate, 0.01F)) return differs("the feed rate");
    if (!near(then.spindle_rpm, now.spindle_rpm, 0.5F)) return differs("the spindle speed");
    if (then.tool != now.tool) return differs("the tool number");
    if (!near(then.position_mm, now.position_mm, kSamePlaceMm)) return differs("the position");
    const AxisValues sum = with_.state.reader().work_coordinate_offset();
    if (!near(sum, resumed_.reader().work_coordinate_offset(), kSameOffsetMm)) return differs("the offsets in force");
    return std::nullopt;
  }

  /// The rest must do what it would have done. A line that both readings refuse ends the comparison: the job stops
  /// there.
  std::optional<ResumeRefusal> compare_rest() {
    ProgramState then = with_.state;
    const motion::MotionRules& rules = motion::rules_of(with_.capabilities.family);
    const WireForm form = wire_form_of(with_.dialect);
    std::string text;
    std::uint32_t compared = 0;
    for (auto line = with_.program.line(plan_.from_line); line && compared < kLinesCompared;
         line = with_.program.line_at(with_.program.offset_after(*line), line->number + 1), ++compared) {
      text.clear();
      append_wire_form(text, line->text, form);
      const AxisValues from_then = then.parser().position_mm;
      const AxisValues from_now = resumed_.parser().position_mm;
      then.execute(line->number, text);
      const bool is_rewritten = plan_.rewritten && plan_.rewritten->line == line->number;
      resumed_.execute(line->number, is_rewritten ? std::string_view{plan_.rewritten->text} : std::string_view{text});
      if (!same_motions({then.actions(), from_then}, {resumed_.actions(), from_now}, rules)) {
        return fault(ResumeProblem::CannotRestore, line->number,
                     "Line " + std::to_string(line->number) + " would not do what it does in the whole program.");
      }
      if (then.doubt()) break;
      for (const gcode::Action& action : resumed_.actions()) {
        const auto motion = std::visit(MotionOf{}, action);
        if (motion.target_mm == nullptr) continue;
        if (auto refusal = check_travel(*motion.target_mm, line->number)) return refusal;
        add_point(*motion.target_mm, motion.feed->rapid ? ResumeMotion::Rapid : ResumeMotion::Cut, line->number);
      }
    }
    return std::nullopt;
  }

  ResumePlan& plan_;
  const PlanCheck& with_;
  std::size_t axes_;
  ProgramState resumed_;
};

}  // namespace

std::optional<OffsetDifference> first_difference(const gcode::Offsets& then, const gcode::Offsets& now,
                                                 const vocabulary::Dialect& dialect, std::size_t axes) {
  const auto difference = [axes](std::string_view name, const AxisValues& a, const AxisValues& b) {
    return OffsetDifference{.name = std::string{name}, .then = text_of_axes(a, axes), .now = text_of_axes(b, axes)};
  };
  for (std::size_t i = 0; i < then.work.size(); ++i) {
    if (near(then.work.at(i), now.work.at(i), kSameOffsetMm)) continue;
    return difference(work_offset_name(i), then.work.at(i), now.work.at(i));
  }
  const bool wiped_g92 = is_zero(now.g92) && !dialect.keeps_g92_over_reset;
  if (!wiped_g92 && !near(then.g92, now.g92, kSameOffsetMm) && !is_zero(now.g92)) {
    return difference("G92", then.g92, now.g92);
  }
  if (!is_zero(now.tool_length) && !near(then.tool_length, now.tool_length, kSameOffsetMm)) {
    return difference("The tool length offset", then.tool_length, now.tool_length);
  }
  return std::nullopt;
}

std::optional<ResumeRefusal> check_plan(ResumePlan& plan, const PlanCheck& with) {
  return Check(plan, with).run();
}

}  // namespace kerf::job
