// What a controller says: lines that its answers make room for, and what each message means to the parts.

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/base/overloaded.hpp"
#include "sender/machine/lexicon.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::OwedLine;
using streaming::Purpose;
using vocabulary::MachineState;

/// Part of the job: it may move the machine, or change how later lines are read.
bool belongs_to_job(Purpose purpose) {
  return purpose == Purpose::JobLine || purpose == Purpose::JobSync || purpose == Purpose::ClearLatch;
}

}  // namespace

void Session::on_bytes(Instant now, std::string_view bytes) {
  outbox_.lines += feed_ahead(now, bytes);
  catch_up();
}

std::string Session::feed_ahead(Instant now, std::string_view bytes) {
  catch_up();
  std::string lines;
  if (!open_) return lines;
  handshake_.on_bytes(bytes);
  auto messages = reader_.read(bytes);
  if (!may_feed_ahead(now, messages)) {
    for (const auto& received : messages) {
      handle(now, received);
      follow_parts(now);
    }
    // Not before all of it is read: an `ok` makes room for a line that a welcome behind it forbids.
    pump(now);
    return lines;
  }
  ahead_ = Ahead{.at = now, .messages = std::move(messages)};
  for (std::size_t count = 0; count < ahead_->messages.size(); ++count) ahead_->answered.push_back(*streamer_.settle());
  ahead_->sent = streamer_.pump(now, lines);
  return lines;
}

// Lines of a running job were taken, and nothing else was said: whatever follows from that, the next lines may go.
bool Session::may_feed_ahead(Instant now, const std::vector<protocol::ReceivedMessage>& messages) const {
  const auto is_ok = [](const auto& received) { return std::holds_alternative<protocol::Ok>(received.message); };
  const auto is_job_line = [](const OwedLine& line) { return line.purpose == Purpose::JobLine; };
  const auto& owed = ledger().owed();
  const auto count = static_cast<std::ptrdiff_t>(messages.size());
  return has_job() && job_->state().phase == job::JobPhase::Running && is_ready() && !changes_settings() &&
         !snapshot().pendant_in_control && stall_.proof() == job::StallProof::NotAsked && outbox_.realtime.empty() &&
         outbox_.lines.empty() && gate_.verdict(now) == GateVerdict::Open && std::cmp_less_equal(count, owed.size()) &&
         std::ranges::all_of(messages, is_ok) && std::all_of(owed.begin(), owed.begin() + count, is_job_line);
}

void Session::catch_up() {
  if (!ahead_) return;
  const Ahead ahead = std::move(*ahead_);
  ahead_.reset();
  // An event for each line that was taken and each that left, and a few that follow from them.
  constexpr std::size_t kOthers = 4;
  outbox_.events.reserve(outbox_.events.size() + ahead.messages.size() + ahead.sent.size() + kOthers);
  for (std::size_t count = 0; count < ahead.messages.size(); ++count) {
    take_in(ahead.at, ahead.messages[count], ahead.answered[count]);
  }
  on_sent(ahead.at, ahead.sent);
  settle_everything(ahead.at);
}

void Session::handle(Instant now, const protocol::ReceivedMessage& received) {
  std::optional<OwedLine> answers;
  if (protocol::is_answer(received.message) && !reset_pending_until_) answers = streamer_.settle();
  take_in(now, received, std::move(answers));
}

void Session::take_in(Instant now, const protocol::ReceivedMessage& received, std::optional<OwedLine> answers) {
  const MachineState before = snapshot().state;
  std::optional<machine::Snapshot> before_alarm;
  if (std::holds_alternative<protocol::AlarmRaised>(received.message)) before_alarm = snapshot();
  const bool for_kerf = is_for_kerf(received.message);
  model_.fold(now, received.message);
  if (std::holds_alternative<protocol::ParserState>(received.message)) on_parser_state(now);
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

void Session::on_answer(Instant now, const std::optional<OwedLine>& line, int error_code) {
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
  if (has_job() && belongs_to_job(line->purpose)) path_.on_answer(line->file_line, error_code);
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
      tool_work_.on_answer();
      if (error_code == 0) {
        on_operator_line_accepted(now, line->text);
      } else if (tool_work_.is_returning()) {
        tool_work_.set_returning(false);
        streamer_.drop_queued(Purpose::Operator);
      }
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

void Session::on_sent(Instant now, const std::vector<OwedLine>& lines) {
  for (const OwedLine& line : lines) {
    if (line.purpose != Purpose::Question) gate_.on_activity(now);
    if (has_job() && belongs_to_job(line.purpose)) path_.on_sent(line.file_line, line.text);
    tell(LineSent{.purpose = line.purpose, .file_line = line.file_line, .text = line.text});
  }
}

}  // namespace kerf::session
