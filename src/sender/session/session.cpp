#include "sender/session/session.hpp"

#include <algorithm>
#include <chrono>

#include "common/base/overloaded.hpp"
#include "sender/machine/handshake_sentences.hpp"
#include "sender/machine/lexicon.hpp"
#include "sender/machine/rest.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using machine::HandshakeStage;
using streaming::Purpose;
using vocabulary::MachineState;
using vocabulary::Realtime;

/// Before anything is known: less than the smallest receive buffer, one line at a time.
constexpr std::size_t kCautiousWindow = 80;
constexpr Duration kResetPatience = 3s;

streaming::SoloPolicy solo_policy_of(vocabulary::Firmware firmware) {
  switch (firmware) {
    // Neither loses received bytes while it stores (protocol.md 6.5, 10 row 31).
    case vocabulary::Firmware::GrblHal:
    case vocabulary::Firmware::Rabbit: return streaming::SoloPolicy::DollarLines;
    default: return streaming::SoloPolicy::StoredWritesToo;
  }
}

}  // namespace

Session::Session(SessionOptions options)
    : options_(options),
      handshake_({.reset_policy = options.reset_policy, .enumerate = options.enumerate, .baud = options.link.baud}) {
  streamer_.configure(kCautiousWindow, streaming::SoloPolicy::EveryLine);
}

void Session::on_open(Instant now, const machine::LinkOpening& opening) {
  catch_up();
  open_ = true;
  reader_.reset();
  model_.forget();
  streamer_.configure(kCautiousWindow, streaming::SoloPolicy::EveryLine);
  streamer_.pause(false);
  reset_pending_until_.reset();
  poller_.stop();
  settings_change_.reset();
  recalled_.reset();
  settings_drift_.clear();
  refresh_.forget();
  pendant_.forget();
  incidents_.forget();
  incidents_.clear_alarm();
  parser_report_asked_ = automatic_reports_asked_ = false;
  handshake_.on_open(now, opening);
  settle_everything(now);
}

void Session::on_closed(Instant now, LinkLoss) {
  catch_up();
  if (!open_) return;
  open_ = false;
  strike_out();
  for (const Purpose purpose :
       {Purpose::Operator, Purpose::Question, Purpose::ClearLatch, Purpose::JobSync, Purpose::Setting}) {
    streamer_.drop_queued(purpose);
  }
  poller_.stop();
  refresh_.forget();
  pendant_.forget();
  reset_pending_until_.reset();
  stop_.end();
  handshake_.on_closed(now);
  if (has_job()) job_->on_link_closed(now);
  if (changes_settings()) settings_change_->interrupt("the link was closed");
  settle_everything(now);
  outbox_.realtime.clear();
  outbox_.lines.clear();
}

void Session::on_report(Instant now, MachineState before) {
  const ReportFacts facts{
      .moving = snapshot().state != MachineState::Idle && !machine::is_at_rest(snapshot()),
      .pendant = snapshot().pendant_in_control,
      .automatic = std::chrono::milliseconds{options_.automatic_reports ? snapshot().auto_report_ms.value_or(0) : 0}};
  const std::optional<Instant> asked = poller_.asked_since();
  if (poller_.on_report(now, facts)) {
    tell(LinkAnswering{});
    refresh_.on_doubt();
  }
  follow_pendant(now);
  on_alarm_state();
  tell(StatusReported{.before = before, .after = snapshot().state});
  gate_.on_report(now, snapshot(), has_job() || !ledger().empty());
  if (gate_.take_notice() && is_ready()) {
    tell(ControllerBusy{.state = snapshot().state, .pendant = false, .sentence = machine::busy_sentence(snapshot())});
  }
  if (changes_settings()) settings_change_->on_report(now, snapshot());
  stop_.on_snapshot(now, snapshot());
  if (!has_job()) return;
  const bool was_at_tool_change = is_at_tool_change();
  job_->on_snapshot(now, snapshot(), ledger().empty() ? std::string_view{} : ledger().oldest().text);
  path_.look_for_rest(now, snapshot(), ledger().empty());
  follow_tool_work(now);
  // Until the tool is in, the operator may have moved the machine.
  if (!was_at_tool_change && !is_at_tool_change()) follow_path(now, asked);
  if (has_job()) watch_stall(now);
  if (has_job()) tell(JobProgressed{job_->state()});
}

