#include "rehearsal/check_rules.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "common/protocol/secrets.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::rehearsal {
namespace {

constexpr std::size_t kMostTools = 256;
/// Of a remembered line no more is ever shown.
constexpr std::size_t kRememberedText = 160;

bool is_motion(const gcode::Action& action) {
  return std::holds_alternative<gcode::LinearMove>(action) || std::holds_alternative<gcode::ArcMove>(action) ||
         std::holds_alternative<gcode::ProbeMove>(action);
}

bool has_motion(Actions actions) {
  return std::ranges::any_of(actions, is_motion);
}

std::string_view name_of(gcode::Plane plane) {
  switch (plane) {
    case gcode::Plane::XY: return "XY (G17)";
    case gcode::Plane::ZX: return "ZX (G18)";
    case gcode::Plane::YZ: break;
  }
  return "YZ (G19)";
}

}  // namespace

RememberedLine::RememberedLine(const CheckedLine& line)
    : number(line.number), text(line.text.substr(0, kRememberedText)) {}

void StartupRule::begin(Findings& findings) const {
  for (const std::string& line : machine_.startup_lines) {
    const std::string deed = machine::deed_of_startup_line(line);
    if (deed.empty()) continue;
    const std::string shown = protocol::Secrets{}.hidden(line);
    findings.add(FindingKind::StartupLine, 0, shown, [&] { return "The startup line '" + shown + "' " + deed + "."; });
  }
}

FeedRule::FeedRule(const CheckMachine& machine) : machine_(machine) {
  const AxisValues& rates = machine.motion.max_rate_mm_per_min;
  slowest_axis_mm_per_min_ = *std::min_element(rates.begin(), rates.begin() + machine.motion.axes);
}

float FeedRule::limit_of(const CheckedMove& move) const {
  const AxisValues& rates = machine_.motion.max_rate_mm_per_min;
  if (move.arc != nullptr) {
    const auto axes = gcode::axes_of(move.arc->plane);
    return std::min(rates.at(axes.first), rates.at(axes.second));
  }
  float square = 0;
  for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
    square += (move.to_mm[axis] - move.from_mm[axis]) * (move.to_mm[axis] - move.from_mm[axis]);
  }
  const float length = std::sqrt(square);
  float limit = std::numeric_limits<float>::max();
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(machine_.motion.axes); ++axis) {
    const float way = std::abs(move.to_mm.at(axis) - move.from_mm.at(axis));
    if (way > 0 && rates.at(axis) > 0) limit = std::min(limit, rates.at(axis) * length / way);
  }
  return limit;
}

void FeedRule::on_move(const CheckedMove& move, Findings& findings) const {
  const gcode::Feed& feed = move.feed;
  if (feed.rapid || feed.rate_mm_per_min <= slowest_axis_mm_per_min_) return;
  if (feed.inverse_time || feed.per_revolution || feed.synchronized) return;
  constexpr float kRounding = 1.0001F;
  const float limit = limit_of(move);
  if (feed.rate_mm_per_min <= limit * kRounding) return;
  findings.add(FindingKind::FeedTooHigh, move.line.number, move.line.text, [&] {
    return "F " + short_mm(feed.rate_mm_per_min) + " mm/min; the machine goes " + short_mm(std::floor(limit)) +
           " in this direction ($110 and following).";
  });
}

void ModeRule::on_line(const CheckedLine& line, Actions actions, Findings& findings) {
  const WordsSeen& words = line.words;
  const bool mixes = (words.inches && said_millimetres_) || (words.millimetres && said_inches_);
  if (mixes && line.before.inches != line.after.modal.inches) {
    findings.add(FindingKind::UnitsMixed, line.number, line.text, [&] {
      return std::string{"From here on the program is in "} + (words.inches ? "inches" : "millimetres") +
             "; before it was in " + (words.inches ? "millimetres." : "inches.");
    });
  }
  said_inches_ = said_inches_ || words.inches;
  said_millimetres_ = said_millimetres_ || words.millimetres;
  if (said_inches_ || said_millimetres_ || !has_motion(actions) || findings.has(FindingKind::UnitsUnsaid)) return;
  findings.add(FindingKind::UnitsUnsaid, line.number, line.text, [&] {
    return std::string{"The first move is read in "} + (line.after.modal.inches ? "inches" : "millimetres") + ".";
  });
}

void ModeRule::on_move(const CheckedMove& move, Findings& findings) {
  if (move.arc == nullptr) return;
  const auto before = std::exchange(plane_of_arcs_, move.arc->plane);
  if (!before || *before == move.arc->plane) return;
  findings.add(FindingKind::PlanesMixed, move.line.number, move.line.text, [&] {
    return "This arc lies in " + std::string{name_of(move.arc->plane)} + ", the one before in " +
           std::string{name_of(*before)} + ".";
  });
}

void PlaceRule::on_line(const CheckedLine& line, Actions actions, Findings& findings) const {
  if (machine_.is_homed || !line.words.machine_place || !has_motion(actions)) return;
  findings.add(FindingKind::UnhomedPosition, line.number, line.text,
               [] { return "It goes to a place in machine coordinates, and the machine is not homed."; });
}

void ProbeRule::on_move(const CheckedMove& move, Findings& findings) const {
  if (move.kind != MoveKind::Probe || machine_.has_probe) return;
  findings.add(FindingKind::Probing, move.line.number, move.line.text,
               [] { return "This move ends where the probe touches."; });
}

void StopRule::on_tool_change(const CheckedLine& line, std::optional<int> tool, Findings& findings) {
  changes_tools_ = true;
  const bool is_ignored = machine_.reader.settings().ignore_tool_change;
  findings.add(FindingKind::ToolChange, line.number, line.text, [&] {
    const std::string name = tool ? "Tool " + std::to_string(*tool) : "The next tool";
    return name + (is_ignored ? " is asked for, and this machine is set to overlook that ($341=4)." : " goes in here.");
  });
}

void StopRule::on_line(const CheckedLine& line, Actions actions, Findings& findings) {
  for (const gcode::Action& action : actions) {
    const auto* const pause = std::get_if<gcode::ProgramPause>(&action);
    if (pause == nullptr) continue;
    findings.add(FindingKind::Stop, line.number, line.text, [&] {
      return pause->optional ? "An optional stop: only where the machine has them switched on."
                             : "A stop of the program's own.";
    });
  }
  if (!line.words.has('T')) return;
  const auto tool = job::flow_words_of(line.wire).tool;
  if (!tool) return;
  const bool is_other = tool_ && *tool_ != *tool;
  tool_ = tool;
  if (std::ranges::find(tools_, *tool) == tools_.end() && tools_.size() < kMostTools) tools_.push_back(*tool);
  if (is_other && !changes_tools_ && named_.size() < kMostTools) {
    named_.push_back({.line = RememberedLine(line), .tool = *tool});
  }
}

void StopRule::at_end(Findings& findings) {
  if (changes_tools_) return;
  for (const NamedTool& named : named_) {
    findings.add(FindingKind::ToolUsed, named.line.number, named.line.text,
                 [&] { return "Tool " + std::to_string(named.tool) + " is named here."; });
  }
}

}  // namespace kerf::rehearsal
