// What keeps the picture of the machine alive: reports, modes and offsets, the pendant, and why it is in alarm.

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "sender/machine/lexicon.hpp"
#include "sender/machine/realtime_alphabet.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::Purpose;
using vocabulary::MachineState;
using vocabulary::Realtime;

/// Rows that answer a question, and its end.
bool is_row(const protocol::Message& message) {
  return !std::holds_alternative<protocol::StatusReport>(message) &&
         !std::holds_alternative<protocol::AlarmRaised>(message) &&
         !std::holds_alternative<protocol::Welcome>(message) && !std::holds_alternative<protocol::Feedback>(message);
}

}  // namespace

void Session::send_byte(Realtime byte) {
  if (byte == Realtime::CycleStart) path_.on_cycle_start();
  outbox_.realtime += static_cast<char>(machine::byte_for(byte, dialect(), text_under_way()));
}

bool Session::text_under_way() const {
  return std::ranges::any_of(ledger().owed(), [](const auto& line) { return machine::carries_text(line.text); });
}

bool Session::is_for_kerf(const protocol::Message& message) {
  if (std::holds_alternative<protocol::ParserState>(message) && std::exchange(parser_report_asked_, false)) return true;
  if (ledger().empty() || !is_row(message)) return false;
  const Purpose purpose = ledger().oldest().purpose;
  return purpose == Purpose::Question || purpose == Purpose::Setting;
}

void Session::poll(Instant now) {
  if (!is_ready()) return;
  // An AVR that stores loses what it receives meanwhile (protocol.md 6.5).
  if (changes_settings() && settings_change_->is_storing()) return;
  if (poller_.is_due(now)) ask_for_reports(now);
  const auto silent_for_s = poller_.take_silence(now);
  if (!silent_for_s || may_be_silent()) return;
  tell(LinkSilent{*silent_for_s});
  note_silence();
  if (has_job() && job_->state().hold_cause != job::HoldCause::Stall) {
    job::StallFacts facts = stall_facts();
    facts.link_is_dead = true;
    facts.owed_lines = ledger().size();
    facts.unanswered_s = *silent_for_s;
    const auto stall = job::diagnose(facts);
    job_->on_stall(stall);
    tell(JobStalled{*stall});
  }
}

void Session::ask_for_reports(Instant now) {
  // A bare `AR`: the controller is set up to report by itself, and it was switched off (protocol.md 3.6).
  const bool is_offered = snapshot().auto_report_ms == 0 && acts_on(dialect().firmware, Realtime::AutoReportToggle);
  if (is_offered && options_.automatic_reports && !snapshot().pendant_in_control && !automatic_reports_asked_) {
    automatic_reports_asked_ = true;
    send_byte(Realtime::AutoReportToggle);
    send_byte(Realtime::FullStatus);
  } else {
    send_byte(Realtime::StatusQuery);
  }
  poller_.on_asked(now);
  gate_.on_asked(now);
}

// Grbl answers no question while it homes, and none in a critical alarm (protocol.md 3.4, 6.6).
bool Session::may_be_silent() const {
  const bool homes = !ledger().empty() && ledger().oldest().text.starts_with("$H");
  return homes || (snapshot().reset_required && !dialect().critical_alarm_answers_lines);
}

void Session::refresh(Instant now) {
  if (!open_) return;
  const bool is_storing = changes_settings() && settings_change_->is_storing();
  const bool is_connected = is_ready() && !is_storing && !snapshot().pendant_in_control && !poller_.is_silent(now);
  const RefreshSituation situation{.snapshot = snapshot(),
                                   .dialect = dialect(),
                                   .is_connected = is_connected,
                                   .is_quiet = !has_job() && !changes_settings() && streamer_.is_idle()};
  for (const RefreshOrder order : refresh_.take_orders(now, situation)) obey_refresh(order);
}

void Session::obey_refresh(RefreshOrder order) {
  switch (order) {
    case RefreshOrder::FullReport: send_byte(Realtime::FullStatus); return;
    case RefreshOrder::ParserReport:
      parser_report_asked_ = true;
      send_byte(Realtime::ParserReport);
      return;
    case RefreshOrder::AskParser: streamer_.enqueue(Purpose::Question, "$G"); return;
    case RefreshOrder::AskOffsets: streamer_.enqueue(Purpose::Question, "$#"); return;
  }
}

void Session::follow_pendant(Instant now) {
  switch (pendant_.on_report(snapshot().pendant_in_control)) {
    case ControlChange::None: return;
    case ControlChange::TakenByPendant:
      if (!is_ready()) return;
      // Lines that wait must not move the machine when control comes back; answers to lines under way go to the
      // pendant, and unread lines are dropped (grblHAL stream.c).
      for (const Purpose purpose :
           {Purpose::Operator, Purpose::Question, Purpose::ClearLatch, Purpose::JobSync, Purpose::Setting}) {
        streamer_.drop_queued(purpose);
      }
      strike_out();
      if (changes_settings()) settings_change_->interrupt("a pendant took the machine");
      tell(
          PendantTookOver{"A pendant has taken the machine: until it is released, or control is taken back, only "
                          "hold, stop and reset are sent."});
      return;
    case ControlChange::GivenBack:
      incidents_.forget();
      model_.on_strange_hands();
      refresh_.on_change(now);
      refresh_.on_doubt();
      if (is_ready()) tell(PendantReleased{});
      return;
  }
}

void Session::follow_path(Instant now, std::optional<Instant> asked) {
  if (!has_job() || job_->state().phase == job::JobPhase::Stopping) return;
  if (const auto departure = path_.on_report(now, asked, snapshot())) job_->on_departure(now, *departure);
  job_->set_executing(link_doubt_.widened(path_.executing()));
  if (auto gap = path_.take_gap()) {
    tell(PathUnwatched{.file_line = gap->file_line, .sentence = std::move(gap->sentence)});
  }
}

void Session::on_alarm_state() {
  if (snapshot().state == MachineState::Alarm) {
    incidents_.on_alarm_state(snapshot().alarm_code.value_or(0), snapshot());
  } else {
    incidents_.clear_alarm();
  }
}

LinkHealth Session::link_health(Instant now) const {
  LinkHealth health = poller_.health(now);
  // Reports come before the handshake is done, and from a machine that is only watched.
  if (snapshot().reported_at) health.report_age_s = base::to_seconds(now - *snapshot().reported_at);
  return health;
}

machine::MachineKnowledge Session::knowledge() const {
  return {.dialect = dialect(), .capabilities = capabilities(), .now = snapshot()};
}

machine::Explanation Session::explain(const machine::Incident& incident) const {
  const auto& lexicon = handshake_.collector().lexicon();
  const auto meaning = incident.kind == machine::IncidentKind::Alarm ? lexicon.alarm(dialect(), incident.code)
                                                                     : lexicon.error(dialect(), incident.code);
  return machine::explain(incident, meaning, knowledge());
}

std::optional<machine::Explanation> Session::alarm_explanation() const {
  if (!incidents_.alarm()) return std::nullopt;
  return explain(*incidents_.alarm());
}

}  // namespace kerf::session
