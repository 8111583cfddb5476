#include "simulation/varied_job.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

using vocabulary::Firmware;

constexpr double kReachMm = 25.0;
constexpr int kDecimals = 3;

std::string word(char letter, double value) {
  return letter + base::to_fixed(value, kDecimals);
}

class Writer {
 public:
  Writer(Dice& dice, Firmware firmware) : dice_(dice), firmware_(firmware) {}

  void header() { say("G21 G90 G94 G17 G54"); }
  [[nodiscard]] std::string take() { return std::move(text_); }
  [[nodiscard]] bool is_grblhal() const { return firmware_ == Firmware::GrblHal; }

  void raster();
  void tiny_segments();
  void arcs();
  void inches();
  void increments();
  void inverse_time();
  void shifted_zero();
  void second_offset();
  void stored_places();
  void tool_length();
  void spindle_and_coolant();
  void dwell() { say("G4 P" + base::to_fixed(dice_.within(0.05, 1.5), 2)); }
  void pause() { say("M0"); }
  void tool_change();
  void probe();
  void canned_cycles();
  void splines();
  void scaling();

 private:
  void say(const std::string& line) { text_ += line + '\n'; }
  [[nodiscard]] double place() { return dice_.within(-kReachMm, kReachMm); }
  [[nodiscard]] double depth() { return dice_.within(-4.0, 6.0); }
  [[nodiscard]] std::string feed() { return word('F', dice_.within(200.0, 2500.0)); }
  void go(double x, double y) { say("G0 " + word('X', x) + word('Y', y)); }
  void circle(char plane, double radius);

  Dice& dice_;
  Firmware firmware_;
  std::string text_;
  int tool_ = 1;
};

void Writer::raster() {
  const double step = dice_.within(0.1, 3.0);
  const double width = dice_.within(5.0, 2 * kReachMm);
  go(-kReachMm, -kReachMm);
  say("G1 " + word('Z', depth()) + feed());
  const int rows = dice_.between(3, 25);
  for (int row = 0; row < rows; ++row) {
    say(word('X', row % 2 == 0 ? width - kReachMm : -kReachMm) + (dice_.one_in(6) ? feed() : ""));
    say(word('Y', -kReachMm + step * (row + 1) * (step * rows > 2 * kReachMm ? 0.3 : 1.0)));
  }
  say("G0 Z6");
}

void Writer::tiny_segments() {
  const double radius = dice_.within(3.0, 20.0);
  const double size = dice_.within(0.03, 0.4);
  go(radius, 0);
  say("G1 " + feed());
  double angle = 0;
  const int count = dice_.between(50, 400);
  for (int i = 0; i < count; ++i) {
    angle += size / radius;
    const double r = radius + std::sin(angle * 7.0);
    say(word('X', r * std::cos(angle)) + word('Y', r * std::sin(angle)) + word('Z', std::sin(angle * 3.0)));
  }
}

void Writer::circle(char plane, double radius) {
  const bool helix = dice_.one_in(3);
  const std::string turn = dice_.one_in(2) ? "G91 G2 " : "G91 G3 ";
  const double climb = dice_.within(-3.0, 3.0);
  switch (plane) {
    case 'X':
      say("G17");
      say(turn + "X0 Y0 " + word('I', radius) + "J0" + (helix ? word('Z', climb) : "") + feed());
      break;
    case 'Z':
      say("G18");
      say(turn + "X0 Z0 " + word('I', radius) + "K0" + (helix ? word('Y', climb) : "") + feed());
      break;
    default:
      say("G19");
      say(turn + "Y0 Z0 " + word('J', radius) + "K0" + (helix ? word('X', climb) : "") + feed());
      break;
  }
}

