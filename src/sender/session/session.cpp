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

/// May move the machine, or change how it reads later lines.
bool acts(Purpose purpose) {
  return purpose != Purpose::Question && purpose != Purpose::Setting;
}

}  // namespace

Session::Session(SessionOptions options)
    : options_(options),
      handshake_({.reset_policy = options.reset_policy, .enumerate = options.enumerate, .baud = options.link.baud}) {
  streamer_.configure(kCautiousWindow, streaming::SoloPolicy::EveryLine);
}

void Session::on_open(Instant now, const machine::LinkOpening& opening) {
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

void Session::on_bytes(Instant now, std::string_view bytes) {
  if (!open_) return;
  handshake_.on_bytes(bytes);
  for (const auto& received : reader_.read(bytes)) {
    handle(now, received);
    follow_parts(now);
  }
  // Not before all of it is read: an `ok` makes room for a line that a welcome behind it forbids.
  pump(now);
}

void Session::handle(Instant now, const protocol::ReceivedMessage& received) {
  const MachineState before = snapshot().state;
  std::optional<machine::Snapshot> before_alarm;
  if (std::holds_alternative<protocol::AlarmRaised>(received.message)) before_alarm = snapshot();
  const bool for_kerf = is_for_kerf(received.message);
  model_.fold(now, received.message);
  if (std::holds_alternative<protocol::ParserState>(received.message)) on_parser_state(now);
  std::optional<streaming::OwedLine> answers;
  if (protocol::is_answer(received.message) && !reset_pending_until_) answers = streamer_.settle();
  tell(LineReceived{.message = received.message, .raw = received.raw, .answers = answers, .for_kerf = for_kerf});
  std::visit(base::Overloaded{
                 [&](const protocol::Ok&) { on_answer(now, answers, 0); },
                 [&](const protocol::ErrorAnswer& error) { on_answer(now, answers, error.code); },
                 [&](const protocol::StatusReport&) { on_report(now, before); },
                 [&](const protocol::Welcome&) { on_welcome(now); },
                 [&](const protocol::AlarmRaised& alarm) { on_alarm(now, alarm.code, *before_alarm); },
                 [&](const protocol::SettingValue& setting) {
                   const auto id = handshake_.collector().id_of(setting.id);
                   if (changes_settings() && id == setting.id) settings_change_->on_value(id, setting.value);
                 },
                 [&](const protocol::StartupLine& line) {
                   if (changes_settings()) settings_change_->on_value("N" + std::to_string(line.index), line.block);
                 },
                 [](const auto&) {},
             },
             received.message);
  handshake_.on_message(now, received.message, received.raw, snapshot());
}

void Session::on_answer(Instant now, const std::optional<streaming::OwedLine>& line, int error_code) {
  if (!line) return;
  gate_.on_activity(now);
  if (error_code != 0 && line->purpose != Purpose::Proof && stall_.proof() == job::StallProof::Asked) {
    on_line_end_lost(now, *line);
    return;
  }
  stall_.on_progress(now);
  on_jog_answered(*line);
  if (error_code == 0) {
    model_.on_line_accepted(line->text);
    incidents_.on_accepted(*line);
  }
  if (line->purpose != Purpose::Question) refresh_.on_change(now);
  if (has_job() && acts(line->purpose)) path_.on_answer(line->file_line, error_code);
  std::string meaning;
  if (error_code != 0) {
    const auto& known = handshake_.collector();
    meaning = sentence_of(known.lexicon().error(known.dialect(), error_code));
  }
  bool latched_repeat = false;
  switch (line->purpose) {
    case Purpose::JobLine:
      if (!has_job()) break;
      latched_repeat = job_->on_answer(now, {.file_line = line->file_line,
                                             .file_offset_after = line->file_offset_after,
                                             .text = line->text,
                                             .error_code = error_code,
                                             .meaning = meaning});
      tell_program_messages(line->file_line);
      break;
    case Purpose::JobSync:
      if (has_job()) job_->on_sync_answered(now);
      break;
    case Purpose::Question: handshake_.on_answer(now, error_code); break;
    case Purpose::Setting:
      if (changes_settings()) settings_change_->on_answer(now, error_code, meaning);
      break;
    case Purpose::Operator:
      if (error_code == 0) on_operator_line_accepted(now, line->text);
      break;
    case Purpose::ClearLatch:
    case Purpose::Proof: break;
  }
  if (error_code == 0) return;
  tell(LineRefused{
      .purpose = line->purpose,
      .refusal = {.file_line = line->file_line, .text = line->text, .code = error_code, .meaning = std::move(meaning)},
      .latched_repeat = latched_repeat,
      .explanation = explain(incidents_.refused(error_code, *line, snapshot()))});
  // Otherwise the next line would be refused on behalf of this one (protocol.md 6.4).
  const bool is_own_question = line->purpose == Purpose::Question && is_ready();
  const bool by_hand = line->purpose == Purpose::Operator || line->purpose == Purpose::Setting;
  if ((by_hand || is_own_question) && dialect().error_latch) {
    streamer_.enqueue(Purpose::ClearLatch, "");
  }
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
  job_->on_snapshot(now, snapshot(), ledger().empty() ? std::string_view{} : ledger().oldest().text);
  follow_path(now, asked);
  if (has_job()) watch_stall(now);
  if (has_job()) tell(JobProgressed{job_->state()});
}

void Session::on_welcome(Instant now) {
  const bool asked = reset_pending_until_.has_value();
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
  if (ledger().empty()) stall_.on_progress(now);
  for (auto& line : streamer_.pump(now, outbox_.lines)) {
    if (line.purpose != Purpose::Question) gate_.on_activity(now);
    if (has_job() && acts(line.purpose)) path_.on_sent(line.file_line, line.text);
    tell(LineSent{.purpose = line.purpose, .file_line = line.file_line, .text = std::move(line.text)});
  }
}

void Session::advance_to(Instant now) {
  if (!open_) return;
  handshake_.advance_to(now, snapshot());
  if (has_job()) job_->advance_to(now);
  stop_.advance_to(now);
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
  return std::min({deadline, pendant_.next_deadline(), start_until_});
}

Outbox Session::take_outbox() {
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
