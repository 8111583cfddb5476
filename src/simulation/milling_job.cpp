#include "simulation/milling_job.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/program_writer.hpp"

namespace kerf::simulation {
namespace {

constexpr double kSafeZ = 5;
constexpr double kSizeMm = 40;

/// Depths of the passes, downwards.
std::vector<double> passes(Dice& dice) {
  const double step = dice.pick({0.5, 1.0, 1.5});
  std::vector<double> depths;
  for (int pass = 1; pass <= dice.between(1, 3); ++pass) depths.push_back(-step * pass);
  return depths;
}

class MillingJob {
 public:
  MillingJob(Dice& dice, const MillingFeatures& features) : dice_(dice), features_(features) {}

  std::string write(std::size_t lines) {
    begin();
    do {
      operation();
      if (out_.lines() < lines) between_operations();
    } while (out_.lines() < lines);
    end();
    return out_.take();
  }

 private:
  void begin() {
    if (dice_.one_in(2)) out_.say("%");
    out_.say("(made up by chance)");
    out_.say("G21 G90 G94 G17 G54");
    if (features_.tool_changes && dice_.one_in(2)) out_.say("T1 M6");
    start_spindle();
    up();
    // Increments count from here.
    out_.rapid({.x = 0, .y = 0});
  }

  void start_spindle() {
    out_.say(dice_.pick({"M3 S10000", "M3S8000", "S12000 M3", "M4 S9000"}));
    if (dice_.one_in(3)) out_.say("G4 P0.2");
    if (dice_.one_in(3)) out_.say("M8");
  }

  void end() {
    up();
    if (out_.is_shifted() && dice_.one_in(2)) out_.end_shift();
    if (dice_.one_in(2)) out_.say("M9");
    if (dice_.one_in(2)) out_.say("M5");
    out_.say(dice_.pick({"M30", "M2", "M30\n%"}));
  }

  void up() { out_.rapid({.z = kSafeZ + dice_.between(0, 2)}); }

  void between_operations() {
    up();
    switch (dice_.below(10)) {
      case 0: out_.use_inches(dice_.one_in(2)); break;
      case 1: out_.use_second_zero(!out_.second_zero()); break;
      case 2:
        if (out_.is_shifted()) {
          out_.end_shift();
        } else {
          out_.shift_zero(dice_.between(-9, 9), dice_.between(-9, 9));
        }
        break;
      case 3:
        if (features_.program_pauses) out_.say("M0");
        break;
      case 4:
        if (features_.tool_changes) change_tool();
        break;
      case 6: out_.move_second_zero(dice_.between(-9, 9), dice_.between(-9, 9)); break;
      case 5: out_.say(dice_.pick({"G4P0.3", "M8", "M9", "S11000", "(a comment; with words)", ""})); break;
      default: break;
    }
  }

  void change_tool() {
    out_.say("M5");
    out_.say("T" + std::to_string(dice_.between(2, 5)) + " M6");
    start_spindle();
  }

  void operation() {
    cut_ = dice_.between(6, 24) * 100;
    plunge_ = dice_.between(2, 6) * 100;
    out_.use_increments(dice_.one_in(3));
    switch (dice_.below(features_.canned_cycles ? 6 : 5)) {
      case 0: face(); break;
      case 1: pocket(); break;
      case 2: round_contour(); break;
      case 3: rounded_rectangle(); break;
      case 4: engrave_peck_or_groove(); break;
      default: canned_holes(); break;
    }
    out_.use_increments(false);
  }

  /// Rapid to a place, then down to `z`: fed, or the first part of it as a rapid.
  void enter(double x, double y, double z) {
    out_.rapid({.x = x, .y = y});
    if (dice_.one_in(2)) out_.rapid({.z = 0.5});
    out_.feed({.z = z}, plunge_);
  }

  void face() {
    const double x = dice_.between(0, 10);
    const double y = dice_.between(0, 15);
    const double width = dice_.between(10, 28);
    const double step = dice_.pick({1.5, 2.0, 3.0});
    const int rows = dice_.between(2, 8);
    const bool turns = dice_.one_in(2);
    enter(x, y, -dice_.pick({0.5, 0.8, 1.2}));
    for (int row = 0; row < rows; ++row) {
      const double end_x = row % 2 == 0 ? x + width : x;
      out_.feed({.x = end_x}, cut_);
      if (row + 1 == rows) return;
      const double here = out_.at().y;
      if (turns) {
        out_.arc(row % 2 == 1, {.x = end_x, .y = here + step}, out_.at().x, here + step / 2, cut_, false);
      } else {
        out_.feed({.y = here + step}, cut_);
      }
    }
  }

  void pocket() {
    const double x = dice_.between(10, 28);
    const double y = dice_.between(10, 28);
    const int rings = dice_.between(1, 4);
    double above = 0;
    for (const double depth : passes(dice_)) {
      out_.rapid({.x = x, .y = y});
      // Where the pass before has been, a rapid may go.
      if (above < 0) out_.rapid({.z = above + 0.2});
      out_.feed({.z = depth}, plunge_);
      for (int ring = 1; ring <= rings; ++ring) {
        const double reach = 2.0 * ring;
        out_.feed({.x = x + reach, .y = y + reach}, cut_);
        out_.feed({.x = x - reach}, cut_);
        out_.feed({.y = y - reach}, cut_);
        out_.feed({.x = x + reach}, cut_);
        out_.feed({.y = y + reach}, cut_);
      }
      out_.rapid({.z = kSafeZ});
      above = depth;
    }
  }

