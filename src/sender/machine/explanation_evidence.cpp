#include "sender/machine/explanation_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/base/text.hpp"
#include "common/gcode/commands.hpp"
#include "common/gcode/rules.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/pins.hpp"
#include "common/vocabulary/travel.hpp"

namespace kerf::machine {
namespace {

using vocabulary::kAxisLetters;

// Settings as numbered on all three firmwares (protocol.md 7).
constexpr int kHardLimits = 21;
constexpr int kHoming = 22;
constexpr int kHomingDirection = 23;
constexpr int kHomingPullOff = 27;
constexpr int kMaxTravel = 130;
constexpr unsigned kOriginZeroBit = 3;

/// Less than this is a rounding of the report, not an excess.
constexpr double kTolerance = 0.0005;
constexpr double kNearEnd = 2.0;
constexpr std::size_t kZ = 2;

/// Rabbit tells where each switch is, by name only: `$X/Home/Mpos=0.000` (protocol.md 7).
double switch_at_mm(std::size_t axis, const Capabilities& capabilities) {
  const auto* const fact = capabilities.find_setting(std::string{vocabulary::kAxisLetters[axis]} + "/Home/Mpos");
  if (fact == nullptr || !fact->value) return 0;
  return base::parse_decimal(base::trim(*fact->value)).value_or(0);
}

double excess_of(double target, const vocabulary::Travel& travel) {
  if (target < static_cast<double>(travel.min_mm) - kTolerance) return target - static_cast<double>(travel.min_mm);
  if (target > static_cast<double>(travel.max_mm) + kTolerance) return target - static_cast<double>(travel.max_mm);
  return 0;
}

double value_at(const std::vector<double>& values, std::size_t axis) {
  return axis < values.size() ? values[axis] : 0;
}

/// Of Grbl's single number, which is for Z, or of grblHAL's one for each axis.
double tool_length_at(const Snapshot& snapshot, std::size_t axis) {
  if (!snapshot.tool_length.offset_mm) return 0;
  const auto& values = *snapshot.tool_length.offset_mm;
  if (values.size() == 1) return axis == kZ ? values.front() : 0;
  return value_at(values, axis);
}

/// The part of the offset without which the target would lie within the travel.
std::string reason_for(const Excess& excess, const Snapshot& snapshot) {
  const vocabulary::Travel travel{.min_mm = static_cast<float>(excess.travel_min_mm),
                                  .max_mm = static_cast<float>(excess.travel_max_mm)};
  const auto explains = [&](double part) {
    return std::abs(part) > kTolerance && excess_of(excess.target_mm - part, travel) == 0;
  };
  if (const double length = tool_length_at(snapshot, excess.axis); explains(length)) {
    return " because the tool length offset is " + short_number(length);
  }
  const auto offset = [&](const std::string& name) {
    const auto found = snapshot.offsets_mm.find(name);
    return found == snapshot.offsets_mm.end() ? 0.0 : value_at(found->second, excess.axis);
  };
  if (const double shift = offset("G92"); explains(shift)) return " because G92 shifts it by " + short_number(shift);
  const std::string system = snapshot.work_coordinate_system.value_or("");
  if (system.empty() || snapshot.offsets_mm.find(system) == snapshot.offsets_mm.end()) return "";
  const double zero = offset(system);
  const char letter = kAxisLetters[excess.axis];
  if (excess.travel_max_mm - excess.travel_min_mm < std::abs(excess.target_mm - zero)) {
    return std::string{": the program goes to "} + letter + short_number(excess.target_mm - zero) +
           ", which is more than the axis is long (" + short_number(excess.travel_max_mm - excess.travel_min_mm) +
           " mm)";
  }
  return std::string{" because the work zero ("} + system + ") is at " + letter + short_number(zero);
}

/// Reads the command letters of a line; comments and other words are passed over.
template <typename Visit>
void for_each_command(std::string_view line, const Visit& visit) {
  int depth = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char letter = base::to_upper(line[at]);
    if (letter == ';') return;
    if (letter == '(') ++depth;
    if (letter == ')') --depth;
    if (depth > 0 || (letter != 'G' && letter != 'M')) continue;
    std::size_t end = at + 1;
    while (end < line.size() && (base::is_digit(line[end]) || line[end] == '.')) ++end;
    if (end > at + 1) visit(letter, line.substr(at + 1, end - at - 1));
    at = end - 1;
  }
}

}  // namespace

std::optional<vocabulary::Travel> travel_of_axis(std::size_t axis, const Capabilities& capabilities,
                                                 const vocabulary::Dialect& dialect) {
  auto facts = travel_facts(axis, capabilities);
  if (!facts) return std::nullopt;
  if (!is_setting_on(capabilities, kHardLimits)) facts->pull_off_mm = 0;
  return travel_of(vocabulary::travel_rule_of(dialect.firmware), *facts);
}

std::optional<vocabulary::TravelFacts> travel_facts(std::size_t axis, const Capabilities& capabilities) {
  const auto length = setting_number(capabilities, kMaxTravel + static_cast<int>(axis));
  if (!length || *length <= 0) return std::nullopt;
  return vocabulary::TravelFacts{
      .length_mm = static_cast<float>(*length),
      .homes_to_minus = is_setting_on(capabilities, kHomingDirection, static_cast<unsigned>(axis)),
      .switch_at_mm = static_cast<float>(switch_at_mm(axis, capabilities)),
      .pull_off_mm = static_cast<float>(setting_number(capabilities, kHomingPullOff).value_or(0)),
      .zero_at_switch = is_setting_on(capabilities, kHoming, kOriginZeroBit)};
}

