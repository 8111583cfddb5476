#include "sender/job/resume_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using gcode::SpindleDirection;
using vocabulary::AxisValues;
using vocabulary::kAxisLetters;

constexpr std::size_t kZ = 2;
/// Offsets are printed with three decimals, so two of them that print alike differ by less.
constexpr float kSameMm = 0.0025F;
constexpr float kNothing = 1e-6F;

bool differ(const AxisValues& a, const AxisValues& b) {
  for (std::size_t axis = 0; axis < a.size(); ++axis) {
    if (std::abs(a.at(axis) - b.at(axis)) > kSameMm) return true;
  }
  return false;
}

bool is_zero(const AxisValues& values) {
  return std::ranges::all_of(values, [](float value) { return std::abs(value) < kNothing; });
}

std::string trimmed(std::string text) {
  if (text.contains('.')) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string mm(float value) {
  return base::to_fixed(static_cast<double>(value), 3) + " mm";
}

std::string axis_words(const AxisValues& values, std::size_t axes) {
  std::string words;
  for (std::size_t axis = 0; axis < axes; ++axis) (words += kAxisLetters.at(axis)) += number_text(values.at(axis));
  return words;
}

std::string_view spindle_word(SpindleDirection direction) {
  switch (direction) {
    case SpindleDirection::Clockwise: return "M3";
    case SpindleDirection::Counterclockwise: return "M4";
    case SpindleDirection::Off: break;
  }
  return "M5";
}

/// A word that brings an axis to `place_mm` in machine coordinates to the last bit, as this controller reads it; empty
/// if there is none. Where an arc ends in its beginning, that bit decides whether it is a full circle or nothing.
/// `before` are words that say how it is meant: in machine coordinates (G53), or as the program counts.
std::string exact_word(std::string_view before, std::size_t axis, float place_mm, float near_mm,
                       gcode::Interpreter reader) {
  constexpr int kDigits = 8;
  constexpr int kMostOff = 40;
  int whole = 1;
  for (float size = std::abs(near_mm); size >= 10.0F; size /= 10.0F) ++whole;
  std::vector<gcode::Action> actions;
  const auto is_read_back = [&](const std::string& word) {
    actions.clear();
    if (!reader.interpret("G21G90G94G0" + std::string{before} + word, actions)) return false;
    return reader.state().position_mm.at(axis) == place_mm;
  };
  for (int decimals = 3; decimals <= std::max(kDigits - whole, 3); ++decimals) {
    const double unit = std::pow(10.0, -decimals);
    for (int off = 0; off <= kMostOff; ++off) {
      for (const int sign : {1, -1}) {
        const double value = static_cast<double>(near_mm) + sign * off * unit;
        const std::string word = kAxisLetters.at(axis) + trimmed(base::to_fixed(value, decimals));
        if (is_read_back(word)) return word;
      }
    }
  }
  return {};
}

class Steps {
 public:
  explicit Steps(const StepInputs& inputs)
      : in_(inputs),
        at_(inputs.state.parser()),
        axes_(static_cast<std::size_t>(inputs.state.reader().settings().axes)) {}

  std::vector<ResumeStep> run() {
    check_position();
    check_tool();
    prepare();
    retract();
    if (!in_.is_laser) switch_on();
    travel();
    offsets();
    descend();
    plunge();
    modes();
    if (in_.is_laser) switch_on();
    return std::move(steps_);
  }

 private:
  void add(ResumeStepKind kind, std::string text, std::string reason, std::vector<std::string> lines,
           bool asks = false) {
    steps_.push_back(
        {.kind = kind, .text = std::move(text), .reason = std::move(reason), .lines = std::move(lines), .asks = asks});
  }

  void check_position() {
    if (in_.position_text.empty()) return;
    add(ResumeStepKind::CheckPosition, in_.position_text, "The tool goes back to the cut by machine coordinates.", {},
        in_.asks_for_position);
  }

  void check_tool() {
    const std::uint32_t line = in_.state.tool_history().tool_line;
    if (at_.tool == 0 && in_.present.state().tool == 0 && line == 0) return;
    std::vector<std::string> lines;
    const bool has_m61 = in_.dialect.tool_change == vocabulary::ToolChangeRule::AsTold;
    if (at_.tool != in_.present.state().tool) {
      lines.push_back((has_m61 ? "M61Q" : "T") + std::to_string(at_.tool));
    }
    if (has_m61 && at_.tool_pending != at_.tool) lines.push_back("T" + std::to_string(at_.tool_pending));
    const std::string tool = at_.tool == 0 ? "The first tool" : "Tool " + std::to_string(at_.tool);
    add(ResumeStepKind::CheckTool, tool + " must be in the spindle, at its old length.",
        line > 0 ? "Line " + std::to_string(line) + " called for it." : "It was in when the job began.",
        std::move(lines), true);
  }

  void prepare() {
    std::vector<std::string> lines{"G21G90G94G17"};
    if (in_.is_laser) lines.emplace_back("M5");
    add(ResumeStepKind::Prepare,
        in_.is_laser ? "Millimetres, absolute, beam off." : "Millimetres, absolute, feed per minute.",
        "The way to the cut does not depend on the modes of the program.", std::move(lines));
  }

  void retract() {
    add(ResumeStepKind::Retract, "Straight up to Z" + mm(in_.safe_height_mm) + " in machine coordinates.",
        "Nothing stands in the way of a motion that only goes up, and that height is known to be clear.",
        {"G53G0Z" + number_text(in_.safe_height_mm)});
  }

  void switch_on() {
    std::vector<std::string> lines;
    for (const auto& [port, value] : in_.state.tool_history().outputs) {
      const auto& [is_digital, number] = port;
      const std::string name = std::to_string(number);
      lines.push_back(is_digital ? (value != 0.0F ? "M64P" : "M65P") + name : "M68E" + name + "Q" + number_text(value));
    }
    const bool turns = at_.modal.spindle != SpindleDirection::Off;
    std::string text = turns ? "Spindle on" : "Spindle off";
    // What is on in the mind of the controller may stand still (after homing, after a door), and then M3 alone is no
    // news.
    if (turns) lines.emplace_back("M5");
    std::string word{spindle_word(at_.modal.spindle)};
    if (at_.spindle_rpm > 0 || in_.present.state().spindle_rpm > 0) word += "S" + number_text(at_.spindle_rpm);
    lines.push_back(word);
    const bool is_wet = in_.present.state().modal.coolant != gcode::Coolant{};
    if (is_wet || at_.modal.coolant == gcode::Coolant{}) lines.emplace_back("M9");
    if (at_.modal.coolant.mist) lines.emplace_back("M7");
    if (at_.modal.coolant.flood) lines.emplace_back("M8");
    if (turns && in_.spin_up_s > 0) {
      lines.push_back("G4P" + number_text(in_.spin_up_s));
      text += ", and " + base::to_fixed(static_cast<double>(in_.spin_up_s), 1) + " s to come up to speed";
    }
    text += at_.modal.coolant == gcode::Coolant{} ? "; no coolant." : "; coolant on.";
    if (in_.is_laser) text = turns ? "Beam as the program left it." : "Beam off, as the program left it.";
    add(ResumeStepKind::SwitchOn, std::move(text),
        in_.is_laser ? "The beam was off on the way." : "A cutter must turn before it comes down.", std::move(lines));
  }

  void travel() {
    std::string words;
    std::string text;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      if (axis == kZ) continue;
      words += machine_word(axis).value_or(kAxisLetters.at(axis) + number_text(at_.position_mm.at(axis)));
      (text += " ") += kAxisLetters.at(axis);
      text += base::to_fixed(static_cast<double>(at_.position_mm.at(axis)), 3);
    }
    add(ResumeStepKind::Travel, "Across at that height to" + text + " in machine coordinates.",
        "There the line begins.", {"G53G0" + words});
  }

  void offsets() {
    std::vector<std::string> lines;
    const gcode::Offsets& then = in_.state.offsets();
    const gcode::Offsets& now = in_.present.offsets();
    for (std::size_t i = 0; in_.writes_offsets && i < in_.state.reader().rules().work_offsets; ++i) {
      if (!differ(then.work.at(i), now.work.at(i))) continue;
      lines.push_back("G10L2P" + std::to_string(i + 1) + axis_words(then.work.at(i), axes_));
    }
    lines.emplace_back(work_offset_name(at_.modal.work_offset));
    add_tool_length(lines, then.tool_length, now.tool_length);
    if (differ(then.g92, now.g92)) lines.push_back(is_zero(then.g92) ? "G92.1" : g92_line(then));
    std::string exactly;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      if (axis != kZ && !machine_word(axis)) exactly += program_word(axis).value_or("");
    }
    // There it stands already, but for a rounding in the mind of the controller.
    if (!exactly.empty()) lines.push_back("G0" + exactly);
    std::string text = "Offsets: " + lines_text(lines) + ".";
    add(ResumeStepKind::Offsets, std::move(text),
        "The program counts from there at this line; the rest agrees with what the controller has stored.",
        std::move(lines));
  }

  void add_tool_length(std::vector<std::string>& lines, const AxisValues& then, const AxisValues& now) const {
    const bool is_active = at_.modal.tool_length != gcode::ToolLengthMode::None;
    if (!is_active || is_zero(then)) {
      if (!is_zero(now)) lines.emplace_back("G49");
      return;
    }
    if (!in_.dialect.tool_length_offset_per_axis) {
      lines.push_back("G43.1Z" + number_text(then[kZ]));
      return;
    }
    std::string words = "G43.1";
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      if (axis == kZ || std::abs(then.at(axis)) > kNothing || std::abs(now.at(axis)) > kNothing) {
        (words += kAxisLetters.at(axis)) += number_text(then.at(axis));
      }
    }
    lines.push_back(words);
  }

  /// G92 says what the place where the machine stands is called: here the end of the way across.
  [[nodiscard]] std::string g92_line(const gcode::Offsets& then) const {
    AxisValues place = at_.position_mm;
    place[kZ] = in_.safe_height_mm;
    const bool has_length = at_.modal.tool_length != gcode::ToolLengthMode::None;
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      place.at(axis) -= then.work.at(at_.modal.work_offset).at(axis) + then.g92.at(axis) +
                        (has_length ? then.tool_length.at(axis) : 0.0F);
    }
    return "G92" + axis_words(place, axes_);
  }

  static std::string lines_text(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) (text += text.empty() ? "" : ", ") += line;
    return text;
  }

  void descend() {
    if (!in_.rapid_to_mm || *in_.rapid_to_mm >= in_.safe_height_mm) return;
    add(ResumeStepKind::Descend, "Rapid down to Z" + mm(*in_.rapid_to_mm) + ".",
        "That is above everything that was cut so far.", {"G53G0Z" + number_text(*in_.rapid_to_mm)});
  }

  void plunge() {
    const float from = std::min(in_.safe_height_mm, in_.rapid_to_mm.value_or(in_.safe_height_mm));
    const float to = at_.position_mm[kZ];
    if (std::abs(from - to) < kNothing) return;
    std::string word = "G53G1Z" + number_text(to);
    if (const auto exact = machine_word(kZ)) {
      word = "G53G1" + *exact;
    } else if (const auto as_program = program_word(kZ)) {
      word = "G1" + *as_program;
    }
    add(ResumeStepKind::Plunge,
        "Fed to Z" + mm(to) + " at " + base::to_fixed(static_cast<double>(in_.plunge_mm_per_min), 0) + " mm/min.",
        "The tool may meet material from here on.", {word + "F" + number_text(in_.plunge_mm_per_min)});
  }

  /// The place of the line in machine coordinates, if that can be said exactly.
  [[nodiscard]] std::optional<std::string> machine_word(std::size_t axis) const {
    const float place = at_.position_mm.at(axis);
    std::string word = exact_word("G53", axis, place, place, in_.present);
    return word.empty() ? std::nullopt : std::optional{std::move(word)};
  }

  /// The same place as the program calls it, once its offsets are in force.
  [[nodiscard]] std::optional<std::string> program_word(std::size_t axis) const {
    const float place = at_.position_mm.at(axis);
    const float called = place - in_.state.reader().work_coordinate_offset().at(axis);
    std::string word = exact_word("", axis, place, called, in_.state.reader());
    return word.empty() ? std::nullopt : std::optional{std::move(word)};
  }

  void modes() {
    std::vector<std::string> lines;
    if (at_.modal.feed_mode == gcode::FeedMode::UnitsPerMinute && at_.feed_rate > 0) {
      lines.push_back("F" + number_text(at_.feed_rate));
    }
    // In inverse time a lone G1 would want a feed of its own, so it comes before G93.
    if (!in_.motion_word.empty()) lines.push_back(in_.motion_word);
    add_overrides(lines);
    std::string words;
    if (at_.modal.plane == gcode::Plane::ZX) words += "G18";
    if (at_.modal.plane == gcode::Plane::YZ) words += "G19";
    if (at_.modal.feed_mode == gcode::FeedMode::InverseTime) words += "G93";
    if (at_.modal.retract != in_.present.state().modal.retract) {
      words += at_.modal.retract == gcode::RetractMode::Previous ? "G98" : "G99";
    }
    if (at_.modal.incremental) words += "G91";
    if (at_.modal.inches) words += "G20";
    if (!words.empty()) lines.push_back(words);
    if (at_.modal.feed_mode == gcode::FeedMode::UnitsPerRevolution) {
      lines.push_back("G95F" + number_text(at_.modal.inches ? at_.feed_rate / 25.4F : at_.feed_rate));
    }
    if (lines.empty()) return;
    std::string text = "Modes of the program: " + lines_text(lines) + ".";
    add(ResumeStepKind::Modes, std::move(text), "The lines before set them, and the rest relies on them.",
        std::move(lines));
  }

  void add_overrides(std::vector<std::string>& lines) const {
    const auto& then = at_.modal.overrides;
    const auto& now = in_.present.state().modal.overrides;
    const auto restore = [&](bool wanted, bool has, std::string_view word) {
      if (wanted != has) lines.push_back(std::string{word} + (wanted ? "P1" : "P0"));
    };
    restore(then.feed, now.feed, "M50");
    restore(then.spindle, now.spindle, "M51");
    restore(then.feed_hold, now.feed_hold, "M53");
    restore(then.parking, now.parking, "M56");
  }

  const StepInputs& in_;
  const gcode::ParserState& at_;
  std::size_t axes_;
  std::vector<ResumeStep> steps_;
};

}  // namespace

std::string number_text(float value) {
  constexpr int kDigits = 8;
  constexpr int kMostDecimals = 6;
  int decimals = kMostDecimals;
  for (float size = std::abs(value); size >= 10.0F && decimals > 0; size /= 10.0F) --decimals;
  decimals = std::min(decimals, kDigits - 1);
  return trimmed(base::to_fixed(static_cast<double>(value), decimals));
}

std::vector<ResumeStep> steps_to(const StepInputs& inputs) {
  return Steps(inputs).run();
}

}  // namespace kerf::job
