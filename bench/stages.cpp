#include "stages.hpp"

#include <variant>

#include "common/base/overloaded.hpp"
#include "common/gcode/interpreter.hpp"
#include "common/gcode/line_reader.hpp"
#include "common/motion/arc.hpp"
#include "firmware/settings_store.hpp"

namespace kerf::bench {
namespace {

/// Calls `visit(actions)` for each line that has any.
template <typename Visit>
void interpret_lines(const BenchProgram& program, gcode::Interpreter& interpreter, Visit visit) {
  gcode::LineReader reader(interpreter.rules().line);
  std::vector<gcode::Action> actions;
  for (const char byte : program.text) {
    const auto line = reader.push(byte);
    if (!line || line->text.empty()) continue;
    actions.clear();
    if (interpreter.interpret(line->text, actions)) visit(actions);
  }
}

}  // namespace

simulation::CaseMachine machine_for(const BenchProgram& program, vocabulary::Firmware firmware) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(firmware)};
  static_cast<void>(firmware::apply_settings_text(machine.stored, program.settings));
  for (std::size_t axis = 0; axis < vocabulary::kMaxAxes; ++axis) {
    machine.workcell.emplace_back(
        firmware::HomingSwitchMoved{.axis = static_cast<vocabulary::Axis>(axis), .distance_mm = std::nullopt});
  }
  return machine;
}

std::size_t parse(const BenchProgram& program, vocabulary::Firmware firmware) {
  gcode::Interpreter interpreter(gcode::rules_for(firmware));
  std::size_t count = 0;
  interpret_lines(program, interpreter, [&](const std::vector<gcode::Action>& actions) { count += actions.size(); });
  return count;
}

std::vector<motion::PathLine> path_of(const BenchProgram& program, const simulation::CaseMachine& machine) {
  const motion::MotionRules& rules = motion::rules_of(machine.personality.firmware);
  const firmware::SettingsStore settings{machine.personality, firmware::axes_of(machine.personality, machine.stored)};
  gcode::Interpreter interpreter(gcode::rules_for(machine.personality.firmware));
  std::vector<motion::PathLine> path;
  vocabulary::AxisValues at{};
  interpret_lines(program, interpreter, [&](const std::vector<gcode::Action>& actions) {
    for (const gcode::Action& action : actions) {
      std::visit(base::Overloaded{
                     [&](const gcode::LinearMove& move) {
                       path.push_back({.target_mm = at = move.target_mm, .feed = move.feed});
                     },
                     [&](const gcode::ArcMove& move) {
                       motion::ArcChords chords(motion::arc_of(move, at), rules, settings.motion());
                       while (const auto chord = chords.next())
                         path.push_back({.target_mm = *chord, .feed = move.feed});
                       at = move.target_mm;
                     },
                     [](const auto&) {},
                 },
                 action);
    }
  });
  return path;
}

float plan(const std::vector<motion::PathLine>& path, const simulation::CaseMachine& machine) {
  firmware::SettingsStore settings{machine.personality, firmware::axes_of(machine.personality, machine.stored)};
  static_cast<void>(settings.load(machine.stored));
  motion::Planner planner(motion::rules_of(machine.personality.firmware), settings.motion());
  float speeds = 0;
  for (const motion::PathLine& line : path) {
    if (planner.is_full()) {
      speeds += planner.current()->entry_speed_sqr;
      planner.discard_front();
    }
    planner.plan(line);
  }
  return speeds;
}

simulation::MotionTrace simulate(const BenchProgram& program, const simulation::CaseMachine& machine) {
  return simulation::trace_program({.program = program.text}, machine);
}

}  // namespace kerf::bench
