// Commands of the operator: whether they can be obeyed, and by whom.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "common/base/text.hpp"
#include "sender/machine/realtime_alphabet.hpp"
#include "sender/machine/rest.hpp"
#include "sender/session/refusals.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {
namespace {

using streaming::Purpose;
using vocabulary::MachineState;
using vocabulary::Realtime;

/// A line by hand may take its time (a jog), but whoever started a job should not be surprised by it later.
constexpr Duration kLongestWaitForStart = std::chrono::seconds{5};

}  // namespace

void Session::submit(Instant now, const Command& command) {
  catch_up();
  if (!open_) {
    refuse(Refused::NotConnected);
    return;
  }
  std::visit([&](const auto& known) { obey(now, known); }, command);
  settle_everything(now);
}

void Session::refuse(Refused reason, std::string detail) {
  tell(CommandRefused{.reason = reason, .sentence = detail.empty() ? sentence_of(reason) : std::move(detail)});
}

std::size_t Session::longest_line_taken() const {
  const auto& buffers = capabilities().buffers;
  return static_cast<std::size_t>(std::max(1, std::min(buffers.line_length, buffers.rx_usable - 1)));
}

std::optional<Refused> Session::why_nothing(Instant now) const {
  if (snapshot().pendant_in_control) return Refused::PendantInControl;
  if (!is_ready()) return Refused::NotIdentified;
  if (has_job() || waiting_start_) return Refused::JobUnderWay;
  if (changes_settings()) return Refused::SettingsUnderWay;
  if (gate_.sees_foreign_motion()) return Refused::ForeignMotion;
  // With a line owed, that line may be the reason: Grbl says nothing while it homes.
  if (gate_.verdict(now) == GateVerdict::Blind && ledger().empty()) return Refused::NotAnswering;
  return std::nullopt;
}

std::optional<Refused> Session::why_no_job(Instant now) const {
  if (const auto reason = why_nothing(now)) return reason;
  if (snapshot().state == MachineState::Alarm) return Refused::MachineInAlarm;
  const bool idle = snapshot().state == MachineState::Idle || snapshot().state == MachineState::Check;
  if (!idle || !snapshot().controller_file.empty()) return Refused::MachineNotIdle;
  if (poller_.is_silent(now)) return Refused::NotAnswering;
  return std::nullopt;
}

void Session::obey(Instant now, const StartJob& command) {
  if (const auto reason = why_no_job(now)) {
    refuse(*reason);
    return;
  }
  const JobFeed feed{command.program, dialect(), snapshot().texts_keep_realtime.value_or(false),
                     capabilities().features.tool_change, command.options};
  const auto longest = command.program->longest_line(feed.form().keeps_messages);
  if (longest.length > longest_line_taken()) {
    refuse(Refused::LineTooLong, command.program->name() + ", line " + std::to_string(longest.number) + " has " +
                                     std::to_string(longest.length) + " characters and this controller takes " +
                                     std::to_string(longest_line_taken()) + ": split it in the CAM program.");
    return;
  }
  if (streamer_.is_idle() && !snapshot().parser_state_is_old && !snapshot().offsets_are_old) {
    begin_job(now, command);
    return;
  }
  // Whatever is on its way may change more; the questions come behind it.
  job_.reset();
  job_state_.reset();
  waiting_start_ = command;
  start_until_ = now + kLongestWaitForStart;
  streamer_.enqueue(Purpose::Question, "$G");
  streamer_.enqueue(Purpose::Question, "$#");
}

void Session::begin_waiting_job(Instant now) {
  if (!waiting_start_) return;
  const bool is_late = now >= start_until_;
  if (is_ready() && !streamer_.is_idle() && !is_late) return;
  const StartJob command = *std::exchange(waiting_start_, std::nullopt);
  start_until_ = kNever;
  if (is_late) streamer_.drop_queued(Purpose::Question);
  const auto reason = is_late ? std::optional{Refused::NotAnswering} : why_no_job(now);
  if (reason) {
    refuse(*reason);
    return;
  }
  begin_job(now, command);
}

