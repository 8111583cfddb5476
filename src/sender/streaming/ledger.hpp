#pragma once
// The account of lines sent: every line is owed exactly one answer.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"

namespace kerf::streaming {

/// Whose line it is.
enum class Purpose {
  JobLine,     ///< a line of the program
  JobSync,     ///< the dwell that waits for the end of motion
  ClearLatch,  ///< an empty line
  Operator,    ///< sent by hand
  Question,    ///< asked by Kerf itself
  Setting,     ///< part of a change of settings
  Proof,       ///< a question behind lines that owe their answers
};
BOOST_DESCRIBE_ENUM(Purpose, JobLine, JobSync, ClearLatch, Operator, Question, Setting, Proof)

/// A line on its way. `bytes` counts what lies in the controller's buffer: text and line end.
struct OwedLine {
  std::uint64_t serial = 0;
  Purpose purpose{};
  /// Line of the file, from 1; 0 for lines that are in no file.
  std::uint32_t file_line = 0;
  std::string text;
  std::size_t bytes = 0;
  /// Where the file line ends in the file.
  std::uint64_t file_offset_after = 0;
  Instant sent_at{};
  bool operator==(const OwedLine&) const = default;
};
BOOST_DESCRIBE_STRUCT(OwedLine, (), (serial, purpose, file_line, text, bytes, file_offset_after, sent_at))

/// Lines sent and not yet answered, oldest first. Controllers answer in order, so each answer belongs to the oldest
/// line.
class Ledger {
 public:
  /// Enters a line; gives its serial number.
  std::uint64_t enter(OwedLine line);
  /// Settles the oldest line; empty when nothing is owed (a stray answer).
  [[nodiscard]] std::optional<OwedLine> settle();
  /// Strikes out everything: a reset, a flush or a lost link means that no answers will come (protocol.md 4.4). Gives
  /// the lines lost.
  [[nodiscard]] std::vector<OwedLine> strike_out();

  /// Strikes out what is older than the first line of `purpose`: their answers will not come any more.
  [[nodiscard]] std::vector<OwedLine> strike_out_before(Purpose purpose);

  [[nodiscard]] bool empty() const { return owed_.empty(); }
  [[nodiscard]] std::size_t size() const { return owed_.size(); }
  [[nodiscard]] std::size_t bytes_in_flight() const { return bytes_; }
  [[nodiscard]] const OwedLine& oldest() const { return owed_.front(); }
  [[nodiscard]] bool owes(Purpose purpose) const;
  /// Oldest first.
  [[nodiscard]] const std::deque<OwedLine>& owed() const { return owed_; }
  [[nodiscard]] std::uint64_t lines_entered() const { return entered_; }
  [[nodiscard]] std::uint64_t lines_settled() const { return settled_; }
  [[nodiscard]] std::uint64_t lines_struck_out() const { return struck_out_; }

 private:
  std::deque<OwedLine> owed_;
  std::size_t bytes_ = 0;
  std::uint64_t entered_ = 0;
  std::uint64_t settled_ = 0;
  std::uint64_t struck_out_ = 0;
};

}  // namespace kerf::streaming
