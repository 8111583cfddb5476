#include "sender/machine/explanation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/text.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/errors.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "sender/machine/explanation_rows.hpp"

namespace kerf::machine {
namespace {

using vocabulary::AlarmCode;
using vocabulary::ErrorCode;
using vocabulary::Firmware;
using vocabulary::FirmwareSet;
using vocabulary::MachineState;

constexpr std::size_t kLinesShown = 3;

/// What one code is explained with.
struct Question {
  const Incident& incident;
  const MachineKnowledge& machine;
};

/// The particulars: the end of the headline, and more evidence.
struct Finding {
  std::string headline{};
  std::vector<std::string> evidence{};
};

bool is_pressed(const Question& about, bool Inputs::* input) {
  return about.machine.now.inputs && (*about.machine.now.inputs).*input;
}

std::string pressed_limits(const Snapshot& snapshot) {
  return snapshot.inputs ? snapshot.inputs->limits : std::string{};
}

// --- alarms ---

Finding hard_limit(const Question& about) {
  Finding finding;
  const std::string limits = pressed_limits(about.machine.now);
  finding.evidence = nearness_to_ends(about.incident.before, about.machine);
  if (!limits.empty()) {
    finding.headline = "the limit switch of " + limits + " is pressed";
    if (finding.evidence.empty() && about.incident.before.homing.all.value_or(false)) {
      finding.evidence.emplace_back(
          "The last position reported is far from the ends of the travel: the position may have been wrong before.");
    }
    return finding;
  }
  finding.headline = "a limit switch was hit";
  if (about.machine.now.inputs) {
    finding.evidence.emplace_back(
        finding.evidence.empty()
            ? "No switch is pressed and the axes were far from their ends: noise on a switch cable is likely."
            : "No switch is pressed any more.");
  }
  return finding;
}

Finding soft_limit(const Question& about) {
  Finding finding;
  const auto excess = worst_excess(about.incident.targets_mm, about.machine);
  if (!excess) {
    finding.headline = "the line asks for a place outside of the travel";
    return finding;
  }
  finding.headline = excess_text(*excess, about.incident.before);
  const char axis = vocabulary::kAxisLetters[excess->axis];
  finding.evidence.push_back(std::string{axis} + " travels from " + short_number(excess->travel_min_mm) + " to " +
                             short_number(excess->travel_max_mm) + " in machine coordinates.");
  if (about.incident.before.work_offset_mm && excess->axis < about.incident.before.work_offset_mm->size()) {
    const double offset = (*about.incident.before.work_offset_mm)[excess->axis];
    finding.evidence.push_back("In work coordinates the line asks for " + std::string{axis} +
                               short_number(excess->target_mm - offset) + "; the offsets add " + short_number(offset) +
                               ".");
  }
  return finding;
}

Finding reset_in_motion(const Question& about) {
  if (about.incident.reset_by_kerf) return {.headline = "Kerf was told to reset the machine while it moved"};
  if (is_pressed(about, &Inputs::reset) || is_pressed(about, &Inputs::emergency_stop)) {
    return {.headline = "the reset or E-stop input was activated while the machine moved"};
  }
  return {.headline = "the machine was reset while it moved, and not by Kerf",
          .evidence = {"A reset button, a pendant, another program or a dip in the supply voltage can do that."}};
}

Finding probe_before(const Question& about) {
  const bool touches = is_pressed(about, &Inputs::probe);
  Finding finding{.headline = touches ? "the probe was already touching when the cycle began"
                                      : "the probe was not in the state that the cycle needs"};
  if (is_pressed(about, &Inputs::probe_disconnected)) finding.evidence.emplace_back("No probe is plugged in.");
  return finding;
}

Finding probe_missed(const Question& about) {
  Finding finding{.headline = "the probe touched nothing on its way"};
  const auto& targets = about.incident.targets_mm;
  if (!targets.empty()) {
    finding.evidence.push_back("It went as far as " + place_text(targets.back()) + " (machine coordinates).");
  }
  if (is_pressed(about, &Inputs::probe)) {
    finding.evidence.emplace_back("The probe touches now: the contact may be slow or loose.");
  }
  return finding;
}

Finding switch_stays_pressed(const Question& about) {
  const auto pull_off = setting_number(about.machine.capabilities, 27);
  const std::string limits = pressed_limits(about.machine.now);
  Finding finding{.headline = "backing off" + (pull_off ? " by " + short_number(*pull_off) + " mm ($27)" : "") +
                              " did not free the switch" + (limits.empty() ? "" : " of " + limits)};
  return finding;
}

Finding switch_not_found(const Question& about) {
  Finding finding{.headline = "no switch was met on the way that homing searches"};
  if (about.machine.now.machine_position_mm) {
    finding.evidence.push_back("The search ended at " + place_text(*about.machine.now.machine_position_mm) + ".");
  }
  return finding;
}

Finding emergency_stop(const Question& about) {
  return {.headline = is_pressed(about, &Inputs::emergency_stop) ? "the E-stop is still pressed"
                                                                 : "the E-stop was pressed and is released now"};
}

Finding limit_at_start(const Question& about) {
  const std::string limits = pressed_limits(about.machine.now);
  return {.headline =
              limits.empty() ? "a limit switch was pressed at start" : "the switch of " + limits + " is pressed"};
}

Finding probe_protection(const Question& about) {
  return {.headline = is_pressed(about, &Inputs::probe) ? "the probe touches outside of a probing cycle"
                                                        : "the probe was touched outside of a probing cycle"};
}

Finding spindle_too_slow(const Question& about) {
  Finding finding{.headline = "the spindle did not reach its speed in time"};
  const Snapshot& before = about.incident.before;
  if (before.measured_rpm && before.spindle_rpm) {
    finding.evidence.push_back("It was measured at " + short_number(*before.measured_rpm) + " of " +
                               short_number(*before.spindle_rpm) + " rpm.");
  }
  return finding;
}

Finding motor_fault(const Question& about) {
  return {.headline = is_pressed(about, &Inputs::motor_fault) ? "a motor driver still reports a fault"
                                                              : "a motor driver reported a fault"};
}

// --- errors ---

Finding unsupported(const Question& about) {
  Finding finding;
  if (!about.incident.culprit) return finding;
  for (const std::string& word : unknown_commands(about.incident.culprit->text, about.machine.dialect)) {
    finding.headline += (finding.headline.empty() ? "" : " and ") + word;
  }
  if (!finding.headline.empty()) finding.headline += " is not known to " + std::string{about.machine.dialect.name};
  return finding;
}

Finding jog_outside(const Question& about) {
  const auto excess = worst_excess(about.incident.targets_mm, about.machine);
  return {.headline = excess ? excess_text(*excess, about.incident.before) : std::string{}};
}

Finding wrong_state(const Question& about) {
  const Snapshot& before = about.incident.before;
  if (before.state == MachineState::Unknown) return {};
  Finding finding{.headline = "the machine was in state " + std::string{vocabulary::name_of(before.state)}};
  if (before.state == MachineState::Alarm && before.alarm_code) {
    finding.headline += " (alarm " + std::to_string(*before.alarm_code) + ")";
  }
  return finding;
}

Finding no_feed(const Question& about) {
  const auto& feed = about.incident.before.modes.feed_mm_per_min;
  if (!feed || *feed > 0) return {};
  return {.headline = "no F word has been given since the last reset"};
}

Finding homing_off(const Question& about) {
  const auto homing = setting_number(about.machine.capabilities, 22);
  return {.headline = homing ? "$22 is " + short_number(*homing) : std::string{}};
}

Finding limits_engaged(const Question& about) {
  const std::string limits = pressed_limits(about.machine.now);
  return {.headline = limits.empty() ? std::string{} : "the switch of " + limits + " is pressed"};
}

Finding not_homed(const Question& about) {
  const auto& homing = about.machine.now.homing;
  if (homing.axes && !homing.axes->empty()) return {.headline = "only " + *homing.axes + " is homed"};
  return {};
}

Finding door_open(const Question& about) {
  return {.headline = is_pressed(about, &Inputs::door) ? "the safety door is open" : std::string{}};
}

struct Explainer {
  IncidentKind kind;
  int code;
  FirmwareSet known_to;
  Finding (*find)(const Question&);
};

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr Explainer alarm_row(AlarmCode code, FirmwareSet known_to, Finding (*find)(const Question&)) {
  return {.kind = IncidentKind::Alarm, .code = number_of(code), .known_to = known_to, .find = find};
}
constexpr Explainer error_row(ErrorCode code, FirmwareSet known_to, Finding (*find)(const Question&)) {
  return {.kind = IncidentKind::Error, .code = static_cast<int>(code), .known_to = known_to, .find = find};
}

constexpr std::array kExplainers{
    alarm_row(AlarmCode::HardLimit, kAll, hard_limit),
    alarm_row(AlarmCode::SoftLimit, kAll, soft_limit),
    alarm_row(AlarmCode::AbortCycle, kAll, reset_in_motion),
    alarm_row(AlarmCode::ProbeFailInitial, kAll, probe_before),
    alarm_row(AlarmCode::ProbeFailContact, kAll, probe_missed),
    alarm_row(AlarmCode::HomingFailPulloff, kAll, switch_stays_pressed),
    alarm_row(AlarmCode::HomingFailApproach, kAll, switch_not_found),
    alarm_row(AlarmCode::EmergencyStop, kHal, emergency_stop),
    alarm_row(AlarmCode::LimitsEngaged, kHal, limit_at_start),
    alarm_row(AlarmCode::ProbeProtect, kHal, probe_protection),
    alarm_row(AlarmCode::SpindleAtSpeedTimeout, kHal, spindle_too_slow),
    alarm_row(AlarmCode::MotorFault, kHal, motor_fault),
    error_row(ErrorCode::HomingDisabled, kAll, homing_off),
    error_row(ErrorCode::IdleError, kAll, wrong_state),
    error_row(ErrorCode::SystemLocked, kAll, wrong_state),
    error_row(ErrorCode::CheckDoor, kAll, door_open),
    error_row(ErrorCode::TravelExceeded, kAll, jog_outside),
    error_row(ErrorCode::UnsupportedCommand, kAll, unsupported),
    error_row(ErrorCode::UndefinedFeedRate, kAll, no_feed),
    error_row(ErrorCode{45}, kHal, limits_engaged),
    error_row(ErrorCode{46}, kHal, not_homed),
};

Finding find_out(const Question& about) {
  const Firmware firmware = about.machine.dialect.firmware;
  for (const Explainer& row : kExplainers) {
    const bool speaks = firmware == Firmware::Unknown || contains(row.known_to, firmware);
    if (row.kind == about.incident.kind && row.code == about.incident.code && speaks) return row.find(about);
  }
  return {};
}

const AlarmAdvice& advice_for(int code, const vocabulary::Dialect& dialect) {
  const auto fits = [&](const AlarmAdvice& row) {
    return row.code == code && (dialect.firmware == Firmware::Unknown || contains(row.known_to, dialect.firmware));
  };
  const auto* const row = std::ranges::find_if(advice::kAlarmAdvice, fits);
  return row == advice::kAlarmAdvice.end() ? advice::kUnknownAlarm : *row;
}

std::vector<std::string> steps_of(const AlarmAdvice& row) {
  std::vector<std::string> steps;
  for (const std::string_view step : row.steps) {
    if (!step.empty()) steps.emplace_back(step);
  }
  return steps;
}

/// What to do about a refused line: it was not executed, so nothing is urgent.
std::vector<std::string> error_steps(const Incident& incident, const vocabulary::Dialect& dialect) {
  const bool is_job_line = incident.culprit && incident.culprit->file_line > 0;
  if (!is_job_line) return {"Nothing was executed: correct the line and send it again."};
  std::vector<std::string> steps;
  steps.emplace_back(
      dialect.error_latch
          ? "The line was not executed, nor was any behind it: the machine stands where it was."
          : "The line was not executed, but lines behind it that the controller had already taken were.");
  steps.emplace_back("Correct the file (or the post-processor), then start again.");
  return steps;
}

std::string beginning(const Incident& incident) {
  std::string text = incident.kind == IncidentKind::Alarm ? "Alarm" : "Error";
  if (incident.code > 0) text += " " + std::to_string(incident.code);
  if (!incident.culprit) return text;
  if (incident.culprit->file_line > 0) return text + " at line " + std::to_string(incident.culprit->file_line);
  return text + " at '" + base::escape(incident.culprit->text) + "'";
}

std::string as_sentence(std::string text) {
  if (text.empty() || text.ends_with('.')) return text;
  return text + ".";
}

void add_common_evidence(Explanation& explanation, const Question& about) {
  auto& evidence = explanation.evidence;
  const Incident& incident = about.incident;
  if (incident.culprit) evidence.push_back("It was " + line_text(*incident.culprit) + ".");
  if (incident.kind == IncidentKind::Error) return;
  evidence.push_back(inputs_text(about.machine.now, about.machine.dialect));
  const auto& position = about.machine.now.machine_position_mm ? about.machine.now.machine_position_mm
                                                               : incident.before.machine_position_mm;
  if (position) evidence.push_back("Machine position as reported: " + place_text(*position) + ".");
  if (incident.lines.empty()) return;
  std::string lines = "Last lines sent: ";
  const std::size_t first = incident.lines.size() - std::min(incident.lines.size(), kLinesShown);
  for (std::size_t at = first; at < incident.lines.size(); ++at) {
    lines += (at == first ? "" : "; ") + line_text(incident.lines[at]) +
             (incident.lines[at].answered ? "" : " (not answered)");
  }
  evidence.push_back(lines + ".");
}

/// The controller's text, with its title only where the headline has not said that already.
std::string text_beyond_headline(const Explanation& explanation) {
  std::string_view text = explanation.text;
  const std::string_view title = explanation.title;
  const bool repeats = base::starts_with_ignoring_case(text, title);
  const bool headline_tells = explanation.headline.find(title) != std::string::npos;
  if (repeats && headline_tells) text.remove_prefix(title.size());
  const auto first = text.find_first_not_of(". ");
  if (first == std::string_view::npos) return {};
  text.remove_prefix(first);
  return repeats || headline_tells ? std::string{text} : explanation.title + ". " + std::string{text};
}

}  // namespace

Explanation explain(const Incident& incident, const CodeFact& meaning, const MachineKnowledge& machine) {
  Explanation explanation{.kind = incident.kind,
                          .code = incident.code,
                          .title = meaning.title,
                          .text = meaning.text,
                          .source = meaning.source,
                          .culprit = incident.culprit};
  const Question about{.incident = incident, .machine = machine};
  Finding finding = find_out(about);
  if (finding.headline.empty()) finding.headline = meaning.title;
  explanation.headline = as_sentence(beginning(incident) + (finding.headline.empty() ? "" : ": " + finding.headline));
  explanation.evidence = std::move(finding.evidence);
  add_common_evidence(explanation, about);
  if (incident.kind == IncidentKind::Error) {
    explanation.next_steps = error_steps(incident, machine.dialect);
    return explanation;
  }
  const AlarmAdvice& row = advice_for(incident.code, machine.dialect);
  explanation.position = row.position;
  explanation.next_steps = steps_of(row);
  return explanation;
}

Explanation explain_code(IncidentKind kind, const CodeFact& meaning, const vocabulary::Dialect& dialect) {
  Explanation explanation{
      .kind = kind, .code = meaning.id, .title = meaning.title, .text = meaning.text, .source = meaning.source};
  explanation.headline = as_sentence((kind == IncidentKind::Alarm ? "Alarm " : "Error ") + std::to_string(meaning.id) +
                                     ": " + meaning.title);
  if (kind == IncidentKind::Error) return explanation;
  const AlarmAdvice& row = advice_for(meaning.id, dialect);
  explanation.position = row.position;
  explanation.next_steps = steps_of(row);
  return explanation;
}

std::vector<std::string> details_of(const Explanation& explanation) {
  std::vector<std::string> lines;
  if (std::string text = text_beyond_headline(explanation); !text.empty()) lines.push_back(std::move(text));
  for (const std::string& evidence : explanation.evidence) lines.push_back("- " + evidence);
  if (explanation.kind == IncidentKind::Alarm) {
    switch (explanation.position) {
      case PositionTrust::Kept: break;
      case PositionTrust::Suspect: lines.emplace_back("The position may be wrong."); break;
      case PositionTrust::Unknown: lines.emplace_back("The position is not to be trusted until homing."); break;
    }
  }
  int number = 0;
  for (const std::string& step : explanation.next_steps) lines.push_back(std::to_string(++number) + ". " + step);
  return lines;
}

}  // namespace kerf::machine