bool is_setting_on(const Capabilities& capabilities, int id, unsigned bit) {
  constexpr double kMost = std::numeric_limits<unsigned>::max();
  const auto bits = static_cast<unsigned>(std::clamp(setting_number(capabilities, id).value_or(0), 0.0, kMost));
  return ((bits >> bit) & 1U) != 0;
}

std::string short_number(double value) {
  std::string text = base::to_fixed(std::abs(value) < kTolerance ? 0.0 : value, 3);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::optional<double> setting_number(const Capabilities& capabilities, int id) {
  const std::string name = std::to_string(id);
  const auto found = std::ranges::find(capabilities.settings, name, &SettingFact::id);
  if (found == capabilities.settings.end() || !found->value) return std::nullopt;
  return base::parse_decimal(base::trim(*found->value));
}

std::optional<Excess> worst_excess(const std::vector<std::vector<double>>& targets_mm,
                                   const MachineKnowledge& machine) {
  std::optional<Excess> worst;
  for (const auto& target : targets_mm) {
    for (std::size_t axis = 0; axis < std::min(target.size(), vocabulary::kMaxAxes); ++axis) {
      const auto travel = travel_of_axis(axis, machine.capabilities, machine.dialect);
      if (!travel) continue;
      const double excess = excess_of(target[axis], *travel);
      if (std::abs(excess) <= (worst ? std::abs(worst->excess_mm) : 0)) continue;
      worst = Excess{.axis = axis,
                     .target_mm = target[axis],
                     .excess_mm = excess,
                     .travel_min_mm = static_cast<double>(travel->min_mm),
                     .travel_max_mm = static_cast<double>(travel->max_mm)};
    }
  }
  return worst;
}

std::string excess_text(const Excess& excess, const Snapshot& before) {
  const bool is_below = excess.excess_mm < 0;
  return std::string{kAxisLetters[excess.axis]} + short_number(excess.target_mm) + " is " +
         short_number(std::abs(excess.excess_mm)) + " mm " + (is_below ? "below" : "above") + " the travel" +
         reason_for(excess, before);
}

std::vector<std::string> nearness_to_ends(const Snapshot& snapshot, const MachineKnowledge& machine) {
  std::vector<std::string> sentences;
  if (!snapshot.machine_position_mm) return sentences;
  for (std::size_t axis = 0; axis < std::min(snapshot.machine_position_mm->size(), vocabulary::kMaxAxes); ++axis) {
    const auto travel = travel_of_axis(axis, machine.capabilities, machine.dialect);
    if (!travel) continue;
    const double at = (*snapshot.machine_position_mm)[axis];
    const double to_min = at - static_cast<double>(travel->min_mm);
    const double to_max = static_cast<double>(travel->max_mm) - at;
    if (std::min(to_min, to_max) > kNearEnd) continue;
    const double distance = std::min(to_min, to_max);
    sentences.push_back(std::string{kAxisLetters[axis]} + short_number(at) + " is " +
                        (distance < 0 ? short_number(-distance) + " mm beyond" : short_number(distance) + " mm from") +
                        " the " + (to_min < to_max ? "lower" : "upper") + " end of its travel.");
  }
  return sentences;
}

std::string inputs_text(const Snapshot& snapshot, const vocabulary::Dialect& dialect) {
  if (!snapshot.inputs) return "The controller does not report its inputs.";
  if (snapshot.pins.empty()) return "No input is active.";
  std::string text;
  for (const char letter : snapshot.pins) {
    const auto* const row = vocabulary::find_pin(dialect.firmware, letter);
    text += (text.empty() ? "Active inputs: " : ", ") + (row == nullptr ? std::string{letter} : std::string{row->name});
  }
  return text + ".";
}

std::vector<std::string> unknown_commands(std::string_view line, const vocabulary::Dialect& dialect) {
  std::vector<std::string> unknown;
  const auto& commands = *gcode::rules_for(dialect).commands;
  for_each_command(line, [&](char letter, std::string_view number) {
    const auto whole = base::parse_int<std::uint64_t>(number.substr(0, number.find('.')));
    if (!whole) return;
    const auto rows = letter == 'G' ? commands.g(*whole) : commands.m(*whole);
    if (rows.empty()) unknown.push_back(std::string{letter} + std::string{number});
  });
  return unknown;
}

std::string line_text(const IncidentLine& line) {
  const std::string quoted = "'" + base::escape(line.text) + "'";
  return line.file_line == 0 ? quoted : "line " + std::to_string(line.file_line) + ", " + quoted;
}

std::string place_text(const std::vector<double>& position_mm) {
  std::string text;
  for (std::size_t axis = 0; axis < std::min(position_mm.size(), vocabulary::kMaxAxes); ++axis) {
    text += (axis == 0 ? "" : " ") + (kAxisLetters[axis] + short_number(position_mm[axis]));
  }
  return text;
}

}  // namespace kerf::machine