void Session::on_welcome(Instant now) {
  const bool asked = reset_pending_until_.has_value();
  const bool lines_on_their_way = !asked && has_job() && ledger().owes(Purpose::JobLine);
  reset_pending_until_.reset();
  streamer_.pause(false);
  strike_out();
  stop_.end();
  cancels_owed_jogs_ = false;
  if (!asked) model_.on_power_doubt();
  incidents_.forget();
  if (has_job()) job_->on_welcome(now);
  if (changes_settings()) settings_change_->interrupt("the controller restarted");
  if (!is_ready()) return;
  tell(ControllerRestarted{.asked = asked});
  poller_.stop();
  handshake_.restart(now, asked);
  if (lines_on_their_way) drop_lines_of_fresh_controller(now);
}

// What reaches it behind its start it would execute with default modes: a line without a motion word is a rapid.
void Session::drop_lines_of_fresh_controller(Instant now) {
  if (options_.reset_policy == machine::ResetPolicy::Never) return;
  tell(ControllerReset{
      "Lines of the job were on their way when the controller restarted: it is reset once more, so that "
      "none of them moves the machine."});
  reset_controller(now);
}

void Session::on_alarm(Instant now, int code, const machine::Snapshot& before) {
  const auto& known = handshake_.collector();
  const auto fact = known.lexicon().alarm(known.dialect(), code);
  incidents_.on_alarm(code, before, ledger(), reset_pending_until_.has_value());
  tell(AlarmRaised{.code = code, .title = fact.title, .text = fact.text, .explanation = explain(*incidents_.alarm())});
  if (has_job()) job_->on_alarm(now, code, sentence_of(fact));
  // A critical alarm reads no more lines until the reset, and that drops them (protocol.md 4.4).
  if (snapshot().reset_required) strike_out();
}

void Session::strike_out() {
  auto lost = streamer_.strike_out();
  if (lost.empty()) return;
  const auto is_job_line = [](const streaming::OwedLine& line) { return line.purpose == Purpose::JobLine; };
  const auto first = std::ranges::find_if(lost, is_job_line);
  if (has_job() && first != lost.end()) {
    job_->on_lines_lost(first->file_line, static_cast<std::uint32_t>(std::ranges::count_if(lost, is_job_line)));
  }
  tell(LinesLost{std::move(lost)});
}

void Session::reset_controller(Instant now) {
  strike_out();
  // Realtime bytes go first: behind this one those lines would be the first that the controller reads.
  outbox_.lines.clear();
  streamer_.pause(true);
  reset_pending_until_ = now + kResetPatience;
  send_byte(Realtime::SoftReset);
}

void Session::settle_everything(Instant now) {
  follow_parts(now);
  pump(now);
}

void Session::follow_parts(Instant now) {
  follow_handshake(now);
  // First what the job says: after a refusal not one line more may leave.
  follow_job(now);
  follow_stop(now);
  follow_settings(now);
  begin_waiting_job(now);
  refresh(now);
  if (outbox_.realtime.find_first_of("~\x81") != std::string::npos) gate_.on_activity(now);
}

void Session::follow_handshake(Instant now) {
  for (const auto& order : handshake_.take_orders()) obey_handshake(now, order);
}

