#pragma once
// Programs for tests of transforms, and where they lead: by chance, but within 80 mm of zero.

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "rehearsal/program_reading.hpp"
#include "sender/job/program.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/dice.hpp"
#include "simulation/motion_trace.hpp"
#include "simulation/program_writer.hpp"

namespace kerf::rehearsal {

/// 320 steps a mm: of numbers with three decimals none lies in the middle between two steps.
inline constexpr double kTestSteps = 320.0;

inline simulation::CaseMachine test_machine(vocabulary::Firmware firmware) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(firmware)};
  machine.stored.initialised = true;
  machine.stored.settings = {{"1", "255"},    {"12", "0.002"}, {"100", "320"},  {"101", "320"},
                             {"102", "320"},  {"110", "6000"}, {"111", "6000"}, {"112", "6000"},
                             {"120", "2000"}, {"121", "2000"}, {"122", "2000"}};
  return machine;
}

inline std::shared_ptr<const job::Program> test_program(std::string text) {
  return *job::Program::load("part.nc", std::move(text));
}

struct TestJobParts {
  bool upright_arcs = true;  ///< G18 and G19
  bool arcs = true;
  bool inches = true;
  bool shifts = true;  ///< G92
  bool cycles = true;  ///< grblHAL only
  /// Grbl and Rabbit lose a whole circle once in a while, by the last bits of its place.
  bool circles = true;
};

/// Writes what a job may hold, one motion after the other.
class TestJobWriter {
 public:
  TestJobWriter(simulation::Dice& dice, const TestJobParts& parts) : dice_(dice), parts_(parts) {}

  std::string write(int statements) {
    writer_.say("(By chance) G21 G90 G17");
    // All axes are told before anything else.
    writer_.rapid({.x = place(), .y = place(), .z = height()});
    for (int at = 0; at < statements; ++at) statement();
    return writer_.take();
  }

 private:
  double place() { return dice_.between(-40000, 40000) / 1000.0; }
  double height() { return dice_.between(-4000, 9000) / 1000.0; }
  double feed() { return dice_.pick({300.0, 800.0, 2400.0}); }

  simulation::Target target() {
    simulation::Target to;
    if (dice_.one_in(2)) to.x = place();
    if (dice_.one_in(2)) to.y = place();
    if (dice_.one_in(3) || (!to.x && !to.y)) to.z = height();
    return to;
  }

  void statement() {
    switch (dice_.below(9)) {
      case 0: return writer_.rapid(target());
      case 1: return parts_.arcs ? arc() : writer_.feed(target(), feed());
      case 2: return parts_.arcs ? arc() : writer_.rapid(target());
      case 3:
        if (parts_.inches) writer_.use_inches(dice_.one_in(2));
        return;
      case 4: return writer_.use_increments(dice_.one_in(2));
      case 5: return shift();
      case 6: return parts_.upright_arcs && parts_.arcs ? groove() : writer_.feed(target(), feed());
      case 7: return parts_.cycles && !writer_.increments() && !writer_.is_shifted() ? drill() : writer_.say("G4P0.01");
      default: return writer_.feed(target(), feed());
    }
  }

  void arc() {
    const double radius = dice_.between(2000, 15000) / 1000.0;
    const double from = dice_.within(-3.1, 3.1);
    const bool short_way = dice_.one_in(3);
    const double sweep = short_way ? dice_.within(0.3, 2.8) : dice_.within(0.3, 5.9);
    const bool clockwise = dice_.one_in(2);
    const double to = clockwise ? from - sweep : from + sweep;
    const double center_x = writer_.at().x - radius * std::cos(from);
    const double center_y = writer_.at().y - radius * std::sin(from);
    simulation::Target target{.x = center_x + radius * std::cos(to), .y = center_y + radius * std::sin(to)};
    if (std::abs(*target.x) > 70 || std::abs(*target.y) > 70) return;
    if (dice_.one_in(5)) target.z = height();
    if (parts_.circles && dice_.one_in(6)) {
      // A circle begins at a place with the same numbers; else the last bits decide whether it is one.
      writer_.rapid({.x = place(), .y = place()});
      const auto at = writer_.at();
      return writer_.arc(clockwise, {.x = at.x, .y = at.y}, at.x + radius, at.y - 1, feed(), false);
    }
    writer_.arc(clockwise, target, center_x, center_y, feed(), short_way && dice_.one_in(2));
  }

  void groove() {
    const std::size_t axis = dice_.below(2);
    const double at = axis == 0 ? writer_.at().x : writer_.at().y;
    const double to = at + dice_.pick({-8.0, 6.0, 10.0});
    if (std::abs(to) > 70) return;
    writer_.groove(axis, to, 12.0, feed());
  }

  void shift() {
    if (!parts_.shifts) return;
    if (!writer_.is_shifted()) return writer_.shift_zero(place(), place());
    writer_.end_shift();
    // After that nobody knows the names of places.
    writer_.use_increments(false);
    writer_.rapid({.x = place(), .y = place(), .z = height()});
  }

  void drill() {
    const std::optional<double> peck = dice_.one_in(2) ? std::optional{0.7} : std::nullopt;
    writer_.drill(writer_.at().z - 3, writer_.at().z - 0.5, 400, peck);
    writer_.drill_next(place(), place());
    writer_.end_drilling();
  }

  simulation::Dice& dice_;
  TestJobParts parts_;
  simulation::ProgramWriter writer_;
};

/// Where each line leads, by the interpreter: machine coordinates; the first line is 1.
inline std::vector<std::array<double, 3>> places_of(const job::Program& program, const vocabulary::Dialect& dialect) {
  gcode::Interpreter interpreter(gcode::rules_for(dialect), {.axes = 3});
  std::vector<std::array<double, 3>> places{{}};
  std::vector<gcode::Action> actions;
  std::string wire;
  for (auto line = program.line_at(0, 1); line; line = program.line_at(program.offset_after(*line), line->number + 1)) {
    wire.clear();
    actions.clear();
    job::append_wire_form(wire, line->text, job::wire_form_of(dialect));
    if (!wire.empty()) static_cast<void>(interpreter.interpret(wire, actions));
    const auto& at = interpreter.state().position_mm;
    places.push_back({at[0], at[1], at[2]});
  }
  return places;
}

}  // namespace kerf::rehearsal
