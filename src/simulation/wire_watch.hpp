#pragma once
// The account of a wire, kept by somebody who only sees its bytes: what a sender must never do, whatever it believes.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "sender/session/command.hpp"
#include "sender/session/session.hpp"

namespace kerf::simulation {

/// Counts lines that leave and answers that come in at the sender's end of the wire, and complains when more bytes are
/// unanswered than the window allows (a line that travels alone may be longer; what stands before a question that was
/// answered, such as `$G` with `[GC:`, has been read, although its own answer got lost), when more answers are given to
/// lines than came in, when one line is answered twice or out of order, and when something that may start motion leaves
/// although no command was given since the link was opened or the controller started.
class WireWatch {
 public:
  /// `round_trip`: what left so long before a welcome came may have reached the controller after its start.
  explicit WireWatch(Duration round_trip) : round_trip_(round_trip) {}

  void on_link_changed();
  void on_command(const session::Command& command);
  /// What leaves the sender now, while its window is `window_bytes`.
  void on_outbox(Instant now, const session::Outbox& out, std::size_t window_bytes);
  /// What reaches the sender now.
  void on_received(Instant now, std::string_view bytes);

  /// Something that may start motion has left since the controller started.
  [[nodiscard]] bool has_sent_motion() const { return motion_sent_at_.has_value(); }
  [[nodiscard]] std::uint64_t lines_sent() const { return lines_sent_; }
  [[nodiscard]] std::uint64_t answers_received() const { return answers_received_; }
  [[nodiscard]] std::uint64_t lines_answered() const { return lines_answered_; }
  /// Answers that came when no line was unanswered: more than the controller owed.
  [[nodiscard]] std::uint64_t stray_answers() const { return stray_answers_; }
  [[nodiscard]] std::size_t most_bytes_in_flight() const { return most_in_flight_; }
  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  void on_lines(Instant now, std::string_view lines, std::size_t window_bytes);
  void on_line(Instant now, std::string_view line, std::size_t window_bytes);
  void on_realtime(Instant now, std::string_view bytes);
  void on_answered_line(Instant now, std::uint64_t serial);
  void on_received_line(Instant now, std::string_view line);
  void may_move(Instant now, std::string_view what);
  void forget();
  void forget_oldest();
  void strike_out_what_was_read(std::string_view before_question);
  void complain(Instant now, std::string_view what);

  struct LineInFlight {
    std::size_t bytes = 0;
    std::string text;
  };

  /// Oldest first.
  std::deque<LineInFlight> in_flight_;
  std::size_t bytes_in_flight_ = 0;
  std::size_t most_in_flight_ = 0;
  std::string half_line_;
  bool reset_pending_ = false;
  /// The operator wants something since the link or the controller began anew.
  bool commanded_ = false;
  Duration round_trip_{};
  std::optional<Instant> motion_sent_at_;
  std::uint64_t lines_sent_ = 0;
  std::uint64_t answers_received_ = 0;
  std::uint64_t stray_answers_ = 0;
  std::uint64_t lines_answered_ = 0;
  std::uint64_t last_serial_answered_ = 0;
  std::vector<std::string> complaints_;
};

}  // namespace kerf::simulation
