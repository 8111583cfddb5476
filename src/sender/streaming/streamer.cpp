#include "sender/streaming/streamer.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace kerf::streaming {

void Streamer::configure(std::size_t window_bytes, SoloPolicy policy) {
  window_ = std::max<std::size_t>(window_bytes, 1);
  policy_ = policy;
}

void Streamer::enqueue(Purpose purpose, std::string text) {
  queue_.push_back({.purpose = purpose, .text = std::move(text)});
}

void Streamer::feed_from(std::unique_ptr<LineSource> source) {
  source_ = std::move(source);
  feeding_held_ = false;
}

void Streamer::stop_feeding() {
  source_.reset();
}

void Streamer::drop_queued(Purpose purpose) {
  std::erase_if(queue_, [purpose](const Queued& queued) { return queued.purpose == purpose; });
}

bool Streamer::has_room_for(std::string_view text) const {
  if (ledger_.empty()) return true;
  if (solo_under_way_ || must_travel_alone(text, policy_)) return false;
  return ledger_.bytes_in_flight() + text.size() + 1 <= window_;
}

OwedLine Streamer::send(Instant now, std::string& out, OwedLine line) {
  solo_under_way_ = must_travel_alone(line.text, policy_);
  line.bytes = line.text.size() + 1;
  line.sent_at = now;
  out += line.text;
  // LF only: CR LF costs an extra answer, and on grblHAL it clears the error latch (protocol.md 6.2, 6.4).
  out += '\n';
  line.serial = ledger_.enter(line);
  return line;
}

std::vector<OwedLine> Streamer::pump(Instant now, std::string& out) {
  std::vector<OwedLine> sent;
  if (paused_) return sent;
  while (!queue_.empty()) {
    if (!has_room_for(queue_.front().text)) return sent;
    Queued queued = std::move(queue_.front());
    queue_.pop_front();
    OwedLine line;
    line.purpose = queued.purpose;
    line.text = std::move(queued.text);
    sent.push_back(send(now, out, std::move(line)));
  }
  while (source_ && !feeding_held_ && !source_waits_) {
    if (flow_ == FlowPolicy::OneAtATime && !ledger_.empty()) break;
    const auto next = source_->next();
    if (!next || !has_room_for(next->text)) break;
    OwedLine line;
    line.purpose = Purpose::JobLine;
    line.file_line = next->file_line;
    line.file_offset_after = next->file_offset_after;
    line.text = std::string{next->text};
    source_->move_on();
    sent.push_back(send(now, out, std::move(line)));
  }
  return sent;
}

OwedLine Streamer::interject(Instant now, std::string& out, Purpose purpose, std::string text) {
  OwedLine line;
  line.purpose = purpose;
  line.text = std::move(text);
  return send(now, out, std::move(line));
}

std::optional<OwedLine> Streamer::settle() {
  auto line = ledger_.settle();
  if (ledger_.empty()) solo_under_way_ = false;
  return line;
}

std::vector<OwedLine> Streamer::strike_out() {
  solo_under_way_ = false;
  return ledger_.strike_out();
}

bool Streamer::source_exhausted() {
  return !source_ || feeding_held_ || !source_->next();
}

bool Streamer::done_with(Purpose purpose) const {
  const bool queued = std::ranges::any_of(queue_, [purpose](const Queued& line) { return line.purpose == purpose; });
  return !queued && !ledger_.owes(purpose);
}

}  // namespace kerf::streaming
