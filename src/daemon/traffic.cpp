#include "daemon/traffic.hpp"

#include <variant>

#include "common/base/text.hpp"

namespace kerf::daemon {
namespace {

constexpr std::size_t kLinesKept = 1000;

std::string meaning_of(const protocol::Message& message) {
  if (const auto* feedback = std::get_if<protocol::Feedback>(&message)) return feedback->text;
  return {};
}

}  // namespace

void Traffic::add(Instant at, const session::LineSent& line) {
  add({.at_s = base::to_seconds(at),
       .direction = TrafficDirection::Sent,
       .text = base::escape(line.text),
       .purpose = boost::describe::enum_to_string(line.purpose, "?")});
}

void Traffic::add(Instant at, const session::LineReceived& line) {
  add({.at_s = base::to_seconds(at),
       .direction = TrafficDirection::Received,
       .text = base::escape(line.raw),
       .purpose = line.answers    ? boost::describe::enum_to_string(line.answers->purpose, "?")
                  : line.for_kerf ? "Query"
                                  : "",
       .meaning = line.answers ? "answers " + line.answers->text : meaning_of(line.message)});
}

void Traffic::add(TrafficLine line) {
  line.number = ++number_;
  lines_.push_back(std::move(line));
  if (lines_.size() > kLinesKept) lines_.pop_front();
}

}  // namespace kerf::daemon
