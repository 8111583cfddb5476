#include "apps/status_text.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/progress_text.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::apps {
namespace {

using machine::Snapshot;
using machine::SpindleTurn;
using vocabulary::MachineState;

/// A report older than this is said to be.
constexpr double kFreshFor = 1.0;
constexpr std::size_t kMessagesShown = 3;

std::string row(std::string_view name, std::string_view value) {
  return fmt::format("  {:<14} {}", name, value);
}

std::string headline(const MachineStatus& status) {
  const Snapshot& machine = status.machine;
  if (machine.state == MachineState::Unknown) {
    return machine.odd_state.empty() ? "The machine has not said what it does."
                                     : fmt::format("{}: a state that Kerf does not know.", machine.odd_state);
  }
  const auto rows = vocabulary::machine_state_rows();
  const auto known = std::ranges::find(rows, machine.state, &vocabulary::MachineStateRow::state);
  const std::string text = known == rows.end() ? std::string() : std::string(known->text);
  if (!machine.substate || machine.state == MachineState::Alarm)
    return fmt::format("{}: {}", state_text(machine), text);
  const auto* substate =
      vocabulary::find_substate(vocabulary::Firmware::Unknown, machine.state, machine.substate.value_or(0));
  return fmt::format("{}: {}", state_text(machine), substate == nullptr ? text : std::string(substate->text));
}

std::string spindle_text(const Snapshot& machine) {
  const auto turns = machine.accessories ? machine.accessories->spindle : SpindleTurn::Off;
  const double rpm = machine.spindle_rpm.value_or(0);
  std::string text = "off";
  if (turns == SpindleTurn::Clockwise) text = fmt::format("clockwise at {:.0f} rpm", rpm);
  if (turns == SpindleTurn::Counterclockwise) text = fmt::format("counterclockwise at {:.0f} rpm", rpm);
  if (!machine.accessories) text = fmt::format("{:.0f} rpm", rpm);
  if (machine.measured_rpm) text += fmt::format(", measured {:.0f} rpm", *machine.measured_rpm);
  return text;
}

std::string coolant_text(const Snapshot& machine) {
  if (!machine.accessories) return {};
  const auto& on = *machine.accessories;
  if (on.flood && on.mist) return "flood and mist";
  if (on.flood) return "flood";
  return on.mist ? "mist" : "off";
}

/// Each active input by name.
std::vector<std::string_view> input_names(const machine::Inputs& inputs) {
  struct Name {
    bool is_active;
    std::string_view text;
  };
  std::vector<std::string_view> names;
  for (const Name& input :
       {Name{inputs.probe, "probe"}, Name{inputs.probe_disconnected, "probe disconnected"}, Name{inputs.door, "door"},
        Name{inputs.feed_hold, "feed hold"}, Name{inputs.cycle_start, "cycle start"}, Name{inputs.reset, "reset"},
        Name{inputs.emergency_stop, "E-stop"}, Name{inputs.motor_fault, "motor fault"},
        Name{inputs.motor_warning, "motor warning"}, Name{inputs.block_delete, "block delete"},
        Name{inputs.optional_stop_off, "optional stop off"}, Name{inputs.single_block, "single block"}}) {
    if (input.is_active) names.push_back(input.text);
  }
  return names;
}

std::string inputs_text(const Snapshot& machine) {
  if (!machine.inputs) return "not reported ($10)";
  std::string text;
  const auto add = [&](std::string_view part) { text += fmt::format("{}{}", text.empty() ? "" : ", ", part); };
  for (const char axis : machine.inputs->limits) add(fmt::format("{} limit", axis));
  for (const std::string_view name : input_names(*machine.inputs)) add(name);
  for (const char letter : machine.inputs->other) add(std::string(1, letter));
  return text.empty() ? "none active" : text;
}

std::string homing_text(const Snapshot& machine) {
  const auto& homing = machine.homing;
  const std::string source = homing.is_told ? "" : " (by Kerf's account: this controller does not tell)";
  if (homing.all.value_or(false)) return "yes" + source;
  if (homing.axes && !homing.axes->empty()) return "only " + *homing.axes + source;
  return homing.all ? "no" + source : "not known";
}

std::string tool_text(const Snapshot& machine) {
  std::string text;
  if (machine.tool) text = fmt::format("T{}", *machine.tool);
  const auto& length = machine.tool_length;
  if (length.offset_mm && std::ranges::any_of(*length.offset_mm, [](double value) { return value != 0; })) {
    text += fmt::format("{}length offset {} mm", text.empty() ? "" : ", ",
                        length.offset_mm->size() == 1 ? machine::short_number(length.offset_mm->front())
                                                      : machine::place_text(*length.offset_mm));
  }
  if (length.reference_set.value_or(false)) text += ", length reference set";
  return text;
}

std::string modes_text(const Snapshot& machine) {
  if (machine.parser_words.empty()) return {};
  return fmt::format("{}{}", fmt::join(machine.parser_words, " "),
                     machine.parser_state_is_old ? " (before the last lines)" : "");
}

std::string probe_text(const Snapshot& machine) {
  if (!machine.probe) return {};
  const bool is_zero = std::ranges::all_of(machine.probe->position_mm, [](double value) { return value == 0; });
  if (!machine.probe->touched) return is_zero ? std::string() : "last probing made no contact";
  return "last contact at " + machine::place_text(machine.probe->position_mm) + " (machine)";
}

std::string card_text(const Snapshot& machine) {
  if (machine.card.file_waits) return "its file waits for cycle start to run again";
  if (!machine.controller_file.empty()) {
    return fmt::format("runs {}{}", machine.controller_file,
                       machine.card.file_percent ? fmt::format(", {:.1f} %", *machine.card.file_percent) : "");
  }
  if (!machine.card.mounted) return {};
  return *machine.card.mounted ? "mounted" : "not mounted";
}

std::string link_text(const session::LinkHealth& link) {
  std::string text;
  if (link.silent_for_s) return fmt::format("not answering for {}", age_text(*link.silent_for_s));
  if (link.report_age_s) text = fmt::format("last report {} ago", age_text(*link.report_age_s));
  if (link.automatic) return text + ", reports come by themselves";
  if (link.ask_every_s >= 1) return text + fmt::format(", asked every {:.0f} s", link.ask_every_s);
  if (link.ask_every_s > 0) text += fmt::format(", asked {:.0f} times a second", 1 / link.ask_every_s);
  if (link.answer_time_s) text += fmt::format(", answered in {:.0f} ms", *link.answer_time_s * 1000);
  return text;
}

/// How old what is shown is, if that is worth a word.
std::string staleness(const MachineStatus& status) {
  if (status.link.silent_for_s) return fmt::format("not answering for {}", age_text(*status.link.silent_for_s));
  if (status.link.report_age_s.value_or(0) < kFreshFor) return {};
  return fmt::format("{} old", age_text(*status.link.report_age_s));
}

void add(std::vector<std::string>& lines, std::string_view name, const std::string& value) {
  if (!value.empty()) lines.push_back(row(name, value));
}

void add_positions(std::vector<std::string>& lines, const Snapshot& machine) {
  if (machine.work_position_mm) {
    add(lines, "Work position",
        position_text(machine) + (machine.work_coordinate_system ? " (" + *machine.work_coordinate_system + ")" : ""));
  }
  if (machine.machine_position_mm) add(lines, "Machine at", machine::place_text(*machine.machine_position_mm));
  if (machine.distance_to_go_mm) add(lines, "To go", machine::place_text(*machine.distance_to_go_mm));
  if (machine.feed_mm_per_min) add(lines, "Feed", fmt::format("{:.0f} mm/min", *machine.feed_mm_per_min));
}

}  // namespace

