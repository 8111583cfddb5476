// The rules about spindle and laser.

#include <algorithm>
#include <variant>

#include "rehearsal/check_rules.hpp"

namespace kerf::rehearsal {
namespace {

using gcode::SpindleDirection;

bool is_fed_motion(const gcode::Action& action) {
  if (const auto* line = std::get_if<gcode::LinearMove>(&action)) return !line->feed.rapid;
  return std::holds_alternative<gcode::ArcMove>(action);
}

const gcode::SpindleChange* start_in(Actions actions) {
  for (const gcode::Action& action : actions) {
    const auto* const change = std::get_if<gcode::SpindleChange>(&action);
    if (change != nullptr && change->direction != SpindleDirection::Off) return change;
  }
  return nullptr;
}

}  // namespace

SpindleRule::SpindleRule(const CheckMachine& machine)
    : machine_(machine),
      has_speed_(machine.reader.state().spindle_rpm > 0),
      was_on_(machine.reader.state().modal.spindle != SpindleDirection::Off) {}

void SpindleRule::on_line(const CheckedLine& line, Actions actions, Findings& findings) {
  if (line.words.has('S')) {
    has_speed_ = true;
    const float rpm = line.after.spindle_rpm;
    const float most = machine_.spindle_rpm_max;
    const bool is_out =
        rpm > 0 && most > 0 && !line.after.modal.surface_speed && (rpm > most || rpm < machine_.spindle_rpm_min);
    if (is_out) {
      findings.add(FindingKind::SpeedOutOfRange, line.number, line.text, [&] {
        return "S " + short_mm(rpm) +
               (rpm > most
                    ? " is more than the highest speed of this spindle ($30=" + short_mm(most)
                    : " is less than the lowest speed of this spindle ($31=" + short_mm(machine_.spindle_rpm_min)) +
               ").";
      });
    }
  }
  if (start_in(actions) == nullptr) return;
  was_on_ = true;
  if (!has_speed_ && !start_without_speed_ && !machine_.is_laser) {
    start_without_speed_ = RememberedLine(line);
  }
}

void SpindleRule::on_move(const CheckedMove& move, Findings& findings) {
  if (move.feed.rapid || move.kind == MoveKind::Probe) return;
  const bool cuts = move.kind == MoveKind::Cut || move.kind == MoveKind::Plunge;
  has_cut_ = has_cut_ || cuts;
  if (!first_feed_ && !was_on_ && move.goes_sideways()) first_feed_ = RememberedLine(move.line);
  if (start_without_speed_ && !has_speed_ && (cuts || move.goes_sideways())) {
    findings.add(FindingKind::SpeedMissing, start_without_speed_->number, start_without_speed_->text,
                 [] { return "The spindle starts here, and cuts before any speed was given."; });
    has_speed_ = true;
  }
  if (!cuts || move.feed.spindle != SpindleDirection::Off) return;
  findings.add(FindingKind::SpindleOff, move.line.number, move.line.text, [&] {
    return was_on_ ? "The spindle was stopped before this cut."
                   : "The program has not started the spindle before this cut.";
  });
}

void SpindleRule::at_end(Findings& findings) const {
  if (has_cut_ || was_on_ || !first_feed_) return;
  findings.add(FindingKind::SpindleOff, first_feed_->number, first_feed_->text,
               [] { return "The program never starts a spindle or a laser."; });
}

LaserRule::LaserRule(const CheckMachine& machine) : is_on_(!machine.is_laser) {}

void LaserRule::on_line(const CheckedLine& line, Actions actions, Findings& findings) {
  if (!is_on_) return;
  if (const auto* start = start_in(actions);
      start != nullptr && start->direction == SpindleDirection::Counterclockwise) {
    if (!dynamic_power_) dynamic_power_ = RememberedLine(line);
  }
  const bool has_power = line.words.has('S') && line.after.modal.spindle != SpindleDirection::Off &&
                         start_in(actions) == nullptr && std::ranges::any_of(actions, is_fed_motion);
  if (!has_power) return;
  const auto say = [] { return "It changes the power in mid-motion (S in a line with G1)."; };
  // A spindle may be told another speed on the way, once.
  if (!first_power_) {
    first_power_ = RememberedLine(line);
    if (!dynamic_power_) return;
    findings.add(FindingKind::LaserModeOff, first_power_->number, first_power_->text, say);
    return;
  }
  if (!findings.has(FindingKind::LaserModeOff)) {
    findings.add(FindingKind::LaserModeOff, first_power_->number, first_power_->text, say);
  }
  findings.add(FindingKind::LaserModeOff, line.number, line.text, say);
}

void LaserRule::on_move(const CheckedMove& move, Findings&) {
  has_depth_ = has_depth_ || move.to_mm[kZ] != move.from_mm[kZ];
}

void LaserRule::at_end(Findings& findings) const {
  if (!is_on_ || has_depth_ || !dynamic_power_ || findings.has(FindingKind::LaserModeOff)) return;
  findings.add(FindingKind::LaserModeOff, dynamic_power_->number, dynamic_power_->text,
               [] { return "M4 without any depth is a laser whose power follows the speed."; });
}

}  // namespace kerf::rehearsal
