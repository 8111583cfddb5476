#include "simulation/wire_watch.hpp"

#include <algorithm>
#include <array>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

constexpr char kSoftReset = '\x18';
constexpr std::string_view kCycleStarts = "~\x81";

/// Lines that only ask, or that no firmware executes: an empty one, and the one that spoils what lies half-written in a
/// buffer.
bool is_harmless(std::string_view line) {
  const std::string_view text = base::trim(line);
  if (text.empty() || text == ")=") return true;
  if (!text.starts_with('$')) return base::starts_with_ignoring_case(text, "G4P0");
  return !base::starts_with_ignoring_case(text, "$J") && !base::starts_with_ignoring_case(text, "$H") &&
         !base::starts_with_ignoring_case(text, "$X");
}

/// A question, and how the first line of its answer begins, which no other line says.
struct Question {
  std::string_view asked;
  std::string_view answer;
};
constexpr std::array kQuestions{Question{"$G", "[GC:"}, Question{"$#", "[G54:"}, Question{"$I", "[VER:"},
                                Question{"$$", "$0="}, Question{"$N", "$N0="}};

bool is_welcome(std::string_view line) {
  return line.starts_with("Rabbit GRBL v") || (line.starts_with("Grbl") && line.contains("['$'"));
}

}  // namespace

void WireWatch::on_link_changed() {
  forget();
  half_line_.clear();
  commanded_ = false;
  reset_pending_ = false;
  last_serial_answered_ = 0;
}

void WireWatch::forget() {
  in_flight_.clear();
  bytes_in_flight_ = 0;
}

void WireWatch::on_command(const session::Command& command) {
  std::visit(base::Overloaded{
                 [](const session::HoldJob&) {},
                 [](const session::StopJob&) {},
                 [](const session::AbortJob&) {},
                 [](const session::SoftReset&) {},
                 [](const session::RecallSettings&) {},
                 [&](const auto&) { commanded_ = true; },
             },
             command);
}

void WireWatch::on_outbox(Instant now, const session::Outbox& out, std::size_t window_bytes) {
  on_realtime(now, out.realtime);
  on_lines(now, out.lines, window_bytes);
  for (const auto& event : out.events) {
    if (const auto* received = std::get_if<session::LineReceived>(&event); received && received->answers) {
      on_answered_line(now, received->answers->serial);
    }
  }
}

void WireWatch::on_realtime(Instant now, std::string_view bytes) {
  if (bytes.find_first_of(kCycleStarts) != std::string_view::npos) may_move(now, "a cycle start");
  if (!bytes.contains(kSoftReset)) return;
  forget();
  reset_pending_ = true;
}

void WireWatch::on_lines(Instant now, std::string_view lines, std::size_t window_bytes) {
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    if (end == std::string_view::npos) {
      complain(now, "half a line left: " + base::escape(lines));
      return;
    }
    on_line(now, lines.substr(0, end + 1), window_bytes);
    lines.remove_prefix(end + 1);
  }
}

void WireWatch::on_line(Instant now, std::string_view line, std::size_t window_bytes) {
  ++lines_sent_;
  // The welcome got lost, and whoever sends has waited for it long enough: answers are this line's again.
  reset_pending_ = false;
  in_flight_.push_back({.bytes = line.size(), .text = std::string{base::trim(line)}});
  bytes_in_flight_ += line.size();
  most_in_flight_ = std::max(most_in_flight_, bytes_in_flight_);
  if (bytes_in_flight_ > window_bytes && in_flight_.size() > 1) {
    complain(now,
             std::to_string(bytes_in_flight_) + " bytes in flight, and the window is " + std::to_string(window_bytes));
  }
  if (!is_harmless(line)) may_move(now, line);
}

void WireWatch::may_move(Instant now, std::string_view what) {
  if (!commanded_) complain(now, "without a command this left: " + base::escape(what));
  motion_sent_at_ = now;
}

void WireWatch::on_answered_line(Instant now, std::uint64_t serial) {
  ++lines_answered_;
  if (serial <= last_serial_answered_) complain(now, "line " + std::to_string(serial) + " was answered again");
  last_serial_answered_ = serial;
  if (lines_answered_ > answers_received_) complain(now, "more lines were answered than answers came");
}

void WireWatch::on_received(Instant now, std::string_view bytes) {
  for (const char byte : bytes) {
    if (byte == '\r' || byte == '\n') {
      on_received_line(now, half_line_);
      half_line_.clear();
    } else if (byte >= ' ') {
      half_line_ += byte;
    }
  }
}

void WireWatch::on_received_line(Instant now, std::string_view line) {
  if (is_welcome(line)) {
    forget();
    reset_pending_ = false;
    commanded_ = false;
    if (motion_sent_at_ && now - *motion_sent_at_ > round_trip_) motion_sent_at_.reset();
    return;
  }
  for (const Question& question : kQuestions) {
    if (line.starts_with(question.answer)) strike_out_what_was_read(question.asked);
  }
  if (line != "ok" && !line.starts_with("error:")) return;
  ++answers_received_;
  if (reset_pending_) return;
  if (in_flight_.empty()) {
    ++stray_answers_;
    return;
  }
  forget_oldest();
}

void WireWatch::forget_oldest() {
  bytes_in_flight_ -= in_flight_.front().bytes;
  in_flight_.pop_front();
}

// Lines are read in order, so what was sent before the question lies in no buffer any more, whatever became of it or of
// its answer. One that was asked again stands for the last: it is repeated only when the first one got no answer.
void WireWatch::strike_out_what_was_read(std::string_view before_question) {
  const auto last = std::ranges::find(in_flight_.rbegin(), in_flight_.rend(), before_question, &LineInFlight::text);
  for (auto read = in_flight_.rend() - last; read > 1; --read) forget_oldest();
}

void WireWatch::complain(Instant now, std::string_view what) {
  complaints_.push_back("at " + base::to_fixed(base::to_seconds(now), 3) + " s: " + std::string{what});
}

}  // namespace kerf::simulation
