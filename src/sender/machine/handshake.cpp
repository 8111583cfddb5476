#include "sender/machine/handshake.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/base/text.hpp"
#include "common/vocabulary/realtime.hpp"

namespace kerf::machine {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;
using vocabulary::Realtime;

constexpr Duration kListen = 500ms;
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
constexpr int kMostRestarts = 5;
constexpr std::size_t kExcerpt = 60;

std::uint8_t byte_of(Realtime byte) {
  return static_cast<std::uint8_t>(byte);
}

bool is_report(const protocol::Message& message) {
  return std::holds_alternative<protocol::StatusReport>(message);
}

std::string busy_sentence(const Snapshot& snapshot) {
  if (!snapshot.controller_file.empty()) {
    return "The controller is running a file of its own (" + snapshot.controller_file +
           "); waiting until it has finished.";
  }
  const std::string state{vocabulary::name_of(snapshot.state)};
  switch (snapshot.state) {
    case MachineState::Door:
      return "The safety door is open or the machine waits behind it (" + state + "); close it and resume, or reset.";
    case MachineState::Hold: return "The machine is in feed hold, which Kerf did not start; resume or reset it.";
    case MachineState::Tool:
      return "The controller waits for a tool change that Kerf did not start; finish it or reset.";
    case MachineState::Sleep: return "The controller sleeps; only a reset wakes it.";
    default: return "The machine is moving (" + state + ") and Kerf did not start it; waiting until it stands still.";
  }
}

}  // namespace

void Handshake::enter(HandshakeStage stage, Instant deadline) {
  stage_ = stage;
  deadline_ = deadline;
}

void Handshake::on_open(Instant now) {
  collector_.forget();
  capabilities_ = {};
  fresh_ = reset_done_ = reported_ = quick_ = latch_clearing_ = cleared_twice_ = false;
  restarts_ = 0;
  strange_line_.clear();
  state_ = busy_told_ = MachineState::Unknown;
  enter(HandshakeStage::Listening, now + kListen);
}

void Handshake::on_closed() {
  const bool was_under_way =
      stage_ != HandshakeStage::Closed && stage_ != HandshakeStage::Ready && stage_ != HandshakeStage::Failed;
  if (was_under_way) fail(HandshakeFailure::LinkLost, "The link was closed before the controller was known.");
  enter(HandshakeStage::Closed, kNever);
}

void Handshake::restart(Instant now, bool asked) {
  quick_ = asked && capabilities_.complete;
  if (!quick_) collector_.forget();
  restarts_ = 0;
  reset_done_ = true;
  listen_after_welcome(now);
}

void Handshake::listen_after_welcome(Instant now) {
  fresh_ = true;
  busy_told_ = MachineState::Unknown;
  orders_.emplace_back(ForgetQuestions{});
  enter(HandshakeStage::Listening, now + kListenAfterWelcome);
}

void Handshake::on_operator_reset(Instant now) {
  if (stage_ == HandshakeStage::Closed || stage_ == HandshakeStage::Ready) return;
  reset_done_ = true;
  enter(HandshakeStage::ResetWait, now + kWelcomePatience);
}

void Handshake::on_message(Instant now, const protocol::Message& message, std::string_view raw, const Snapshot& after) {
  collector_.fold(message);
  if (stage_ == HandshakeStage::Closed || stage_ == HandshakeStage::Failed || stage_ == HandshakeStage::Ready) return;
  if (std::holds_alternative<protocol::Welcome>(message)) {
    if (++restarts_ > kMostRestarts) {
      fail(HandshakeFailure::Restarting,
           "The controller restarts again and again: check its power supply, its reset and E-stop inputs.");
      return;
    }
    listen_after_welcome(now);
    return;
  }
  if (std::holds_alternative<protocol::Unrecognized>(message) && strange_line_.empty()) {
    strange_line_ = base::escape(raw.substr(0, kExcerpt));
  }
  if (stage_ == HandshakeStage::Questioning && !is_report(message)) deadline_ = now + kQuestionPatience;
  if (!is_report(message)) return;
  reported_ = true;
  state_ = after.state;
  const bool pendant_takes_over = after.pendant_in_control && stage_ != HandshakeStage::PendantWait;
  if (pendant_takes_over && stage_ != HandshakeStage::Listening) orders_.emplace_back(ForgetQuestions{});
  const bool decides = stage_ == HandshakeStage::Asking || stage_ == HandshakeStage::BusyWait ||
                       stage_ == HandshakeStage::PendantWait || pendant_takes_over;
  if (decides) judge(now, after);
}

