#include "sender/machine/handshake.hpp"

#include <chrono>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/protocol/decode.hpp"
#include "sender/machine/handshake_sentences.hpp"
#include "sender/machine/rest.hpp"

namespace kerf::machine {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;
using vocabulary::Realtime;

constexpr Duration kListen = 500ms;
/// An Uno's bootloader waits a second before it starts Grbl, and is better not spoken to meanwhile (optiboot).
constexpr Duration kListenWhileBooting = 2500ms;
/// A welcome is followed at once by unlock messages and startup results; grblHAL's simulator loses what comes in
/// meanwhile.
constexpr Duration kListenAfterWelcome = 300ms;
constexpr Duration kFullReportPatience = 250ms;
constexpr Duration kAskEvery = 500ms;
constexpr Duration kSilentAfter = 2s;
/// Longer than the alarm delay of 500 ms plus boot.
constexpr Duration kWelcomePatience = 2500ms;
constexpr Duration kAnswerPatience = 2s;
/// Counted from the last row of an answer; Rabbit pauses 100 ms in it (protocol.md 5).
constexpr Duration kQuestionPatience = 3s;
constexpr Duration kBusyAskEvery = 500ms;
/// The report that gives the machine back comes once and may get lost.
constexpr Duration kPendantAskEvery = 2s;
constexpr Duration kSilentAskEvery = 2s;
/// A machine that was busy may be between two lines of somebody else's job.
constexpr Duration kRestAfterBusy = 1s;
/// Older reports say nothing about whether a line may be sent.
constexpr Duration kKnowledge = 400ms;
/// The first question behind those that tell of the firmware.
constexpr std::string_view kAfterIdentity = "$G";
constexpr int kMostAskedInVain = 6;
constexpr int kMostRestarts = 5;
/// Ends a half line in such a way that no firmware executes it: the bracket may close a comment (or is dropped, by
/// Rabbit), and none has a word `=` (protocol.md 6.3). An empty line would complete it.
constexpr std::string_view kSpoiler = ")=";

/// Lines are read there, and nothing moves.
bool takes_lines(const Snapshot& snapshot) {
  const bool rests = snapshot.state == MachineState::Idle || snapshot.state == MachineState::Alarm ||
                     snapshot.state == MachineState::Check;
  return rests && snapshot.controller_file.empty();
}

/// `<Idle,MPos:0.000,0.000,0.000,WPos:…>`
bool is_older_report(std::string_view line) {
  return line.starts_with('<') && (line.contains(",MPos:") || line.contains(",WPos:"));
}

}  // namespace

bool Handshake::is_under_way() const {
  return stage_ != HandshakeStage::Closed && stage_ != HandshakeStage::Ready && stage_ != HandshakeStage::Failed;
}

void Handshake::enter(Instant now, HandshakeStage stage, Instant deadline, Why why) {
  if (stage != stage_) {
    orders_.emplace_back(
        StageChange{.at = now, .from = stage_, .to = stage, .cause = why.cause, .evidence = std::move(why.evidence)});
  }
  stage_ = stage;
  deadline_ = deadline;
}

void Handshake::send(Realtime byte) {
  sent_ += static_cast<char>(byte);
  orders_.emplace_back(SendByte{static_cast<std::uint8_t>(byte)});
}

void Handshake::ask_status(Instant now, Duration patience) {
  send(Realtime::StatusQuery);
  if (!asked_at_) asked_at_ = now;
  deadline_ = now + patience;
}

void Handshake::on_open(Instant now, const LinkOpening& opening) {
  *this = Handshake(options_);
  if (!opening.sentence.empty()) orders_.emplace_back(Remark{opening.sentence});
  const Duration patience = opening.may_restart ? kListenWhileBooting : kListen;
  enter(now, HandshakeStage::Listening, now + patience, {HandshakeCause::LinkOpened, opening.sentence});
}

