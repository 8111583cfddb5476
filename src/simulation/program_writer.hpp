#pragma once
// Writes G-code for places in one fixed frame, whatever units, distance mode and offsets are in force.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "simulation/milling_job.hpp"
#include "simulation/stock.hpp"

namespace kerf::simulation {

/// Axes that a motion names; the others stay.
struct Target {
  std::optional<double> x{};
  std::optional<double> y{};
  std::optional<double> z{};
};

/// All places are mm from the zero of G54, whatever the program is told. Numbers are rounded as they are written, and
/// what was written is where the tool is.
class ProgramWriter {
 public:
  /// A line without motion words.
  void say(std::string_view line);
  void rapid(const Target& to) { move("G0", to, std::nullopt); }
  void feed(const Target& to, double mm_per_min) { move("G1", to, mm_per_min); }
  /// In the XY plane; `radius_form` only for less than half a turn.
  void arc(bool clockwise, const Target& to, double center_x, double center_y, double mm_per_min, bool radius_form);
  /// A groove along X (G18) or Y (G19) to `to`, deepest in the middle: part of a circle whose centre is `height` above.
  void groove(std::size_t axis, double to, double height, double mm_per_min);
  /// G81 or G83 at the present place; ends with the tool at `clear_z`.
  void drill(double bottom_z, double clear_z, double mm_per_min, std::optional<double> peck);
  /// The next hole of the cycle.
  void drill_next(double x, double y);
  void end_drilling() { say("G80"), motion_.clear(); }

  void use_inches(bool inches);
  void use_increments(bool increments);
  /// G54 or G55.
  void use_second_zero(bool second);
  /// G10 L20: the present place gets this name in G55.
  void move_second_zero(double x, double y);
  /// G92: calls the present place by another name.
  void shift_zero(double x, double y);
  void end_shift();

  [[nodiscard]] const Point& at() const { return at_; }
  [[nodiscard]] bool increments() const { return increments_; }
  [[nodiscard]] bool second_zero() const { return second_zero_; }
  [[nodiscard]] bool is_shifted() const { return shift_[0] != 0 || shift_[1] != 0; }
  [[nodiscard]] std::size_t lines() const { return lines_; }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void move(std::string_view motion, const Target& to, std::optional<double> mm_per_min);
  void add_motion(std::string& line, std::string_view motion);
  void add_axes(std::string& line, const Target& to);
  /// The number to write for `mm` that need no zero.
  double add_length(std::string& line, char letter, double mm);
  void add_axis(std::string& line, std::size_t axis, double mm);
  void add_feed(std::string& line, double mm_per_min);
  [[nodiscard]] double zero_of(std::size_t axis) const;
  [[nodiscard]] static double& part_of(Point& point, std::size_t axis);

  std::string text_;
  std::size_t lines_ = 0;
  Point at_{};
  bool inches_ = false;
  bool increments_ = false;
  bool second_zero_ = false;
  /// Of G55, from that of G54.
  std::array<double, 3> second_{kSecondZeroMm[0], kSecondZeroMm[1], kSecondZeroMm[2]};
  std::array<double, 3> shift_{};
  /// Modal; empty when the next motion must name it.
  std::string motion_;
  std::optional<double> feed_;
};

}  // namespace kerf::simulation
