#pragma once
// The second stream of grblHAL, and how command passes to it and back (stream.c; protocol.md 1.5).

#include <cstdint>

#include "firmware/board.hpp"
#include "firmware/foreground.hpp"
#include "firmware/receiver.hpp"
#include "firmware/reporter.hpp"

namespace kerf::firmware {

/// Knows what the pendant's bytes do while it is not in command, and when command may change hands.
class Pendant {
 public:
  Pendant(Board& board, Receiver& receiver, Reporter& reporter, Foreground& foreground)
      : board_(board), receiver_(receiver), reporter_(reporter), foreground_(foreground) {}

  /// True if the byte was for the pendant alone: a question, a request to command, or text, which is dropped.
  bool take_unasked(std::uint8_t byte);
  /// 0x8B from the pendant in command.
  void give_back() { set_command(false); }
  /// A request is answered by a report a little later.
  void advance();
  [[nodiscard]] Instant next_deadline() const { return report_at_; }

 private:
  void set_command(bool on);

  Board& board_;
  Receiver& receiver_;
  Reporter& reporter_;
  Foreground& foreground_;
  Instant report_at_ = kNever;
  bool reports_everything_ = false;
};

}  // namespace kerf::firmware
