#include "sender/job/program_start.hpp"

#include <algorithm>
#include <array>

#include "common/base/text.hpp"
#include "common/gcode/rules.hpp"

namespace kerf::job {
namespace {

using vocabulary::AxisValues;

constexpr std::array<std::string_view, gcode::kMaxWorkOffsets> kWorkOffsets{"G54", "G55",   "G56",   "G57",  "G58",
                                                                            "G59", "G59.1", "G59.2", "G59.3"};
constexpr std::size_t kZ = 2;
/// Digits behind the point that any firmware reads back without loss.
constexpr int kDecimals = 4;

AxisValues axis_values(const std::vector<double>& values) {
  AxisValues result{};
  for (std::size_t axis = 0; axis < std::min(values.size(), result.size()); ++axis) {
    result.at(axis) = static_cast<float>(values[axis]);
  }
  return result;
}

/// `[TLO:]` has one number for Z on Grbl and Rabbit.
AxisValues tool_length_of(const machine::ToolLength& length) {
  if (!length.offset_mm) return {};
  if (length.offset_mm->size() != 1) return axis_values(*length.offset_mm);
  AxisValues result{};
  result[kZ] = static_cast<float>(length.offset_mm->front());
  return result;
}

gcode::Offsets offsets_of(const MachineAtStart& machine) {
  const auto at = [&](std::string_view name) {
    const auto found = machine.offsets_mm.find(std::string{name});
    return found == machine.offsets_mm.end() ? AxisValues{} : axis_values(found->second);
  };
  gcode::Offsets offsets;
  for (std::size_t i = 0; i < kWorkOffsets.size(); ++i) offsets.work.at(i) = at(kWorkOffsets.at(i));
  offsets.g28 = at("G28");
  offsets.g30 = at("G30");
  offsets.g92 = at("G92");
  offsets.g92_stored = offsets.g92;
  offsets.tool_length = tool_length_of(machine.tool_length);
  return offsets;
}

/// Words of `[GC:]` that have no place of their own in ParserModes.
constexpr std::array<std::string_view, 4> kFurtherModes{"G7", "G8", "G98", "G99"};

/// Lines that put a fresh interpreter into these modes and move nothing.
std::vector<std::string> mode_lines(const ProgramStart& start) {
  const machine::ParserModes& modes = start.modes;
  std::vector<std::string> lines;
  if (modes.feed_mode != "G93" && modes.feed_mm_per_min.value_or(0) > 0) {
    lines.push_back("G21F" + base::to_fixed(*modes.feed_mm_per_min, kDecimals));
  }
  if (modes.spindle_rpm.value_or(0) > 0) lines.push_back("S" + base::to_fixed(*modes.spindle_rpm, kDecimals));
  std::string words;
  for (const std::string* word :
       {&modes.plane, &modes.units, &modes.distance, &modes.feed_mode, &modes.work_coordinates, &modes.spindle}) {
    words += *word;
  }
  for (const std::string_view word : kFurtherModes) {
    if (std::ranges::find(start.parser_words, word) != start.parser_words.end()) words += word;
  }
  if (modes.motion == "G0" || modes.motion == "G1" || modes.motion == "G80") words += modes.motion;
  lines.push_back(words);
  for (const std::string_view word : base::split(modes.coolant, ' ')) lines.emplace_back(word);
  return lines;
}

}  // namespace

std::string_view work_offset_name(std::size_t index) {
  return kWorkOffsets.at(index);
}

MachineAtStart present_machine(const machine::Snapshot& now, const machine::Capabilities& capabilities) {
  MachineAtStart machine{.firmware = capabilities.family,
                         .version = capabilities.version,
                         .build = capabilities.build,
                         .user_text = capabilities.user_text,
                         .axes = capabilities.axes.letters,
                         .planner_blocks = capabilities.buffers.planner_blocks,
                         .state = now.state,
                         .parser_words = now.parser_words,
                         .modes = now.modes,
                         .modes_are_current = !now.parser_state_is_old && !now.parser_words.empty(),
                         .offsets_mm = now.offsets_mm,
                         .offsets_are_current = !now.offsets_are_old && !now.offsets_mm.empty(),
                         .work_coordinate_system = now.work_coordinate_system,
                         .tool = now.tool,
                         .tool_length = now.tool_length,
                         .overrides = now.overrides,
                         .homing = now.homing,
                         .machine_position_mm = now.machine_position_mm,
                         .work_offset_mm = now.work_offset_mm};
  for (const auto& setting : capabilities.settings) {
    if (setting.value) machine.settings.push_back({.id = setting.id, .value = *setting.value});
  }
  return machine;
}

std::expected<ProgramStart, StartUnknown> program_start_of(const MachineAtStart& machine,
                                                           const gcode::InterpreterSettings& settings) {
  if (machine.firmware == vocabulary::Firmware::Unknown) return std::unexpected{StartUnknown{"the firmware"}};
  if (!machine.machine_position_mm) return std::unexpected{StartUnknown{"the machine position"}};
  if (machine.parser_words.empty()) return std::unexpected{StartUnknown{"the modes in force ($G)"}};
  if (machine.offsets_mm.empty()) return std::unexpected{StartUnknown{"the work offsets ($#)"}};
  const std::size_t axes = std::min(machine.machine_position_mm->size(), vocabulary::kMaxAxes);
  gcode::InterpreterSettings reading = settings;
  reading.axes = static_cast<int>(axes);
  return ProgramStart{.dialect = &vocabulary::dialect_of(machine.firmware),
                      .settings = reading,
                      .offsets = offsets_of(machine),
                      .position_mm = axis_values(*machine.machine_position_mm),
                      .modes = machine.modes,
                      .parser_words = machine.parser_words,
                      .tool = machine.tool.value_or(0)};
}

std::optional<gcode::Interpreter> interpreter_at(const ProgramStart& start) {
  gcode::Interpreter reader(gcode::rules_for(*start.dialect), start.settings);
  reader.offsets() = start.offsets;
  reader.reload_offsets();
  reader.sync_position(start.position_mm);
  std::vector<gcode::Action> actions;
  for (const std::string& line : mode_lines(start)) {
    if (!line.empty() && !reader.interpret(line, actions)) return std::nullopt;
  }
  // Where T and M6 are two things, only M61 sets the tool without a change (grblHAL).
  if (start.tool > 0) {
    const std::string number = std::to_string(start.tool);
    const bool is_set = start.dialect->tool_change == vocabulary::ToolChangeRule::AsTold
                            ? reader.interpret("M61Q" + number, actions).has_value()
                            : reader.interpret("T" + number, actions).has_value();
    if (!is_set) return std::nullopt;
  }
  // The mode of G43 is not told by every firmware, its value is.
  for (std::size_t axis = 0; axis < start.offsets.tool_length.size(); ++axis) {
    if (start.offsets.tool_length.at(axis) != 0.0F) reader.set_tool_length(axis, start.offsets.tool_length.at(axis));
  }
  reader.reload_offsets();
  return reader;
}

}  // namespace kerf::job
