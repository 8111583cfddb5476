#include "simulation/case_runner.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <string_view>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "firmware/virtual_controller.hpp"
#include "simulation/standstill.hpp"
#include "simulation/switched_on.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using firmware::VirtualController;

constexpr std::string_view kSoftReset = "\x18";
/// No case takes longer; what is unanswered by then stays so.
constexpr Duration kMostTime = 6h;
/// Ten bits at 115200 baud.
constexpr Duration kByteTime{86'806};
/// They count as offsets whoever asked for them: a probe move prints the last one by itself.
constexpr std::array<std::string_view, 14> kOffsetNames = {"G54",   "G55",   "G56", "G57", "G58", "G59", "G59.1",
                                                           "G59.2", "G59.3", "G28", "G30", "G92", "TLO", "PRB"};
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
    switch_on(controller_, now_, machine.told);
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
      const Instant next = std::min({controller_.next_deadline(), next_injection(), next_byte()});
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
      transmit();
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
    wire_ = lines_[next_].text + "\n";
    on_wire_ = 0;
    byte_at_ = now_;
    ++next_;
    transmit();
    return true;
  }

  /// When the next byte of the line arrives, as far as the controller has room for it.
  [[nodiscard]] Instant next_byte() const {
    return on_wire_ < wire_.size() && controller_.receive_room() > 0 ? std::max(byte_at_, now_) : kNever;
  }

  void transmit() {
    if (next_byte() > now_) return;
    controller_.on_bytes(now_, std::string_view{wire_}.substr(on_wire_, 1));
    ++on_wire_;
    byte_at_ = now_ + kByteTime;
    controller_.advance_to(now_);
    listen();
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
    on_wire_ = wire_.size();
    // grblHAL's recorder looks at the lines only when the firmware has said them all.
    if (was_answered_now_ && resets_after_alarm_ && next_ < lines_.size()) {
      ++next_;
      awaits_answer_ = true;
    }
    if (!awaits_answer_) return;
    lines_[next_ - 1].answer = "lost";
    awaits_answer_ = false;
    was_answered_now_ = false;
  }

  bool hear_bracket(std::string_view line) {
    const bool answers_query = next_ > asked_.lines.size() && awaits_answer_ && lines_[next_ - 1].text == "$#";
    const std::size_t colon = line.find(':');
    const bool has_name = line.starts_with('[') && line.ends_with(']') && colon != std::string_view::npos;
    const std::string_view name = has_name ? line.substr(1, colon - 1) : std::string_view{};
    if (!began_) return false;
    if (line.starts_with("[GC:")) {
      record_.parser_state = line;
    } else if (has_name && name != "MSG" &&
               (answers_query || std::ranges::find(kOffsetNames, name) != kOffsetNames.end())) {
      keep_offset(name, line.substr(colon + 1, line.size() - colon - 2));
    } else {
      note(line);
    }
    return false;
  }

  void keep_offset(std::string_view name, std::string_view value) {
    const auto known = std::ranges::find(record_.offsets, name, [](const auto& pair) { return pair.first; });
    if (known != record_.offsets.end()) {
      known->second = value;
    } else {
      record_.offsets.emplace_back(name, value);
    }
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
  /// The line under way, how much of it has arrived, and when the next byte may.
  std::string wire_;
  std::size_t on_wire_ = 0;
  Instant byte_at_{};
  int resets_ = 0;
  bool awaits_answer_ = false;
  bool was_answered_now_ = false;
};

}  // namespace

CaseRecord run_case(const InterpreterCase& asked, const CaseMachine& machine) {
  return CaseRun(asked, machine).run();
}

}  // namespace kerf::simulation
