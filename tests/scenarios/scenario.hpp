#pragma once
// What the scenarios share: machines that are quick enough for a test, small programs, and questions to a world.

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "common/vocabulary/firmware.hpp"
#include "sender/job/program.hpp"
#include "simulation/world.hpp"

namespace kerf::scenarios {

using namespace kerf::simulation;

/// A world of which the wire log is replayed at its end: it must give the same bytes. And its watch must have seen no
/// line that went to a machine in motion which the sender did not start, and no reset without a word.
class World : public simulation::World {
 public:
  using simulation::World::World;
  ~World() {
    for (const std::string& promise : line_watch().broken()) ADD_FAILURE() << promise;
    for (const std::string& log : earlier_wire_logs()) expect_replay_of(log);
    expect_replay_of(wire_log());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

 private:
  static void expect_replay_of(const std::string& log) {
    if (const auto stop = session::replay_text(log)) ADD_FAILURE() << "Replay: " << session::sentence_of(*stop);
  }
};

inline constexpr std::array kFirmwares{vocabulary::Firmware::Grbl, vocabulary::Firmware::Rabbit,
                                       vocabulary::Firmware::GrblHal};

/// For names of parameterised tests.
inline std::string word_for(vocabulary::Firmware firmware) {
  switch (firmware) {
    case vocabulary::Firmware::Grbl: return "Grbl";
    case vocabulary::Firmware::Rabbit: return "Rabbit";
    case vocabulary::Firmware::GrblHal: return "GrblHal";
    default: return "Unknown";
  }
}

inline constexpr double kStepsPerMm = 250;

/// 250 steps/mm, 5 m/min and 500 mm/s2 on three axes instead of what each factory thinks right.
inline firmware::StoredState quick_machine() {
  firmware::StoredState stored;
  stored.initialised = true;
  for (const std::string axis : {"0", "1", "2"}) {
    stored.settings["10" + axis] = "250.000";
    stored.settings["11" + axis] = "5000.000";
    stored.settings["12" + axis] = "500.000";
  }
  return stored;
}

inline WorldOptions quick_serial(vocabulary::Firmware firmware) {
  auto options = serial_world(firmware, 115200);
  options.stored = quick_machine();
  return options;
}

inline WorldOptions quick_network(vocabulary::Firmware firmware) {
  auto options = network_world(firmware, std::chrono::milliseconds{15});
  options.stored = quick_machine();
  return options;
}

inline std::shared_ptr<const job::Program> program(std::string text, std::string name = "part.nc") {
  return *job::Program::load(std::move(name), std::move(text));
}

/// There and back `times` times, `length_mm` each way, ending at X0 Y`times`.
inline std::string zigzag(int times, int length_mm = 40) {
  std::string text = "%\n(zigzag)\nG21 G90 G94\nM3 S1000\nG1 F3000\n";
  for (int row = 1; row <= times; ++row) {
    text += "G1 X" + std::to_string(row % 2 == 1 ? length_mm : 0) + "\nY" + std::to_string(row) + "\n";
  }
  return text + "G0 X0\nM5\nM30\n%\n";
}

/// Machine position of an axis, mm, of a quick machine.
inline double position_mm(const simulation::World& world, std::size_t axis) {
  return world.controller().position_steps()[axis] / kStepsPerMm;
}

template <class Kind>
std::vector<Kind> told(const simulation::World& world) {
  std::vector<Kind> found;
  for (const auto& event : world.events()) {
    if (const auto* kind = std::get_if<Kind>(&event)) found.push_back(*kind);
  }
  return found;
}

inline std::size_t lines_sent(const simulation::World& world, streaming::Purpose purpose) {
  const auto sent = told<session::LineSent>(world);
  return static_cast<std::size_t>(
      std::ranges::count_if(sent, [purpose](const auto& line) { return line.purpose == purpose; }));
}

inline bool is_ready(const simulation::World& world) {
  return world.session().phase() == session::SessionPhase::Ready;
}

inline bool is_over(const simulation::World& world) {
  return world.session().job() && job::is_final(world.session().job()->phase);
}

/// Opens the link and waits until the machine is known.
inline bool connect(simulation::World& world) {
  world.open();
  return world.run_until(is_ready, std::chrono::seconds{60});
}

/// Connects, starts a program and lets it run for `time`.
inline bool start(simulation::World& world, std::string text, Duration time) {
  if (!connect(world)) return false;
  world.submit(session::StartJob{program(std::move(text))});
  world.run_for(time);
  return world.session().job().has_value();
}

}  // namespace kerf::scenarios