void Session::begin_job(Instant now, const StartJob& command) {
  if (dialect().error_latch) streamer_.enqueue(Purpose::ClearLatch, "");
  incidents_.start_from(snapshot(), capabilities(), dialect());
  feed_.emplace(command.program, dialect(), snapshot().texts_keep_realtime.value_or(false),
                capabilities().features.tool_change, command.options);
  streamer_.feed_by(command.options.flow);
  streamer_.feed_from(feed_->lines_from(1));
  link_doubt_ = {};
  path_.begin(now, incidents_.reader(), snapshot(), capabilities(), options_.machine_clock);
  const job::JobTerms terms{
      .has_error_latch = dialect().error_latch, .on_error = command.options.on_error, .flow = feed_->flow()};
  job_.emplace(now, *command.program, terms, command.timeline);
  job_state_ = job_->state();
  tell(JobStarted{command.program->name()});
  tell_program_messages(0);
}

std::optional<Refused> Session::why_no_line(Instant now, std::string_view text) const {
  const auto reason = is_at_tool_change() ? why_no_tool_work(now) : why_nothing(now);
  if (reason) return reason;
  if (is_at_tool_change() && !ToolWork::why_not(text).empty()) return Refused::NotAtToolChange;
  if (snapshot().reset_required) return Refused::MachineInAlarm;
  if (poller_.is_silent(now) && !may_be_silent()) return Refused::NotAnswering;
  if (why_text_is_eaten(text)) return Refused::RealtimeInLine;
  if (crashes_controller(text)) return Refused::NeverSent;
  if (text.size() > longest_line_taken()) return Refused::LineTooLong;
  return std::nullopt;
}

std::optional<std::string> Session::why_text_is_eaten(std::string_view text) const {
  return machine::why_eaten(text, handshake_.collector().dialect(), snapshot().texts_keep_realtime.value_or(false));
}

void Session::obey(Instant now, const SendLine& command) {
  if (const auto reason = why_no_line(now, command.text)) {
    const bool is_eaten = reason == Refused::RealtimeInLine;
    refuse(*reason, is_eaten                             ? why_text_is_eaten(command.text).value_or("")
                    : reason == Refused::NotAtToolChange ? ToolWork::why_not(command.text)
                                                         : std::string{});
    return;
  }
  if (is_at_tool_change()) {
    send_by_hand(now, command.text);
    return;
  }
  last_line_jogs_ = streaming::is_jog(command.text);
  if (streamer_.is_idle() && snapshot().state == MachineState::Idle) {
    incidents_.start_from(snapshot(), capabilities(), dialect());
  }
  streamer_.enqueue(Purpose::Operator, command.text);
}

void Session::obey(Instant now, const Unlock&) {
  obey(now, SendLine{"$X"});
}

void Session::obey(Instant now, const Home&) {
  obey(now, SendLine{"$H"});
}

void Session::obey(Instant now, const Jog& command) {
  obey(now, SendLine{"$J=" + command.words});
}

void Session::obey(Instant now, const SendRealtime& command) {
  if (is_never_sent(command.byte)) {
    refuse(Refused::NeverSent);
    return;
  }
  const bool takes_control = static_cast<Realtime>(command.byte) == Realtime::MpgModeToggle;
  if (snapshot().pendant_in_control && !stops_or_asks(command.byte) && !takes_control) {
    refuse(Refused::PendantInControl);
    return;
  }
  switch (static_cast<Realtime>(command.byte)) {
    case Realtime::SoftReset: obey(now, SoftReset{}); return;
    case Realtime::FeedHold: obey(now, HoldJob{}); return;
    case Realtime::JogCancel: obey(now, CancelJog{}); return;
    case Realtime::CycleStart:
      if (has_job())
        obey(now, ResumeJob{});
      else
        send_byte(Realtime::CycleStart);
      return;
    case Realtime::Stop:
      // It empties the receive buffer (protocol.md 2): StopJob does the same and keeps the account.
      if (has_job())
        job_->stop(now);
      else
        send_byte(Realtime::Stop);
      return;
    case Realtime::MpgModeToggle: obey(now, TakeControl{}); return;
    default: send_byte(static_cast<Realtime>(command.byte)); return;
  }
}

void Session::obey(Instant now, const TakeControl&) {
  if (!snapshot().pendant_in_control) {
    refuse(Refused::NoPendant);
    return;
  }
  if (!acts_on(dialect().firmware, Realtime::MpgModeToggle)) {
    refuse(Refused::ControlNotGiven);
    return;
  }
  send_byte(Realtime::MpgModeToggle);
  pendant_.on_asked_back(now);
}

}  // namespace kerf::session