void Session::obey_handshake(Instant now, const machine::HandshakeOrder& order) {
  std::visit(base::Overloaded{
                 [&](const machine::StageChange& change) { tell(HandshakeMoved{change}); },
                 [&](const machine::SendByte& send) {
                   if (send.byte == static_cast<std::uint8_t>(Realtime::SoftReset))
                     reset_controller(now);
                   else
                     send_byte(static_cast<Realtime>(send.byte));
                 },
                 [&](const machine::AskLine& ask) { streamer_.enqueue(Purpose::Question, ask.text); },
                 [&](const machine::ForgetQuestions&) {
                   streamer_.drop_queued(Purpose::Question);
                   strike_out();
                 },
                 [&](const machine::Remark& remark) { tell(HandshakeNoted{remark.sentence}); },
                 [&](const machine::ResetNotice& notice) { tell(ControllerReset{notice.reason}); },
                 [&](const machine::Identified& known) { tell(FirmwareIdentified{known.identity}); },
                 [&](const machine::BusyNotice& busy) {
                   tell(ControllerBusy{.state = busy.state, .pendant = busy.pendant, .sentence = busy.sentence});
                 },
                 [&](const machine::Success& success) {
                   model_.speak(handshake_.collector().dialect());
                   const auto usable = static_cast<std::size_t>(std::max(capabilities().buffers.rx_usable, 1));
                   streamer_.configure(streaming::window_bytes(usable, options_.link),
                                       solo_policy_of(capabilities().family));
                   refresh_.on_change(now);
                   poller_.start(now, poll_periods(options_.link));
                   gate_.open(now);
                   tell(ControllerFound{success.sentence});
                   tell_drift();
                 },
                 [&](const machine::Failure& failure) {
                   tell(HandshakeFailed{.failure = failure.failure, .sentence = failure.sentence});
                 },
             },
             order);
}

void Session::pump(Instant now) {
  if (!open_ || snapshot().pendant_in_control) return;
  // Before that the handshake looks after it.
  if (is_ready() && gate_.verdict(now) != GateVerdict::Open) return;
  if (tool_work_.must_wait()) return;
  if (ledger().empty()) {
    stall_.on_progress(now);
    link_doubt_.on_account_settled();
  }
  // An answer in a hold may be the last word of a controller that somebody resets: a line that followed it would be the
  // first one that it reads after its start, with default modes.
  streamer_.let_source_wait(has_job() && job_->stands());
  on_sent(now, streamer_.pump(now, outbox_.lines));
}

void Session::advance_to(Instant now) {
  catch_up();
  if (!open_) return;
  handshake_.advance_to(now, snapshot());
  if (has_job()) job_->advance_to(now);
  stop_.advance_to(now);
  tool_work_.advance_to(now);
  if (changes_settings()) settings_change_->advance_to(now);
  if (reset_pending_until_ && now >= *reset_pending_until_) {
    reset_pending_until_.reset();
    streamer_.pause(false);
  }
  poll(now);
  if (pendant_.take_failure(now)) refuse(Refused::ControlNotGiven, not_given_back_sentence(options_.link.network));
  settle_everything(now);
}

Instant Session::next_deadline() const {
  if (!open_) return kNever;
  Instant deadline =
      std::min({handshake_.next_deadline(), reset_pending_until_.value_or(kNever), stop_.next_deadline()});
  if (has_job()) deadline = std::min(deadline, job_->next_deadline());
  if (changes_settings()) deadline = std::min(deadline, settings_change_->next_deadline());
  const bool is_storing = changes_settings() && settings_change_->is_storing();
  if (is_ready() && !is_storing) deadline = std::min({deadline, poller_.next_deadline(), refresh_.next_deadline()});
  return std::min({deadline, tool_work_.next_deadline(), pendant_.next_deadline(), start_until_});
}

Outbox Session::take_outbox() {
  catch_up();
  return std::exchange(outbox_, {});
}

SessionPhase Session::phase() const {
  if (reset_pending_until_) return SessionPhase::Connecting;
  switch (handshake_.stage()) {
    case HandshakeStage::Closed: return SessionPhase::Closed;
    case HandshakeStage::PendantWait:
    case HandshakeStage::BusyWait: return SessionPhase::Waiting;
    case HandshakeStage::Ready: return SessionPhase::Ready;
    case HandshakeStage::Failed: return SessionPhase::Failed;
    default: return SessionPhase::Connecting;
  }
}

}  // namespace kerf::session
