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
  for (std::string_view rest = program.text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const auto line = reader.push_line(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (!line || line->text.empty()) continue;
    actions.clear();
    if (interpreter.interpret(line->text, actions)) visit(actions);
  }
}

/// Calls `visit(line)` for every line and chord for the planner.
template <typename Visit>
void walk_path(const BenchProgram& program, const simulation::CaseMachine& machine, Visit visit) {
  const motion::MotionRules& rules = motion::rules_of(machine.personality.firmware);
  const firmware::SettingsStore settings{machine.personality, firmware::axes_of(machine.personality, machine.stored)};
  gcode::Interpreter interpreter(gcode::rules_for(machine.personality.firmware));
  vocabulary::AxisValues at{};
  interpret_lines(program, interpreter, [&](const std::vector<gcode::Action>& actions) {
    for (const gcode::Action& action : actions) {
      std::visit(
          base::Overloaded{
              [&](const gcode::LinearMove& move) { visit({.target_mm = at = move.target_mm, .feed = move.feed}); },
              [&](const gcode::ArcMove& move) {
                motion::ArcChords chords(motion::arc_of(move, at), rules, settings.motion());
                while (const auto chord = chords.next()) visit({.target_mm = *chord, .feed = move.feed});
                at = move.target_mm;
              },
              [](const auto&) {},
          },
          action);
    }
  });
}

/// A queue that is always full: one block out, one in.
class FullPlanner {
 public:
  explicit FullPlanner(const simulation::CaseMachine& machine)
      : settings_(machine.personality, firmware::axes_of(machine.personality, machine.stored)),
        planner_(motion::rules_of(machine.personality.firmware), settings_.motion()) {
    static_cast<void>(settings_.load(machine.stored));
  }
  void plan(const motion::PathLine& line) {
    if (planner_.is_full()) {
      speeds_ += planner_.current()->entry_speed_sqr;
      planner_.discard_front();
      ++blocks_;
    }
    planner_.plan(line);
  }
  [[nodiscard]] float speeds() const { return speeds_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }

 private:
  firmware::SettingsStore settings_;
  motion::Planner planner_;
  float speeds_ = 0;
  std::size_t blocks_ = 0;
};

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
  std::vector<motion::PathLine> path;
  walk_path(program, machine, [&](const motion::PathLine& line) { path.push_back(line); });
  return path;
}

float plan(const std::vector<motion::PathLine>& path, const simulation::CaseMachine& machine) {
  FullPlanner planner(machine);
  for (const motion::PathLine& line : path) planner.plan(line);
  return planner.speeds();
}

std::size_t plan_whole(const BenchProgram& program, const simulation::CaseMachine& machine) {
  FullPlanner planner(machine);
  walk_path(program, machine, [&](motion::PathLine line) { planner.plan(line); });
  return planner.speeds() < 0 ? 0 : planner.blocks();
}

simulation::MotionTrace simulate(const BenchProgram& program, const simulation::CaseMachine& machine) {
  return simulation::trace_program({.program = program.text}, machine);
}

}  // namespace kerf::bench