void Handshake::on_closed(Instant now) {
  if (is_under_way()) {
    fail(now, HandshakeFailure::LinkLost, "The link was closed before the controller was known.",
         {HandshakeCause::LinkClosed});
  }
  enter(now, HandshakeStage::Closed, kNever, {HandshakeCause::LinkClosed});
}

void Handshake::restart(Instant now, bool asked) {
  quick_ = asked && capabilities_.complete;
  if (!quick_) collector_.forget();
  overheard_.forget();
  restarts_ = 0;
  reset_done_ = true;
  cleared_twice_ = false;
  listen_after_welcome(now, collector_.capabilities(false).welcome);
}

void Handshake::listen_after_welcome(Instant now, std::string_view line) {
  fresh_ = true;
  boots_ = 0;
  deaf_in_alarm_ = false;
  busy_told_ = MachineState::Unknown;
  waiting_line_.reset();
  orders_.emplace_back(ForgetQuestions{});
  enter(now, HandshakeStage::Listening, now + kListenAfterWelcome, {HandshakeCause::WelcomeCame, excerpt_of(line)});
}

void Handshake::on_operator_reset(Instant now) {
  if (stage_ == HandshakeStage::Closed || stage_ == HandshakeStage::Ready) return;
  reset_done_ = true;
  is_final_ = false;
  restarts_ = boots_ = 0;
  waiting_line_.reset();
  enter(now, HandshakeStage::ResetWait, now + kWelcomePatience, {HandshakeCause::OperatorReset});
}

void Handshake::on_bytes(std::string_view bytes) {
  if (is_under_way()) overheard_.hear(bytes);
}

void Handshake::on_message(Instant now, const protocol::Message& message, std::string_view raw, const Snapshot& after) {
  collector_.fold(message);
  if (stage_ == HandshakeStage::Closed || stage_ == HandshakeStage::Ready || is_final_) return;
  last_ = after;
  last_line_ = excerpt_of(raw);
  std::visit(base::Overloaded{
                 [&](const protocol::Welcome& welcome) { on_welcome(now, welcome); },
                 [&](const protocol::StatusReport& report) { on_report(now, report, after); },
                 [&](const protocol::Unrecognized&) { on_unrecognized(now, raw); },
                 [](const auto&) {},
             },
             message);
  const bool is_report = std::holds_alternative<protocol::StatusReport>(message);
  if (stage_ == HandshakeStage::Questioning && !is_report && !waiting_line_) deadline_ = now + kQuestionPatience;
}

void Handshake::on_welcome(Instant now, const protocol::Welcome& welcome) {
  if (welcome.version.starts_with("0.")) {
    give_up_for_good(now, too_old(welcome.line));
    return;
  }
  if (++restarts_ > kMostRestarts) {
    fail(now, HandshakeFailure::Restarting, restarting_sentence(), {HandshakeCause::WelcomeCame, last_line_});
    is_final_ = true;
    return;
  }
  listen_after_welcome(now, welcome.line);
}

void Handshake::on_unrecognized(Instant now, std::string_view raw) {
  if (stage_ == HandshakeStage::Failed) return;
  if (is_older_report(raw)) {
    give_up_for_good(now, too_old(raw));
    return;
  }
  const auto* row = find_stranger(raw);
  if (row == nullptr || row->certainty == Certainty::Alone) return;
  const bool boots = row->certainty == Certainty::Boot;
  if (!boots || ++boots_ > kMostRestarts) {
    give_up_for_good(now, verdict_on(*row, raw));
    return;
  }
  orders_.emplace_back(ForgetQuestions{});
  waiting_line_.reset();
  enter(now, HandshakeStage::Listening, now + kListenWhileBooting, {HandshakeCause::StrangerHeard, last_line_});
}