void Writer::arcs() {
  const int count = dice_.between(3, 20);
  for (int i = 0; i < count; ++i) {
    const double radius = dice_.within(0.5, 10.0);
    go(place() / 2, place() / 2);
    say("G0 " + word('Z', depth()));
    const char plane = dice_.pick({'X', 'Z', 'Y'});
    if (dice_.one_in(3)) {
      circle(plane, radius);
    } else {
      const double chord = radius * dice_.within(0.2, 1.9);
      const double along = chord * std::numbers::sqrt2 / 2;
      const std::string turn = dice_.one_in(2) ? "G2 " : "G3 ";
      const std::array<char, 2> axes = plane == 'X'   ? std::array{'X', 'Y'}
                                       : plane == 'Z' ? std::array{'X', 'Z'}
                                                      : std::array{'Y', 'Z'};
      say(plane == 'X' ? "G17" : plane == 'Z' ? "G18" : "G19");
      say("G91 " + turn + word(axes[0], along) + word(axes[1], along) + word('R', dice_.one_in(3) ? -radius : radius) +
          feed());
    }
    say("G90 G17");
  }
  say("G0 Z6");
}

void Writer::inches() {
  constexpr double kInch = 25.4;
  say("G20");
  const int count = dice_.between(3, 15);
  for (int i = 0; i < count; ++i) {
    say((dice_.one_in(3) ? "G0 " : "G1 ") + word('X', place() / kInch) + word('Y', place() / kInch) +
        word('Z', depth() / kInch) + word('F', dice_.within(10.0, 90.0)));
  }
  say("G21");
}

void Writer::increments() {
  say("G91 G1 " + feed());
  const int pairs = dice_.between(2, 20);
  for (int i = 0; i < pairs; ++i) {
    const double x = dice_.within(-8.0, 8.0);
    const double y = dice_.within(-8.0, 8.0);
    say(word('X', x) + word('Y', y));
    say(word('X', -x) + word('Y', -y) + word('Z', dice_.one_in(2) ? 0.2 : -0.2));
  }
  say("G90");
}

void Writer::inverse_time() {
  say("G93");
  const int count = dice_.between(2, 12);
  for (int i = 0; i < count; ++i) {
    say("G1 " + word('X', place()) + word('Y', place()) + word('F', dice_.within(8.0, 60.0)));
    if (dice_.one_in(4)) {
      say("G91 G2 X0 Y0 " + word('I', dice_.within(1.0, 5.0)) + "J0" + word('F', dice_.within(8.0, 40.0)));
      say("G90");
    }
  }
  say("G94 " + feed());
}

void Writer::shifted_zero() {
  say("G92 " + word('X', place()) + word('Y', place()));
  say("G91 G1 X3 Y2 " + feed());
  say("G90");
  say("G91 X-3 Y-2");
  say("G90 G92.1");
  go(place(), place());
}

void Writer::second_offset() {
  say("G10 L2 P2 " + word('X', dice_.within(-5, 5)) + word('Y', dice_.within(-5, 5)) + word('Z', dice_.within(-1, 1)));
  say("G55");
  say("G0 " + word('X', place()) + word('Y', place()));
  say("G1 " + word('Z', depth()) + feed());
  if (dice_.one_in(2)) {
    say("G10 L20 P2 X0 Y0");
    say("G1 X4 Y-3");
    say("X0 Y0");
  }
  say("G54");
  say("G53 G0 Z0");
  say("G0 Z6");
  go(place(), place());
}

void Writer::stored_places() {
  go(place(), place());
  say("G28.1");
  go(place(), place());
  if (dice_.one_in(2)) say("G30.1");
  go(place(), place());
  say(dice_.one_in(2) ? "G28 Z6" : "G30 Z6");
  say("G0 Z6");
  go(place(), place());
}

void Writer::tool_length() {
  say("G43.1 " + word('Z', dice_.within(-2.0, 2.0)));
  say("G1 " + word('Z', depth()) + word('X', place()) + feed());
  say("G49");
  say("G0 Z6");
}