void Handshake::begin_asking(Instant now) {
  asking_since_ = now;
  if (quick_ && !collector_.dialect().answers_full_status) {
    orders_.emplace_back(SendByte{byte_of(Realtime::StatusQuery)});
    enter(HandshakeStage::Asking, now + kAskEvery);
    return;
  }
  orders_.emplace_back(SendByte{byte_of(Realtime::FullStatus)});
  enter(HandshakeStage::Asking, now + kFullReportPatience);
}

void Handshake::ask_again(Instant now) {
  if (now - asking_since_ >= kSilentAfter) {
    give_up_silent(now);
    return;
  }
  orders_.emplace_back(SendByte{byte_of(Realtime::StatusQuery)});
  deadline_ = now + kAskEvery;
}

void Handshake::give_up_silent(Instant now) {
  if (!reset_done_) {
    reset(now, "Nothing answers on this link, so the controller is reset once to find out whether there is one.");
    return;
  }
  if (strange_line_.empty()) {
    fail(HandshakeFailure::Silent,
         "Nothing answers on this link: check that the controller is powered, that port and baud rate are right, and "
         "that no "
         "other program talks to it.");
    return;
  }
  fail(HandshakeFailure::NotGrbl,
       "What answers on this link is no Grbl controller, or the baud rate is wrong; it sent \"" + strange_line_ +
           "\". Choose another port or rate.");
}

void Handshake::judge(Instant now, const Snapshot& snapshot) {
  if (snapshot.pendant_in_control) {
    if (stage_ == HandshakeStage::PendantWait) return;
    orders_.emplace_back(BusyNotice{.state = snapshot.state,
                                    .pendant = true,
                                    .sentence = "A pendant has the machine; Kerf only watches until it is released."});
    enter(HandshakeStage::PendantWait, kNever);
    return;
  }
  if (stage_ == HandshakeStage::PendantWait) {
    begin_asking(now);
    return;
  }
  const bool at_work = !snapshot.controller_file.empty();
  if (at_work) {
    wait_while_busy(now, snapshot);
  } else if (snapshot.state == MachineState::Idle) {
    judge_idle(now);
  } else if (snapshot.state == MachineState::Alarm || snapshot.state == MachineState::Check) {
    clear(now);
  } else {
    wait_while_busy(now, snapshot);
  }
}

void Handshake::judge_idle(Instant now) {
  if (fresh_) {
    clear(now);
  } else if (collector_.dialect().jog_cancel_flushes_rx) {
    // Drops a half line and the error latch, and nothing else (protocol.md 2).
    orders_.emplace_back(SendByte{byte_of(Realtime::JogCancel)});
    clear(now);
  } else if (policy_ == ResetPolicy::WhenSilentOrIdle && !reset_done_) {
    reset(now, "The machine is idle and is reset once, so that nothing an earlier program left behind gets executed.");
  } else {
    clear(now);
  }
}

void Handshake::wait_while_busy(Instant now, const Snapshot& snapshot) {
  if (busy_told_ != snapshot.state) {
    busy_told_ = snapshot.state;
    orders_.emplace_back(BusyNotice{.state = snapshot.state, .pendant = false, .sentence = busy_sentence(snapshot)});
  }
  enter(HandshakeStage::BusyWait, now + kBusyAskEvery);
}

void Handshake::reset(Instant now, std::string reason) {
  reset_done_ = true;
  orders_.emplace_back(ForgetQuestions{});
  orders_.emplace_back(ResetNotice{std::move(reason)});
  orders_.emplace_back(SendByte{byte_of(Realtime::SoftReset)});
  enter(HandshakeStage::ResetWait, now + kWelcomePatience);
}

void Handshake::clear(Instant now) {
  fresh_ = false;
  // Ends a half line, clears grblHAL's error latch, and shows that lines are answered (protocol.md 1.6, 6.4).
  orders_.emplace_back(AskLine{""});
  enter(HandshakeStage::Clearing, now + kAnswerPatience);
}

void Handshake::on_answer(Instant now, int error_code) {
  if (stage_ == HandshakeStage::Clearing) {
    begin_questions(now);
    return;
  }
  if (stage_ != HandshakeStage::Questioning) return;
  if (error_code != 0 && collector_.dialect().error_latch && !latch_clearing_) {
    latch_clearing_ = true;
    orders_.emplace_back(AskLine{""});
    deadline_ = now + kQuestionPatience;
    return;
  }
  latch_clearing_ = false;
  ask_next(now);
}

void Handshake::begin_questions(Instant now) {
  asked_.clear();
  latch_clearing_ = false;
  enter(HandshakeStage::Questioning, now + kQuestionPatience);
  ask_next(now);
}