void Handshake::on_report(Instant now, const protocol::StatusReport& report, const Snapshot& after) {
  reported_ = true;
  asked_in_vain_ = 0;
  rest_known_at_.reset();
  if (takes_lines(after)) rest_known_at_ = asked_at_.value_or(now);
  asked_at_.reset();
  if (after.pendant_in_control) {
    wait_for_pendant(now, after);
    return;
  }
  switch (stage_) {
    case HandshakeStage::Failed: begin_asking(now, {HandshakeCause::ReportCame, last_line_}); return;
    case HandshakeStage::PendantWait: begin_asking(now, {HandshakeCause::PendantReleased, last_line_}); return;
    case HandshakeStage::Asking:
      if (plain_asked_ && !report.firmware) {
        judge(now, after);
      } else {
        plain_asked_ = true;
        ask_status(now, kAskEvery);
      }
      return;
    case HandshakeStage::BusyWait: judge(now, after); return;
    case HandshakeStage::Clearing:
    case HandshakeStage::Questioning:
      if (!takes_lines(after)) {
        orders_.emplace_back(ForgetQuestions{});
        wait_while_busy(now, after);
      } else if (waiting_line_) {
        send_line(now, *std::exchange(waiting_line_, std::nullopt));
      }
      return;
    default: return;
  }
}

void Handshake::begin_asking(Instant now, Why why) {
  asking_since_ = now;
  waiting_line_.reset();
  plain_asked_ = quick_ && !collector_.dialect().answers_full_status;
  enter(now, HandshakeStage::Asking, now + kFullReportPatience, std::move(why));
  if (plain_asked_)
    ask_status(now, kAskEvery);
  else
    send(Realtime::FullStatus);
}

void Handshake::ask_again(Instant now) {
  if (now - asking_since_ >= kSilentAfter) {
    give_up(now);
    return;
  }
  plain_asked_ = true;
  ask_status(now, kAskEvery);
}

void Handshake::give_up(Instant now) {
  const bool known = reported_ || collector_.family() != vocabulary::Firmware::Unknown;
  if (options_.reset_policy == ResetPolicy::WhenSilentToo && !reset_done_ && (known || overheard_.empty())) {
    reset(now, "Nothing answers on this link, so the controller is reset once to find out whether there is one.");
    return;
  }
  auto verdict = known ? fallen_silent() : verdict_on(overheard_, sent_, options_.baud);
  fail(now, verdict.failure, std::move(verdict.sentence), {HandshakeCause::NothingCame, overheard_.excerpt()});
}

void Handshake::give_up_for_good(Instant now, const Verdict& verdict) {
  fail(now, verdict.failure, verdict.sentence, {HandshakeCause::StrangerHeard, last_line_});
  is_final_ = true;
}

void Handshake::wait_for_pendant(Instant now, const Snapshot& snapshot) {
  if (stage_ == HandshakeStage::PendantWait) return;
  if (stage_ != HandshakeStage::Listening) orders_.emplace_back(ForgetQuestions{});
  waiting_line_.reset();
  orders_.emplace_back(BusyNotice{.state = snapshot.state, .pendant = true, .sentence = pendant_sentence()});
  enter(now, HandshakeStage::PendantWait, now + kPendantAskEvery, {HandshakeCause::PendantTook, last_line_});
}

void Handshake::judge(Instant now, const Snapshot& snapshot) {
  if (snapshot.state != MachineState::Alarm) deaf_in_alarm_ = false;
  if (!takes_lines(snapshot) || deaf_in_alarm_) {
    wait_while_busy(now, snapshot);
    return;
  }
  if (stage_ == HandshakeStage::BusyWait) {
    if (!resting_since_) resting_since_ = now;
    if (now - *resting_since_ < kRestAfterBusy) return;
  }
  empty_line_buffer(now, snapshot);
}

void Handshake::wait_while_busy(Instant now, const Snapshot& snapshot) {
  if (busy_told_ != snapshot.state) {
    busy_told_ = snapshot.state;
    orders_.emplace_back(BusyNotice{.state = snapshot.state, .pendant = false, .sentence = busy_sentence(snapshot)});
  }
  resting_since_.reset();
  waiting_line_.reset();
  enter(now, HandshakeStage::BusyWait, now + kBusyAskEvery, {HandshakeCause::MachineBusy, last_line_});
}

