#include "simulation/case_runner.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "firmware/virtual_controller.hpp"
#include "simulation/standstill.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using firmware::VirtualController;

constexpr std::string_view kSoftReset = "\x18";
/// No case takes longer; what is unanswered by then stays so.
constexpr Duration kMostTime = 600s;
/// Resets that one case may need; a machine that waits again after so many is left alone.
constexpr int kMostResets = 8;

bool is_reset_after_alarm(vocabulary::Firmware firmware) {
  return firmware == vocabulary::Firmware::Grbl || firmware == vocabulary::Firmware::Rabbit;
}

/// A line that was sent, and what became of it.
struct SentLine {
  std::string text;
  std::string answer;
};

/// The other end of the wire: sends line after line and notes what comes.
class CaseRun {
 public:
  CaseRun(const InterpreterCase& asked, const CaseMachine& machine)
      : asked_(asked),
        resets_after_alarm_(is_reset_after_alarm(machine.personality.firmware)),
        controller_(machine.personality, machine.stored) {
    for (const auto& event : machine.workcell) controller_.submit(now_, event);
    controller_.power_on(now_);
    controller_.advance_to(now_);
    static_cast<void>(controller_.take_outbox());
  }

  CaseRecord run() {
    queue(asked_.setup);
    converse();
    record_ = {};
    record_.id = asked_.id;
    lines_.clear();
    next_ = 0;
    began_ = now_;
    injected_ = 0;
    queue(asked_.lines);
    queue({"$G", "$#"});
    converse();
    for (std::size_t i = 0; i < asked_.lines.size(); ++i) {
      const std::string& answer = lines_[i].answer;
      record_.answers.push_back(answer.empty() ? "none" : answer);
    }
    note_position();
    return record_;
  }

 private:
  void queue(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) lines_.push_back({.text = text, .answer = {}});
  }

  [[nodiscard]] bool is_answered() const { return next_ == lines_.size() && !awaits_answer_; }

  /// Until every line has its answer and the machine rests.
  void converse() {
    const Instant limit = now_ + kMostTime;
    Standstill standstill;
    while (now_ <= limit) {
      if (standstill.lasts(controller_, next_)) return;
      if (send_next()) continue;
      const Instant next = std::min(controller_.next_deadline(), next_injection());
      if (is_answered() && controller_.next_deadline() == kNever) return;
      if (next == kNever) {
        if (resets_ == kMostResets) return;
        reset();
        continue;
      }
      now_ = std::max(now_, next);
      controller_.advance_to(now_);
      inject();
      listen();
    }
  }

  [[nodiscard]] Instant next_injection() const {
    return began_ && injected_ < asked_.inject.size() ? *began_ + asked_.inject[injected_].after : kNever;
  }

  void inject() {
    for (; next_injection() <= now_; ++injected_) {
      const char byte = static_cast<char>(asked_.inject[injected_].byte);
      controller_.on_bytes(now_, std::string_view{&byte, 1});
    }
  }

  bool send_next() {
    if (awaits_answer_ || next_ == lines_.size()) return false;
    awaits_answer_ = true;
    controller_.on_bytes(now_, lines_[next_].text + "\n");
    ++next_;
    controller_.advance_to(now_);
    listen();
    return true;
  }

  void reset() {
    ++resets_;
    controller_.on_bytes(now_, kSoftReset);
    controller_.advance_to(now_);
    listen();
  }

  void listen() {
    const std::string heard = controller_.take_outbox();
    was_answered_now_ = false;
    bool alarmed = false;
    for (std::string_view line : base::split(heard, '\n')) {
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (!line.empty()) alarmed = hear(line) || alarmed;
    }
    if (alarmed && resets_after_alarm_ && resets_ < kMostResets) reset();
  }

  /// True for an alarm.
  bool hear(std::string_view line) {
    const protocol::Message message = protocol::decode(line);
    return std::visit(base::Overloaded{
                          [&](const protocol::Ok&) { return answered(line); },
                          [&](const protocol::ErrorAnswer&) { return answered(line); },
                          [&](const protocol::AlarmRaised&) {
                            record_.alarms.emplace_back(line);
                            return true;
                          },
                          [](const protocol::StatusReport&) { return false; },
                          [&](const protocol::Welcome&) {
                            lose_line();
                            return note(line);
                          },
                          [&](const auto&) { return hear_bracket(line); },
                      },
                      message);
  }

  bool answered(std::string_view answer) {
    if (!awaits_answer_) return note(answer);
    lines_[next_ - 1].answer = answer;
    awaits_answer_ = false;
    was_answered_now_ = true;
    return false;
  }

  /// A reset swallows the line in flight. The next one is sent as soon as an answer arrives, so an answer that comes
  /// just ahead of a reset costs that line.
  void lose_line() {
    if (was_answered_now_ && next_ < lines_.size()) {
      ++next_;
      awaits_answer_ = true;
    }
    if (!awaits_answer_) return;
    lines_[next_ - 1].answer = "lost";
    awaits_answer_ = false;
    was_answered_now_ = false;
  }

  bool hear_bracket(std::string_view line) {
    const bool answers_query = next_ > asked_.lines.size() && began_;
    if (line.starts_with("[GC:")) {
      record_.parser_state = line;
    } else if (answers_query && awaits_answer_ && lines_[next_ - 1].text == "$#" && line.starts_with('[') &&
               line.ends_with(']') && line.contains(':')) {
      const std::size_t colon = line.find(':');
      record_.offsets.emplace_back(line.substr(1, colon - 1), line.substr(colon + 1, line.size() - colon - 2));
    } else {
      note(line);
    }
    return false;
  }

  bool note(std::string_view line) {
    record_.messages.emplace_back(line);
    return false;
  }

  void note_position() {
    const vocabulary::AxisSteps steps = controller_.position_steps();
    const std::vector<double> mm = controller_.position_mm();
    record_.position_mm = mm;
    record_.position_steps.assign(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(mm.size()));
  }

  const InterpreterCase& asked_;
  bool resets_after_alarm_;
  VirtualController controller_;
  Instant now_{};
  std::optional<Instant> began_;
  CaseRecord record_;
  std::vector<SentLine> lines_;
  std::size_t next_ = 0;
  std::size_t injected_ = 0;
  int resets_ = 0;
  bool awaits_answer_ = false;
  bool was_answered_now_ = false;
};

}  // namespace

CaseRecord run_case(const InterpreterCase& asked, const CaseMachine& machine) {
  return CaseRun(asked, machine).run();
}

}  // namespace kerf::simulation