  void round_contour() {
    const double radius = dice_.within(2, 8);
    const double x = dice_.within(10, 30);
    const double y = dice_.within(10, 30);
    const bool clockwise = dice_.one_in(2);
    out_.rapid({.x = x + radius, .y = y});
    const double center_x = out_.at().x - radius;
    const double center_y = out_.at().y;
    const double start_x = out_.at().x;
    out_.feed({.z = 0.2}, plunge_);
    for (const double depth : passes(dice_)) {
      if (dice_.one_in(2)) {
        // A ramp along the whole circle, and once round on the ground.
        out_.arc(clockwise, {.x = start_x, .y = center_y, .z = depth}, center_x, center_y, cut_, false);
      } else {
        out_.feed({.z = depth}, plunge_);
      }
      out_.arc(clockwise, {.x = start_x, .y = center_y}, center_x, center_y, cut_, false);
    }
  }

  void rounded_rectangle() {
    const double x = dice_.between(3, 15);
    const double y = dice_.between(3, 15);
    const double width = dice_.between(10, 20);
    const double height = dice_.between(10, 20);
    const double r = dice_.pick({1.0, 2.0, 3.5});
    enter(x + r, y, -0.4);
    for (const double depth : passes(dice_)) {
      out_.feed({.z = depth}, plunge_);
      out_.feed({.x = x + width - r, .y = y}, cut_);
      corner(x + width, y + r, x + width - r, y + r);
      out_.feed({.y = y + height - r}, cut_);
      corner(x + width - r, y + height, x + width - r, y + height - r);
      out_.feed({.x = x + r}, cut_);
      corner(x, y + height - r, x + r, y + height - r);
      out_.feed({.y = y + r}, cut_);
      corner(x + r, y, x + r, y + r);
    }
  }

  void corner(double x, double y, double center_x, double center_y) {
    out_.arc(false, {.x = x, .y = y}, center_x, center_y, cut_, dice_.one_in(2));
  }

  void engrave() {
    enter(dice_.within(0, kSizeMm), dice_.within(0, kSizeMm), -0.5);
    for (int point = dice_.between(3, 25); point > 0; --point) {
      const Point& at = out_.at();
      const double x = std::clamp(at.x + dice_.within(-8, 8), 0.0, kSizeMm);
      const double y = std::clamp(at.y + dice_.within(-8, 8), 0.0, kSizeMm);
      out_.feed(dice_.one_in(3) ? Target{.x = x, .y = y, .z = dice_.within(-1.5, -0.3)} : Target{.x = x, .y = y}, cut_);
    }
  }

  void engrave_peck_or_groove() {
    switch (dice_.below(3)) {
      case 0: engrave(); break;
      case 1: peck(); break;
      default: grooves(); break;
    }
  }

  /// Arcs that stand upright.
  void grooves() {
    const std::size_t axis = dice_.one_in(2) ? 0 : 1;
    enter(dice_.between(4, 20), dice_.between(4, 20), -0.2);
    double from = axis == 0 ? out_.at().x : out_.at().y;
    for (int groove = dice_.between(1, 4); groove > 0; --groove) {
      const double to = from + dice_.between(6, 12);
      out_.groove(axis, to, dice_.between(9, 15), cut_);
      out_.groove(axis, from, dice_.between(9, 15), cut_);
      from += 1;
      out_.feed(axis == 0 ? Target{.x = from} : Target{.y = from}, cut_);
    }
  }

  void peck() {
    for (int hole = dice_.between(1, 5); hole > 0; --hole) {
      out_.rapid({.x = dice_.within(0, kSizeMm), .y = dice_.within(0, kSizeMm)});
      out_.rapid({.z = 1});
      double bottom = 0;
      for (int pecks = dice_.between(1, 3); pecks > 0; --pecks) {
        if (bottom < 0) out_.rapid({.z = bottom + 0.1});
        bottom -= 1;
        out_.feed({.z = bottom}, plunge_);
        out_.rapid({.z = 1});
      }
      out_.rapid({.z = kSafeZ});
    }
  }

  void canned_holes() {
    out_.use_increments(false);
    out_.rapid({.x = dice_.within(0, kSizeMm), .y = dice_.within(0, kSizeMm)});
    out_.drill(-dice_.within(1, 5), 2, plunge_, dice_.one_in(2) ? std::optional{1.0} : std::nullopt);
    for (int hole = dice_.between(0, 4); hole > 0; --hole) {
      out_.drill_next(dice_.within(0, kSizeMm), dice_.within(0, kSizeMm));
    }
    out_.end_drilling();
    up();
  }

  Dice& dice_;
  MillingFeatures features_;
  ProgramWriter out_;
  double cut_ = 1000;
  double plunge_ = 300;
};

}  // namespace

MillingFeatures features_of(vocabulary::Firmware firmware) {
  const bool cycles_and_tools = firmware == vocabulary::Firmware::GrblHal;
  return {.canned_cycles = cycles_and_tools, .tool_changes = cycles_and_tools};
}

std::string milling_job(Dice& dice, const MillingFeatures& features, std::size_t lines) {
  return MillingJob{dice, features}.write(lines);
}

}  // namespace kerf::simulation
