#include "simulation/talk_conversation.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;

/// tests/transcripts/README.md: how long `<-` and `@ until` wait, and how often `until` asks.
constexpr Duration kLineLimit = 60s;
constexpr Duration kUntilLimit = 120s;
constexpr Duration kReportPause = 250ms;
/// A report that does not come at all, for example because Grbl is in a critical alarm.
constexpr Duration kReportLimit = 3s;

/// Somebody who was just switched on greets within this time; a controller that runs already says nothing.
constexpr Duration kListening = 1s;
constexpr Duration kWelcomeLimit = 6s;
/// Start-up lines, alarms and messages follow the welcome (protocol.md 1.1; Grbl waits 500 ms after an alarm).
constexpr Duration kQuiet = 700ms;
constexpr Duration kSettingLimit = 10s;
/// What the last step caused may still arrive.
constexpr Duration kEnding = 300ms;

constexpr std::string_view kSoftReset = "\x18";

/// The lines that end in `bytes`, without empty ones; what is left stays in `partial`.
std::vector<std::string> whole_lines(std::string& partial, std::string_view bytes) {
  std::vector<std::string> lines;
  for (const char byte : bytes) {
    if (byte != '\n') {
      partial += byte;
      continue;
    }
    if (partial.ends_with('\r')) partial.pop_back();
    if (!partial.empty()) lines.push_back(partial);
    partial.clear();
  }
  return lines;
}

bool is_welcome(const std::string& line) {
  return std::holds_alternative<protocol::Welcome>(protocol::decode(line));
}

}  // namespace

TalkConversation::TalkConversation(const Talk& talk, Instant now)
    : talk_(talk), began_(now), deadline_(now + kListening) {}

void TalkConversation::on_bytes(Instant now, std::string_view bytes) {
  for (std::string& line : whole_lines(partial_line_, bytes)) {
    note(now, "<-", line);
    lines_.push_back(std::move(line));
  }
  advance_to(now);
}

void TalkConversation::on_pendant_bytes(Instant now, std::string_view bytes) {
  for (std::string& line : whole_lines(partial_pendant_line_, bytes)) {
    note(now, "<P", line);
    pendant_lines_.push_back(std::move(line));
  }
  advance_to(now);
}

void TalkConversation::on_closed() {
  if (!is_finished()) fail("the connection ended");
}

void TalkConversation::advance_to(Instant now) {
  Phase phase{};
  std::size_t step = 0;
  do {
    phase = phase_;
    step = step_;
    if (is_finished() || must_yield_) return;
    step_once(now);
  } while (phase != phase_ || step != step_);
}

TalkOutbox TalkConversation::take_outbox() {
  must_yield_ = false;
  return std::exchange(outbox_, {});
}

void TalkConversation::step_once(Instant now) {
  switch (phase_) {
    case Phase::Listening:
    case Phase::AwaitingWelcome:
      if (heard_welcome()) {
        phase_ = Phase::Quieting;
        deadline_ = now + kQuiet;
      } else if (now < deadline_) {
        return;
      } else if (phase_ == Phase::AwaitingWelcome) {
        fail("no welcome came after a soft reset: this is no Grbl, or it is in an emergency stop");
      } else if (talk_.begins_at_power_up) {
        came_too_late_ = true;
        finish(now);
      } else {
        soft_reset(now);
      }
      return;
    case Phase::Quieting:
      if (now >= deadline_) begin_or_configure(now);
      return;
    case Phase::AwaitingSettingOk:
      if (lines_.empty() && now < deadline_) return;
      if (lines_.size() != 1 || lines_.front() != "ok") {
        return fail("'" + talk_.settings[setting_] + "' was answered '" + (lines_.empty() ? "" : lines_.front()) + "'");
      }
      lines_.clear();
      ++setting_;
      return next_setting_or_reset(now);
    case Phase::Running:
      if (step_ == talk_.steps.size()) {
        phase_ = Phase::Ending;
        deadline_ = now + kEnding;
        return;
      }
      return run_step(now);
    case Phase::Ending:
      if (now < deadline_) return;
      withdraw_allowances();
      if (!lines_.empty()) return fail("'" + lines_.front() + "' was left over");
      return finish(now);
    case Phase::Finished: return;
  }
}

void TalkConversation::begin_or_configure(Instant now) {
  const bool must_configure = !is_configured_ && !talk_.settings.empty();
  if (must_configure) {
    lines_.clear();
    return next_setting_or_reset(now);
  }
  if (!talk_.begins_at_power_up) lines_.clear();
  note(now, "..", "the talk begins");
  phase_ = Phase::Running;
}

void TalkConversation::next_setting_or_reset(Instant now) {
  if (setting_ == talk_.settings.size()) {
    is_configured_ = true;
    return soft_reset(now);
  }
  phase_ = Phase::AwaitingSettingOk;
  deadline_ = now + kSettingLimit;
  say(now, talk_.settings[setting_] + "\n");
}

void TalkConversation::soft_reset(Instant now) {
  lines_.clear();
  phase_ = Phase::AwaitingWelcome;
  deadline_ = now + kWelcomeLimit;
  say(now, kSoftReset);
}

void TalkConversation::run_step(Instant now) {
  std::visit([&](const auto& action) { run(now, action); }, talk_.steps[step_].action);
}