void Handshake::empty_line_buffer(Instant now, const Snapshot& snapshot) {
  busy_told_ = MachineState::Unknown;
  Why why{HandshakeCause::MachineAtRest, last_line_};
  if (fresh_) {
    clear(now, "", std::move(why));
  } else if (collector_.dialect().jog_cancel_flushes_rx) {
    // Drops a half line and the error latch, and nothing else (protocol.md 2).
    send(Realtime::JogCancel);
    clear(now, "", std::move(why));
  } else if (snapshot.state == MachineState::Idle && may_reset_at_rest()) {
    reset(now, "The machine is idle and is reset once, so that nothing an earlier program left behind gets executed.");
  } else {
    clear(now, std::string{kSpoiler}, std::move(why));
  }
}

void Handshake::reset(Instant now, std::string reason) {
  reset_done_ = true;
  waiting_line_.reset();
  orders_.emplace_back(ForgetQuestions{});
  orders_.emplace_back(ResetNotice{std::move(reason)});
  send(Realtime::SoftReset);
  enter(now, HandshakeStage::ResetWait, now + kWelcomePatience, {HandshakeCause::ResetNeeded, last_line_});
}

void Handshake::clear(Instant now, std::string line, Why why) {
  fresh_ = false;
  enter(now, HandshakeStage::Clearing, now + kAnswerPatience, std::move(why));
  // Ends a half line, clears grblHAL's error latch, and shows that lines are answered (protocol.md 1.6, 6.4).
  send_line(now, std::move(line));
}

void Handshake::send_line(Instant now, std::string line) {
  deadline_ = now + (stage_ == HandshakeStage::Clearing ? kAnswerPatience : kQuestionPatience);
  orders_.emplace_back(AskLine{std::move(line)});
}

void Handshake::ask_line(Instant now, std::string line) {
  if (rest_known_at_ && now - *rest_known_at_ <= kKnowledge) {
    send_line(now, std::move(line));
    return;
  }
  waiting_line_ = std::move(line);
  ask_status(now, kAskEvery);
}

void Handshake::on_answer(Instant now, int error_code) {
  question_repeated_ = false;
  if (stage_ == HandshakeStage::Clearing) {
    begin_questions(now);
    return;
  }
  if (stage_ != HandshakeStage::Questioning) return;
  if (error_code != 0 && collector_.dialect().error_latch && !latch_clearing_) {
    latch_clearing_ = true;
    ask_line(now, "");
    return;
  }
  latch_clearing_ = false;
  ask_next(now);
}

void Handshake::begin_questions(Instant now) {
  interview_.begin(quick_);
  latch_clearing_ = false;
  identity_told_ = quick_ || !options_.enumerate;
  enter(now, HandshakeStage::Questioning, now + kQuestionPatience, {HandshakeCause::LineAnswered, last_line_});
  ask_next(now);
}

void Handshake::ask_next(Instant now) {
  auto question = interview_.next(collector_);
  if (question == kAfterIdentity && !std::exchange(identity_told_, true)) {
    orders_.emplace_back(Identified{collector_.identity()});
  }
  if (question)
    ask_line(now, *std::move(question));
  else
    finish(now, true);
}

void Handshake::finish(Instant now, bool complete) {
  capabilities_ = collector_.capabilities(complete);
  const auto alarm = collector_.lexicon().alarm(collector_.dialect(), last_.alarm_code.value_or(0));
  orders_.emplace_back(Success{found_sentence(capabilities_, last_, alarm)});
  quick_ = false;
  const auto cause = complete ? HandshakeCause::LineAnswered : HandshakeCause::NothingCame;
  enter(now, HandshakeStage::Ready, kNever, {cause, last_line_});
}

void Handshake::recall(const Words& words) {
  if (stage_ != HandshakeStage::Questioning || words.identity.empty()) return;
  if (words.identity != collector_.identity()) return;
  for (const KeptAnswer& answer : words.answers) {
    for (const std::string& line : answer.lines) collector_.fold(protocol::decode(line));
    collector_.fold(protocol::Ok{});
  }
  interview_.pass_over(words);
}

