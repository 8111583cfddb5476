#include "sender/session/incidents.hpp"

#include <cmath>
#include <utility>

#include "common/protocol/secrets.hpp"
#include "sender/machine/controller_rules.hpp"

namespace kerf::session {
namespace {

using machine::Incident;
using machine::IncidentKind;
using machine::IncidentLine;

constexpr std::size_t kLinesKept = 8;

bool is_evidence(streaming::Purpose purpose) {
  return purpose == streaming::Purpose::JobLine || purpose == streaming::Purpose::Operator;
}

/// What a start of the controller puts back shows that it started: spindle, feed, units and distances.
bool may_be_modes_of(const machine::ParserModes& told, const gcode::ParserState& state) {
  const auto agrees = [](const std::string& word, std::string_view otherwise, bool is_other) {
    return word.empty() || (word != otherwise) == is_other;
  };
  const bool has_feed = !told.feed_mm_per_min || *told.feed_mm_per_min > 0 || state.feed_rate <= 0;
  return has_feed && agrees(told.spindle, "M5", state.modal.spindle != gcode::SpindleDirection::Off) &&
         agrees(told.units, "G21", state.modal.inches) && agrees(told.distance, "G90", state.modal.incremental);
}

IncidentLine line_of(const streaming::OwedLine& line, bool answered) {
  const bool is_system_line = line.text.starts_with('$');
  return {.file_line = line.file_line,
          .text = is_system_line ? protocol::Secrets{}.hidden(line.text) : line.text,
          .answered = answered};
}

}  // namespace

void Incidents::forget() {
  tracker_.forget();
  answered_.clear();
}

void Incidents::start_from(const machine::Snapshot& snapshot, const machine::Capabilities& known,
                           const vocabulary::Dialect& dialect) {
  // Then what the tracker knows is newer, or nobody knows.
  if (snapshot.parser_state_is_old || snapshot.offsets_are_old) return;
  tracker_.seed(snapshot, dialect, machine::interpreter_settings_of(known));
}

void Incidents::on_accepted(const streaming::OwedLine& line) {
  if (!is_evidence(line.purpose)) return;
  tracker_.on_accepted(line.text);
  answered_.push_back(line);
  if (answered_.size() > kLinesKept) answered_.pop_front();
}

std::vector<IncidentLine> Incidents::recent_lines() const {
  std::vector<IncidentLine> lines;
  for (const auto& line : answered_) lines.push_back(line_of(line, true));
  return lines;
}

void Incidents::on_alarm(int code, const machine::Snapshot& before, const streaming::Ledger& ledger,
                         bool reset_by_kerf) {
  Incident incident{.kind = IncidentKind::Alarm,
                    .code = code,
                    .lines = recent_lines(),
                    .before = before,
                    .reset_by_kerf = reset_by_kerf};
  for (const auto& line : ledger.owed()) {
    if (!is_evidence(line.purpose)) continue;
    if (!incident.culprit) {
      incident.culprit = line_of(line, false);
      incident.targets_mm = tracker_.targets_of(line.text);
    }
    incident.lines.push_back(line_of(line, false));
    if (incident.lines.size() >= 2 * kLinesKept) break;
  }
  alarm_ = std::move(incident);
  tracker_.forget();
}

void Incidents::on_alarm_state(int code, const machine::Snapshot& snapshot) {
  if (alarm_ && (code == 0 || alarm_->code == code)) return;
  alarm_ = Incident{.kind = IncidentKind::Alarm, .code = code, .before = snapshot};
}

Incident Incidents::refused(int code, const streaming::OwedLine& line, const machine::Snapshot& before) const {
  return {.kind = IncidentKind::Error,
          .code = code,
          .lines = recent_lines(),
          .culprit = line_of(line, true),
          .targets_mm = tracker_.targets_of(line.text),
          .before = before};
}

std::optional<std::size_t> Incidents::lines_behind(const std::vector<streaming::OwedLine>& owed,
                                                   const std::vector<double>& position_mm,
                                                   const machine::ParserModes* told) const {
  // Steps round positions; less than this is no motion that matters.
  constexpr double kSamePlace_mm = 0.02;
  machine::LineTracker reader = tracker_;
  const auto stands_there = [&] {
    for (std::size_t axis = 0; axis < position_mm.size(); ++axis) {
      const double at = static_cast<double>(reader.reader()->state().position_mm.at(axis));
      if (std::abs(at - position_mm[axis]) > kSamePlace_mm) return false;
    }
    return told == nullptr || may_be_modes_of(*told, reader.reader()->state());
  };
  std::optional<std::size_t> behind;
  for (std::size_t count = 0;; ++count) {
    if (!reader.knows()) return std::nullopt;
    if (stands_there()) {
      // Lines that move nothing leave no trace: only the last of all is believed of them.
      if (behind && count != owed.size()) return std::nullopt;
      behind = count;
    }
    if (count == owed.size()) return behind;
    if (is_evidence(owed[count].purpose)) reader.on_accepted(owed[count].text);
  }
}

}  // namespace kerf::session
