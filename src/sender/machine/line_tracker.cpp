#include "sender/machine/line_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "common/base/text.hpp"
#include "common/gcode/rules.hpp"
#include "common/motion/arc_extent.hpp"
#include "common/vocabulary/axis.hpp"

namespace kerf::machine {
namespace {

using vocabulary::AxisValues;

/// Two roundings of the last digit that controllers print.
constexpr double kSameOffset = 0.0025;

AxisValues axis_values(const std::vector<double>& values) {
  AxisValues result{};
  for (std::size_t axis = 0; axis < std::min(values.size(), result.size()); ++axis) {
    result[axis] = static_cast<float>(values[axis]);
  }
  return result;
}

/// `[TLO:]` has one number for Z on Grbl and Rabbit.
AxisValues tool_length_values(const std::vector<double>& values) {
  constexpr std::size_t kZ = 2;
  if (values.size() != 1) return axis_values(values);
  AxisValues result{};
  result[kZ] = static_cast<float>(values.front());
  return result;
}

struct OffsetSlot {
  std::string_view name;
  std::size_t index;
};
constexpr OffsetSlot kSlots[] = {{"G54", 0}, {"G55", 1},   {"G56", 2},   {"G57", 3},  {"G58", 4},
                                 {"G59", 5}, {"G59.1", 6}, {"G59.2", 7}, {"G59.3", 8}};

void load_offsets(gcode::Offsets& offsets, const Snapshot& snapshot) {
  const auto at = [&](std::string_view name) {
    const auto found = snapshot.offsets_mm.find(std::string{name});
    return found == snapshot.offsets_mm.end() ? AxisValues{} : axis_values(found->second);
  };
  for (const OffsetSlot& slot : kSlots) offsets.work[slot.index] = at(slot.name);
  offsets.g28 = at("G28");
  offsets.g30 = at("G30");
  offsets.g92 = at("G92");
  if (snapshot.tool_length.offset_mm) offsets.tool_length = tool_length_values(*snapshot.tool_length.offset_mm);
}

std::string number_word(char letter, const std::optional<double>& value) {
  constexpr int kDecimals = 3;
  return value && *value > 0 ? letter + base::to_fixed(*value, kDecimals) : std::string{};
}

/// What has to be said in millimetres, before the modes.
std::string rates_line(const ParserModes& modes) {
  const bool is_rate = modes.feed_mode.empty() || modes.feed_mode == "G94";
  return "G21" + (is_rate ? number_word('F', modes.feed_mm_per_min) : "") + number_word('S', modes.spindle_rpm);
}

/// Words of `[GC:]` for which Snapshot has no place of its own: diameters, and where canned cycles retract to.
constexpr std::string_view kFurtherModes[] = {"G7", "G8", "G98", "G99"};

/// Factors of scaling, and what macros do, are told nowhere.
constexpr std::string_view kUntold[] = {"G51", "G66"};

bool has_word(const Snapshot& snapshot, std::string_view word) {
  return std::ranges::find(snapshot.parser_words, word) != snapshot.parser_words.end();
}

/// Modes that a line of words may set without moving anything.
std::string mode_line(const Snapshot& snapshot) {
  const ParserModes& modes = snapshot.modes;
  std::string line;
  for (const std::string_view word : kFurtherModes) {
    if (has_word(snapshot, word)) line += word;
  }
  for (const std::string* word :
       {&modes.plane, &modes.units, &modes.distance, &modes.feed_mode, &modes.work_coordinates, &modes.spindle}) {
    line += *word;
  }
  if (modes.motion == "G0" || modes.motion == "G1" || modes.motion == "G80") line += modes.motion;
  return line;
}

struct MotionEnd {
  const AxisValues* operator()(const gcode::LinearMove& move) const { return &move.target_mm; }
  const AxisValues* operator()(const gcode::ArcMove& move) const { return &move.target_mm; }
  const AxisValues* operator()(const gcode::ProbeMove& move) const { return &move.target_mm; }
  const AxisValues* operator()(const auto&) const { return nullptr; }
};

std::vector<double> vector_of(const AxisValues& values, std::size_t axes) {
  std::vector<double> result;
  for (std::size_t axis = 0; axis < axes; ++axis) result.push_back(static_cast<double>(values.at(axis)));
  return result;
}

bool agrees(const AxisValues& sum, const std::vector<double>& reported) {
  for (std::size_t axis = 0; axis < reported.size(); ++axis) {
    if (std::abs(static_cast<double>(sum.at(axis)) - reported[axis]) > kSameOffset) return false;
  }
  return true;
}

}  // namespace

void LineTracker::seed(const Snapshot& snapshot, const vocabulary::Dialect& dialect,
                       gcode::InterpreterSettings settings) {
  interpreter_.reset();
  if (!snapshot.machine_position_mm || !snapshot.work_offset_mm || snapshot.parser_words.empty()) return;
  const auto is_set = [&](std::string_view word) { return has_word(snapshot, word); };
  if (!snapshot.scaled_axes.empty() || std::ranges::any_of(kUntold, is_set)) return;
  axes_ = std::min(snapshot.machine_position_mm->size(), vocabulary::kMaxAxes);
  settings.axes = static_cast<int>(axes_);
  auto& interpreter = interpreter_.emplace(gcode::rules_for(dialect), settings);
  load_offsets(interpreter.offsets(), snapshot);
  interpreter.reload_offsets();
  interpreter.sync_position(axis_values(*snapshot.machine_position_mm));
  actions_.clear();
  if (!interpreter.interpret(rates_line(snapshot.modes), actions_) ||
      !interpreter.interpret(mode_line(snapshot), actions_)) {
    interpreter_.reset();
    return;
  }
  interpreter.reload_offsets();
  // Offsets that do not add up to what is reported are not understood.
  if (!agrees(interpreter.work_coordinate_offset(), *snapshot.work_offset_mm)) interpreter_.reset();
}

void LineTracker::on_accepted(std::string_view line) {
  if (!interpreter_) return;
  const std::string_view text = base::trim(line);
  if (text.starts_with('$')) {
    const bool moves = base::starts_with_ignoring_case(text, "$J") || base::starts_with_ignoring_case(text, "$H") ||
                       base::starts_with_ignoring_case(text, "$RST") || base::starts_with_ignoring_case(text, "$T");
    if (moves) forget();
    return;
  }
  actions_.clear();
  const bool understood = interpreter_->interpret(text, actions_).has_value();
  const bool is_beyond = std::ranges::any_of(actions_, [](const gcode::Action& action) {
    return std::holds_alternative<gcode::ProbeMove>(action) || std::holds_alternative<gcode::ToolChange>(action);
  });
  if (!understood || is_beyond) forget();
}

// Of arcs also the places where they go beyond their ends.
std::vector<std::vector<double>> LineTracker::targets_of(std::string_view line) const {
  std::vector<std::vector<double>> targets;
  if (!interpreter_) return targets;
  gcode::Interpreter reader = *interpreter_;
  const std::string_view text = base::trim(line);
  constexpr std::string_view kJog = "$J=";
  if (base::starts_with_ignoring_case(text, kJog)) {
    if (const auto jog = reader.interpret_jog(text.substr(kJog.size()))) {
      targets.push_back(vector_of(jog->target_mm, axes_));
    }
    return targets;
  }
  std::vector<gcode::Action> actions;
  AxisValues at = reader.state().position_mm;
  if (text.starts_with('$') || !reader.interpret(text, actions)) return targets;
  for (const gcode::Action& action : actions) {
    const auto* const end = std::visit(MotionEnd{}, action);
    if (end == nullptr) continue;
    if (const auto* const arc = std::get_if<gcode::ArcMove>(&action)) {
      for (const AxisValues& place : motion::extremes_of(motion::arc_of(*arc, at))) {
        targets.push_back(vector_of(place, axes_));
      }
    }
    targets.push_back(vector_of(*end, axes_));
    at = *end;
  }
  return targets;
}

}  // namespace kerf::machine