std::string age_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{} min", static_cast<int>(seconds / 60));
}

std::vector<std::string> status_lines(const MachineStatus& status) {
  const Snapshot& machine = status.machine;
  std::vector<std::string> lines{headline(status)};
  if (machine.pendant_in_control) lines.emplace_back("A pendant has the machine.");
  if (!machine.prompt.empty()) lines.push_back("The machine waits: " + machine.prompt);
  add_positions(lines, machine);
  add(lines, "Spindle", spindle_text(machine));
  add(lines, "Coolant", coolant_text(machine));
  if (machine.overrides) {
    add(lines, "Overrides",
        fmt::format("feed {} %, rapid {} %, spindle {} %", machine.overrides->feed, machine.overrides->rapid,
                    machine.overrides->spindle));
  }
  add(lines, "Inputs", inputs_text(machine));
  add(lines, "Homed", homing_text(machine));
  add(lines, "Tool", tool_text(machine));
  add(lines, "Modes", modes_text(machine));
  add(lines, "Probe", probe_text(machine));
  add(lines, "Card", card_text(machine));
  for (const auto& field : machine.other_fields) {
    if (field.name != "SD") add(lines, field.name, field.value + " (Kerf does not know this field)");
  }
  const std::size_t first = machine.messages.size() - std::min(machine.messages.size(), kMessagesShown);
  for (std::size_t at = first; at < machine.messages.size(); ++at) add(lines, "It said", machine.messages[at].text);
  add(lines, "Link", link_text(status.link));
  if (status.alarm) {
    lines.push_back(status.alarm->headline);
    for (const std::string& detail : machine::details_of(*status.alarm)) lines.push_back("  " + detail);
  }
  return lines;
}

std::string status_line(const MachineStatus& status, int columns) {
  const Snapshot& machine = status.machine;
  std::string text;
  const auto add_part = [&](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : "  ") + part;
  };
  add_part(staleness(status));
  if (machine.pendant_in_control) add_part("PENDANT");
  std::string state = state_text(machine);
  if (machine.state == MachineState::Alarm && machine.alarm_code) state += fmt::format(" {}", *machine.alarm_code);
  add_part(state.empty() ? "?" : state);
  add_part(position_text(machine));
  if (machine.feed_mm_per_min.value_or(0) > 0) add_part(fmt::format("F{:.0f}", *machine.feed_mm_per_min));
  if (machine.spindle_rpm.value_or(0) > 0) add_part(fmt::format("S{:.0f}", *machine.spindle_rpm));
  if (!machine.controller_file.empty()) add_part(card_text(machine));
  if (machine.inputs && machine.inputs != machine::Inputs{}) add_part("[" + inputs_text(machine) + "]");
  if (!machine.prompt.empty()) add_part(machine.prompt);
  return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 1)));
}

}  // namespace kerf::apps