std::vector<std::string> Handshake::questions() const {
  if (quick_) return {"$G", "$#"};
  const auto& dialect = collector_.dialect();
  std::vector<std::string> list;
  // The plain form comes first while the firmware is not known: Grbl refuses the other.
  const bool plain_first = std::ranges::find(asked_, "$I") != asked_.end() || !dialect.answers_full_status;
  if (plain_first) list.emplace_back("$I");
  if (dialect.answers_full_status) list.emplace_back("$I+");
  list.insert(list.end(), {"$G", "$#", "$$"});
  if (!enumerate_) return list;
  const bool enumerates = collector_.has_token("ENUMS");
  if (enumerates || dialect.can_enumerate_codes) list.insert(list.end(), {"$EA", "$EE"});
  if (enumerates) list.insert(list.end(), {"$EG", "$ES"});
  if (enumerates && collector_.has_token("SED")) list.emplace_back("$ESH");
  if (enumerates) list.emplace_back("$SPINDLESH");
  if (std::ranges::find(asked_, "$SPINDLESH") != asked_.end() && !collector_.knows_spindles()) {
    list.emplace_back("$SPINDLES");
  }
  if (!dialect.named_settings_query.empty()) list.emplace_back(dialect.named_settings_query);
  return list;
}

void Handshake::ask_next(Instant now) {
  for (std::string& question : questions()) {
    if (std::ranges::find(asked_, question) != asked_.end()) continue;
    asked_.push_back(question);
    orders_.emplace_back(AskLine{std::move(question)});
    deadline_ = now + kQuestionPatience;
    return;
  }
  finish(true);
}

void Handshake::finish(bool complete) {
  capabilities_ = collector_.capabilities(complete);
  orders_.emplace_back(Success{summary_of(capabilities_) + "; " + std::string{vocabulary::name_of(state_)} + "."});
  quick_ = false;
  enter(HandshakeStage::Ready, kNever);
}

void Handshake::refresh() {
  if (stage_ == HandshakeStage::Ready) capabilities_ = collector_.capabilities(capabilities_.complete);
}

void Handshake::learn(const protocol::SettingValue& setting) {
  collector_.fold(setting);
  refresh();
}

void Handshake::fail(HandshakeFailure failure, std::string sentence) {
  orders_.emplace_back(ForgetQuestions{});
  orders_.emplace_back(Failure{.failure = failure, .sentence = std::move(sentence)});
  enter(HandshakeStage::Failed, kNever);
}

void Handshake::time_out_clearing(Instant now, const Snapshot& snapshot) {
  if (snapshot.state == MachineState::Alarm && !reset_done_) {
    reset(now, "The machine is in alarm and answers no line: only a reset helps, and nothing moves.");
    return;
  }
  if (!cleared_twice_) {
    cleared_twice_ = true;
    orders_.emplace_back(ForgetQuestions{});
    clear(now);
    return;
  }
  fail(HandshakeFailure::LinesUnanswered,
       "The controller reports its state (" + std::string{vocabulary::name_of(snapshot.state)} +
           ") but answers no line: another program or a file may have it; reset it or try again.");
}

void Handshake::time_out_question() {
  orders_.emplace_back(ForgetQuestions{});
  if (asked_.size() <= 1) {
    fail(HandshakeFailure::LinesUnanswered,
         "The controller does not answer the question who it is: reset it or try again.");
    return;
  }
  orders_.emplace_back(
      Remark{"The controller left " + asked_.back() + " without an answer; its description is incomplete."});
  finish(false);
}

void Handshake::advance_to(Instant now, const Snapshot& snapshot) {
  if (now < deadline_) return;
  switch (stage_) {
    case HandshakeStage::Listening: begin_asking(now); return;
    case HandshakeStage::Asking: ask_again(now); return;
    case HandshakeStage::BusyWait:
      orders_.emplace_back(SendByte{byte_of(Realtime::StatusQuery)});
      deadline_ = now + kBusyAskEvery;
      return;
    case HandshakeStage::ResetWait:
      // An E-stop input keeps grblHAL from resetting, and reports still come.
      if (reported_)
        begin_asking(now);
      else
        give_up_silent(now);
      return;
    case HandshakeStage::Clearing: time_out_clearing(now, snapshot); return;
    case HandshakeStage::Questioning: time_out_question(); return;
    default: deadline_ = kNever; return;
  }
}

std::vector<HandshakeOrder> Handshake::take_orders() {
  return std::exchange(orders_, {});
}

}  // namespace kerf::machine
