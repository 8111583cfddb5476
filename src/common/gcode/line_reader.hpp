#pragma once
// Bytes to lines as the firmware's main loop makes them: stripping, pairing of CR and LF, overlong lines.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "common/gcode/rules.hpp"

namespace kerf::gcode {

/// A line that is owed one answer.
struct ReadLine {
  /// Empty: answer ok. Valid until the next push.
  std::string_view text;
  /// Answer error:11 and execute nothing.
  bool overlong = false;
};

/// Holds one line at most. Realtime bytes must have been taken out before.
class LineReader {
 public:
  explicit LineReader(const LineRules& rules) : rules_(rules) {}

  /// One byte more; a value when it ends a line that the firmware answers.
  std::optional<ReadLine> push(char byte);

  /// All bytes of `line`, which holds no line end, and a line feed behind them. The text is valid as long as `line` and
  /// until the next push.
  std::optional<ReadLine> push_line(std::string_view line);

  /// The line just delivered was a block that failed: on grblHAL the LF of its CR LF then counts as an empty line
  /// (protocol.md 6.4).
  void block_failed();

  /// Soft reset, or 0x85 on grblHAL: the half line and the memory of CR or LF go.
  void clear();

  /// Some of a line has been read and not ended.
  [[nodiscard]] bool is_mid_line() const {
    return !delivered_ && (length_ > 0 || overlong_ || in_comment_ || to_end_comment_);
  }

  /// grblHAL with `$39`=0 lets `?`, `!`, `~` and bytes from 0xC0 through as text inside `$` and `[` lines and inside `(
  /// )` comments.
  [[nodiscard]] bool keeps_realtime_characters() const { return keeps_realtime_; }

 private:
  std::optional<ReadLine> end_line(char byte);
  void take_stripped(char byte);
  void take_raw(char byte);
  void take_trimmed(char byte);
  void note_trimmed(char byte);
  void erase_last();
  void start_line();

  /// Room for the longest line that any firmware takes.
  static constexpr std::size_t kCapacity = 257;

  LineRules rules_;
  std::array<char, kCapacity> text_{};
  std::size_t length_ = 0;
  bool overlong_ = false;
  bool in_comment_ = false;
  bool to_end_comment_ = false;
  bool keeps_realtime_ = false;
  bool delivered_ = false;
  char last_end_ = '\0';
};

}  // namespace kerf::gcode
