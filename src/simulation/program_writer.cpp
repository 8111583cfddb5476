#include "simulation/program_writer.hpp"

#include <cmath>

#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

constexpr double kMmPerInch = 25.4;
constexpr std::array kLetters{'X', 'Y', 'Z'};

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

}  // namespace

double& ProgramWriter::part_of(Point& point, std::size_t axis) {
  return axis == 0 ? point.x : axis == 1 ? point.y : point.z;
}

double ProgramWriter::zero_of(std::size_t axis) const {
  return (second_zero_ ? second_.at(axis) : 0.0) + shift_[axis];
}

void ProgramWriter::say(std::string_view line) {
  text_ += line;
  text_ += '\n';
  ++lines_;
}

double ProgramWriter::add_length(std::string& line, char letter, double mm) {
  const double unit = inches_ ? kMmPerInch : 1.0;
  const int decimals = inches_ ? 5 : 3;
  const double value = rounded(mm / unit, decimals);
  line += letter;
  line += base::to_fixed(value, decimals);
  return value * unit;
}

void ProgramWriter::add_axis(std::string& line, std::size_t axis, double mm) {
  double& at = part_of(at_, axis);
  const double from = increments_ ? at : zero_of(axis);
  at = from + add_length(line, kLetters[axis], mm - from);
}

void ProgramWriter::add_axes(std::string& line, const Target& to) {
  if (to.x) add_axis(line, 0, *to.x);
  if (to.y) add_axis(line, 1, *to.y);
  if (to.z) add_axis(line, 2, *to.z);
}

void ProgramWriter::add_feed(std::string& line, double mm_per_min) {
  if (feed_ == mm_per_min) return;
  feed_ = mm_per_min;
  line += 'F';
  line += base::to_fixed(inches_ ? mm_per_min / kMmPerInch : mm_per_min, inches_ ? 2 : 0);
}

void ProgramWriter::add_motion(std::string& line, std::string_view motion) {
  if (motion_ == motion) return;
  motion_ = motion;
  line += motion;
}

void ProgramWriter::move(std::string_view motion, const Target& to, std::optional<double> mm_per_min) {
  std::string line;
  add_motion(line, motion);
  add_axes(line, to);
  if (mm_per_min) add_feed(line, *mm_per_min);
  say(line);
}

void ProgramWriter::arc(bool clockwise, const Target& to, double center_x, double center_y, double mm_per_min,
                        bool radius_form) {
  std::string line;
  add_motion(line, clockwise ? "G2" : "G3");
  const Point from = at_;
  add_axes(line, to);
  if (radius_form) {
    static_cast<void>(add_length(line, 'R', std::hypot(center_x - from.x, center_y - from.y)));
  } else {
    static_cast<void>(add_length(line, 'I', center_x - from.x));
    static_cast<void>(add_length(line, 'J', center_y - from.y));
  }
  add_feed(line, mm_per_min);
  say(line);
}

void ProgramWriter::groove(std::size_t axis, double to, double height, double mm_per_min) {
  const Point from = at_;
  const double way = to - part_of(at_, axis);
  // Seen along the third axis, through the lowest point: the two planes look from opposite sides.
  const bool clockwise = (way > 0) == (axis == 0);
  std::string line = axis == 0 ? "G18" : "G19";
  motion_.clear();
  add_motion(line, clockwise ? "G2" : "G3");
  add_axes(line, axis == 0 ? Target{.x = to, .z = from.z} : Target{.y = to, .z = from.z});
  static_cast<void>(add_length(line, axis == 0 ? 'I' : 'J', way / 2));
  static_cast<void>(add_length(line, 'K', height));
  add_feed(line, mm_per_min);
  say(line);
  say("G17");
}

void ProgramWriter::move_second_zero(double x, double y) {
  const double unit = inches_ ? kMmPerInch : 1.0;
  const double named_x = rounded(x / unit, 3);
  const double named_y = rounded(y / unit, 3);
  second_[0] = at_.x - named_x * unit - shift_[0];
  second_[1] = at_.y - named_y * unit - shift_[1];
  say("G10L20P2X" + base::to_fixed(named_x, 3) + "Y" + base::to_fixed(named_y, 3));
}

void ProgramWriter::drill(double bottom_z, double clear_z, double mm_per_min, std::optional<double> peck) {
  std::string line = peck ? "G99G83" : "G98G81";
  static_cast<void>(add_length(line, 'X', at_.x - zero_of(0)));
  static_cast<void>(add_length(line, 'Y', at_.y - zero_of(1)));
  static_cast<void>(add_length(line, 'Z', bottom_z - zero_of(2)));
  static_cast<void>(add_length(line, 'R', clear_z - zero_of(2)));
  if (peck) static_cast<void>(add_length(line, 'Q', *peck));
  add_feed(line, mm_per_min);
  say(line);
  if (peck) at_.z = clear_z;
}

void ProgramWriter::drill_next(double x, double y) {
  std::string line;
  add_axes(line, {.x = x, .y = y});
  say(line);
}

void ProgramWriter::use_inches(bool inches) {
  if (inches == inches_) return;
  inches_ = inches;
  feed_.reset();
  say(inches ? "G20" : "G21");
}

void ProgramWriter::use_increments(bool increments) {
  if (increments == increments_) return;
  increments_ = increments;
  say(increments ? "G91" : "G90");
}

void ProgramWriter::use_second_zero(bool second) {
  if (second == second_zero_) return;
  second_zero_ = second;
  say(second ? "G55" : "G54");
}

void ProgramWriter::shift_zero(double x, double y) {
  const double unit = inches_ ? kMmPerInch : 1.0;
  const double base_x = second_zero_ ? second_[0] : 0.0;
  const double base_y = second_zero_ ? second_[1] : 0.0;
  const double named_x = rounded(x / unit, 3);
  const double named_y = rounded(y / unit, 3);
  shift_ = {at_.x - base_x - named_x * unit, at_.y - base_y - named_y * unit, 0.0};
  say("G92X" + base::to_fixed(named_x, 3) + "Y" + base::to_fixed(named_y, 3));
}

void ProgramWriter::end_shift() {
  shift_ = {};
  say("G92.1");
}

}  // namespace kerf::simulation
