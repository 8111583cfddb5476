#include "sender/session/words_listener.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>

namespace kerf::session {
namespace {

/// Their answers are the firmware's own, whatever the machine is doing. Not the spindles: settings change them.
constexpr std::array<std::string_view, 5> kLasting{"$EA", "$EE", "$EG", "$ES", "$ESH"};

}  // namespace

void WordsListener::on_event(const Event& event) {
  if (const auto* identified = std::get_if<FirmwareIdentified>(&event)) {
    words_ = {.identity = identified->identity};
    open_.reset();
  } else if (const auto* sent = std::get_if<LineSent>(&event)) {
    open_.reset();
    const bool is_lasting = std::ranges::find(kLasting, sent->text) != kLasting.end();
    if (is_lasting && sent->purpose == streaming::Purpose::Question)
      open_ = machine::KeptAnswer{.question = sent->text, .lines = {}};
  } else if (const auto* line = std::get_if<LineReceived>(&event)) {
    on_line(*line);
  }
}

void WordsListener::on_line(const LineReceived& line) {
  if (!open_ || std::holds_alternative<protocol::StatusReport>(line.message)) return;
  if (!protocol::is_answer(line.message)) {
    open_->lines.push_back(line.raw);
    return;
  }
  if (std::holds_alternative<protocol::Ok>(line.message)) {
    std::erase_if(words_.answers, [this](const auto& answer) { return answer.question == open_->question; });
    words_.answers.push_back(*std::move(open_));
    has_news_ = true;
  }
  open_.reset();
}

}  // namespace kerf::session