void Writer::spindle_and_coolant() {
  say(dice_.pick<std::string>({"M3 S1000", "M4 S800", "M3 S600", "S900 M3", "M5"}));
  if (dice_.one_in(2)) say(dice_.pick<std::string>({"M8", "M9", "M8"}));
  say("G1 " + word('X', place()) + word('Y', place()) + feed());
  if (dice_.one_in(2)) say(word('S', static_cast<double>(dice_.between(100, 1000))));
  say("G1 " + word('X', place()) + word('Y', place()));
}

void Writer::tool_change() {
  say("M5");
  say("T" + std::to_string(++tool_) + " M6");
  say("M3 S1000");
  go(place(), place());
  say("G0 Z6");
  say("G1 " + word('X', place()) + word('Z', depth()) + feed());
}

void Writer::probe() {
  go(place(), place());
  say("G0 Z1");
  say((dice_.one_in(2) ? "G38.2 " : "G38.3 ") + word('Z', -6.0) + word('F', dice_.within(60.0, 200.0)));
  const bool shifts = dice_.one_in(2);
  if (shifts) say("G92 Z0");
  go(place(), place());
  say("G91 G0 Z2");
  say("G90");
  go(place(), place());
  if (shifts) say("G92.1");
  say("G0 Z6");
}

void Writer::canned_cycles() {
  const std::string cycle = dice_.pick<std::string>({"G81 ", "G82 P0.1 ", "G83 Q0.7 ", "G73 Q0.6 "});
  say("G0 Z5");
  say(std::string{dice_.one_in(2) ? "G98 " : "G99 "} + cycle + word('X', place()) + word('Y', place()) +
      word('Z', dice_.within(-3.0, -1.0)) + "R1 " + feed());
  const int holes = dice_.between(1, 6);
  for (int i = 0; i < holes; ++i) say(word('X', place()) + word('Y', place()));
  if (dice_.one_in(2)) say("G91 X2 Y1 L2");
  say("G90 G80");
  say("G0 Z6");
}

void Writer::splines() {
  go(0, 0);
  say("G5 I0 J3 P0 Q-3 X1 Y1 " + feed());
  say("G5 I2 J2 P0 Q-3 X5 Y4");
  say("G1 X0 Y0");
}

void Writer::scaling() {
  say("G51 X" + base::to_fixed(dice_.within(0.3, 1.5), 2) + " Y" + base::to_fixed(dice_.within(0.3, 1.5), 2));
  const int count = dice_.between(1, 5);
  for (int i = 0; i < count; ++i) say("G1 " + word('X', place()) + word('Y', place()) + feed());
  say("G50");
  go(place(), place());
}

}  // namespace

std::string varied_job(Dice& dice, Firmware firmware, const VariedJobParts& parts, std::size_t sections) {
  using Section = void (Writer::*)();
  std::vector<Section> choice{&Writer::raster,       &Writer::tiny_segments, &Writer::arcs,
                              &Writer::inches,       &Writer::increments,    &Writer::inverse_time,
                              &Writer::shifted_zero, &Writer::second_offset, &Writer::stored_places,
                              &Writer::tool_length,  &Writer::dwell,         &Writer::spindle_and_coolant};
  Writer writer{dice, firmware};
  if (writer.is_grblhal()) choice.insert(choice.end(), {&Writer::canned_cycles, &Writer::splines, &Writer::scaling});
  if (parts.pauses) choice.push_back(&Writer::pause);
  if (parts.pauses && writer.is_grblhal()) choice.push_back(&Writer::tool_change);
  if (parts.probing) choice.push_back(&Writer::probe);
  writer.header();
  for (std::size_t section = 0; section < sections; ++section) {
    (writer.*choice[static_cast<std::size_t>(dice.below(choice.size()))])();
  }
  std::string text = writer.take();
  return text + "M5\nM9\nG0 Z6\nG0 X0 Y0\nM30\n";
}

}  // namespace kerf::simulation