void Handshake::refresh() {
  if (stage_ == HandshakeStage::Ready) capabilities_ = collector_.capabilities(capabilities_.complete);
}

void Handshake::learn(const protocol::SettingValue& setting) {
  collector_.fold(setting);
  refresh();
}

void Handshake::fail(Instant now, HandshakeFailure failure, std::string sentence, Why why) {
  orders_.emplace_back(ForgetQuestions{});
  orders_.emplace_back(Failure{.failure = failure, .sentence = std::move(sentence)});
  // A machine that homes, or that a pendant has, is silent for a while only.
  const bool may_speak_later = failure == HandshakeFailure::Silent;
  enter(now, HandshakeStage::Failed, may_speak_later ? now + kSilentAskEvery : kNever, std::move(why));
}

void Handshake::ask_in_vain(Instant now) {
  if (++asked_in_vain_ < kMostAskedInVain) {
    ask_status(now, kAskEvery);
    return;
  }
  auto verdict = fallen_silent();
  fail(now, verdict.failure, std::move(verdict.sentence), {HandshakeCause::NothingCame});
}

void Handshake::time_out_clearing(Instant now, const Snapshot& snapshot) {
  orders_.emplace_back(ForgetQuestions{});
  if (snapshot.state == MachineState::Alarm) {
    if (may_reset_at_rest()) {
      reset(now, "The machine is in alarm and answers no line: only a reset helps, and nothing moves.");
    } else {
      deaf_in_alarm_ = true;
      wait_while_busy(now, snapshot);
    }
    return;
  }
  if (!cleared_twice_) {
    cleared_twice_ = true;
    begin_asking(now, {HandshakeCause::NothingCame, "no answer to an empty line"});
    return;
  }
  is_final_ = true;
  fail(now, HandshakeFailure::LinesUnanswered, unanswered_sentence(snapshot),
       {HandshakeCause::NothingCame, "no answer to an empty line"});
}

void Handshake::time_out_question(Instant now) {
  orders_.emplace_back(ForgetQuestions{});
  const std::string question = interview_.asked().back();
  if (!std::exchange(question_repeated_, true)) {
    rest_known_at_.reset();
    ask_line(now, question);
    return;
  }
  if (interview_.asked().size() <= 1) {
    is_final_ = true;
    fail(now, HandshakeFailure::LinesUnanswered,
         "The controller does not answer the question who it is: reset it or try again.",
         {HandshakeCause::NothingCame, "no answer to " + question});
    return;
  }
  orders_.emplace_back(
      Remark{"The controller left " + question + " without an answer; its description is incomplete."});
  finish(now, false);
}

void Handshake::advance_to(Instant now, const Snapshot& snapshot) {
  if (now < deadline_) return;
  if (waiting_line_) {
    ask_in_vain(now);
    return;
  }
  switch (stage_) {
    case HandshakeStage::Listening:
      begin_asking(now, {HandshakeCause::NothingCame, fresh_ ? "quiet after the welcome" : "no welcome"});
      return;
    case HandshakeStage::Asking: ask_again(now); return;
    case HandshakeStage::BusyWait: ask_status(now, kBusyAskEvery); return;
    case HandshakeStage::Failed: ask_status(now, kSilentAskEvery); return;
    case HandshakeStage::PendantWait:
      send(Realtime::FullStatus);
      deadline_ = now + kPendantAskEvery;
      return;
    case HandshakeStage::ResetWait:
      // An E-stop input keeps grblHAL from resetting, and reports still come.
      if (reported_)
        begin_asking(now, {HandshakeCause::NothingCame, "no welcome after the reset"});
      else
        give_up(now);
      return;
    case HandshakeStage::Clearing: time_out_clearing(now, snapshot); return;
    case HandshakeStage::Questioning: time_out_question(now); return;
    default: deadline_ = kNever; return;
  }
}

std::vector<HandshakeOrder> Handshake::take_orders() {
  return std::exchange(orders_, {});
}

}  // namespace kerf::machine