void TalkConversation::run(Instant now, const SendBytes& send) {
  withdraw_allowances();
  if (send.port == firmware::Port::Pendant) {
    pendant_lines_.clear();
    note(now, "P>", base::escape(send.bytes));
    outbox_.pendant_bytes += send.bytes;
    must_yield_ = true;
  } else {
    say(now, send.bytes);
  }
  step_done(now);
}

void TalkConversation::run_on_pendant(Instant now, const ExpectLine& expect) {
  while (!pendant_lines_.empty()) {
    const std::string line = std::move(pendant_lines_.front());
    pendant_lines_.pop_front();
    if (expect.pattern.matches(line)) return step_done(now);
  }
  await_line(now);
}

void TalkConversation::run(Instant now, const ExpectLine& expect) {
  if (expect.port == firmware::Port::Pendant) return run_on_pendant(now, expect);
  while (!lines_.empty()) {
    const std::string line = std::move(lines_.front());
    lines_.pop_front();
    if (expect.pattern.matches(line)) return step_done(now);
    if (!is_allowed(line)) return fail("'" + line + "' came");
  }
  await_line(now);
}

void TalkConversation::await_line(Instant now) {
  if (!step_limit_) step_limit_ = now + kLineLimit;
  deadline_ = *step_limit_;
  if (now >= deadline_) fail("nothing came");
}

void TalkConversation::run(Instant now, const AllowLines& allow) {
  allowed_.push_back(&allow.pattern);
  step_done(now);
}

void TalkConversation::run(Instant now, const ForbidLines& forbid) {
  std::erase_if(lines_, [&](const std::string& line) { return is_allowed(line); });
  for (const std::string& line : lines_) {
    if (forbid.pattern.matches(line)) return fail("'" + line + "' came");
  }
  step_done(now);
}

void TalkConversation::run(Instant now, const LetTimePass& pass) {
  withdraw_allowances();
  if (!step_limit_) step_limit_ = now + pass.time;
  deadline_ = *step_limit_;
  if (now >= deadline_) step_done(now);
}

void TalkConversation::run(Instant now, const WaitUntil& until) {
  withdraw_allowances();
  if (!step_limit_) step_limit_ = now + kUntilLimit;
  if (asking_ == Asking::AwaitingReport) {
    const auto from = lines_.begin() + static_cast<std::ptrdiff_t>(reports_from_);
    const auto report = std::find_if(from, lines_.end(), [](const std::string& line) { return line.starts_with('<'); });
    if (report != lines_.end()) {
      const bool matched = until.pattern.matches(*report);
      lines_.erase(report);
      if (matched) return step_done(now);
      asking_ = Asking::Pausing;
      deadline_ = now + kReportPause;
    }
  }
  if (asking_ != Asking::No && now < deadline_) return;
  if (now >= *step_limit_)
    return fail("no report matched for " + base::to_fixed(base::to_seconds(kUntilLimit), 0) + " s");
  asking_ = Asking::AwaitingReport;
  reports_from_ = lines_.size();
  deadline_ = now + kReportLimit;
  say(now, "?");
}

void TalkConversation::run(Instant now, const MoveSwitch& move) {
  withdraw_allowances();
  outbox_.events.push_back(move.event);
  must_yield_ = true;
  note(now, "@ ", talk_.steps[step_].text.substr(2));
  step_done(now);
}

void TalkConversation::step_done(Instant now) {
  ++step_;
  step_limit_.reset();
  asking_ = Asking::No;
  deadline_ = now;
}

void TalkConversation::finish(Instant now) {
  note(now, "..", came_too_late_ ? "no start-up text came" : "the talk ends");
  phase_ = Phase::Finished;
  deadline_ = kNever;
}

void TalkConversation::fail(std::string what) {
  TalkFailure failure{.line = 0, .step = "before the first step", .what = std::move(what)};
  if (phase_ == Phase::Running && step_ < talk_.steps.size()) {
    failure.line = talk_.steps[step_].line;
    failure.step = talk_.steps[step_].text;
  } else if (phase_ == Phase::Ending) {
    failure.step = "at the end";
  }
  failure_ = std::move(failure);
  phase_ = Phase::Finished;
  deadline_ = kNever;
}

void TalkConversation::say(Instant now, std::string_view bytes) {
  note(now, "->", base::escape(bytes.ends_with('\n') ? bytes.substr(0, bytes.size() - 1) : bytes));
  outbox_.bytes.append(bytes);
  must_yield_ = true;
}

void TalkConversation::note(Instant now, std::string_view direction, std::string_view text) {
  base::append_fixed(record_, base::to_seconds(now - began_), 3);
  record_.append(" ").append(direction).append(" ").append(text).append("\n");
}

void TalkConversation::withdraw_allowances() {
  std::erase_if(lines_, [&](const std::string& line) { return is_allowed(line); });
  allowed_.clear();
}

bool TalkConversation::is_allowed(std::string_view line) const {
  return std::ranges::any_of(allowed_, [&](const LinePattern* pattern) { return pattern->matches(line); });
}

bool TalkConversation::heard_welcome() const {
  return std::ranges::any_of(lines_, is_welcome);
}

}  // namespace kerf::simulation
