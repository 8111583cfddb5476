#pragma once
// What a job does about a line that the controller refuses, and what became of the lines behind it.

#include <cstdint>
#include <string>
#include <utility>

#include <boost/describe.hpp>

namespace kerf::job {

enum class ErrorPolicy {
  HoldAndAsk,  ///< feed hold, and the operator decides
  Stop,        ///< hold, standstill, reset: the position is kept
  Continue,    ///< without this line, and it is told
};
BOOST_DESCRIBE_ENUM(ErrorPolicy, HoldAndAsk, Stop, Continue)

/// A line that the controller refused.
struct Refusal {
  std::uint32_t file_line = 0;
  std::string text{};
  int code = 0;
  /// The code in words, the controller's own first.
  std::string meaning{};
  bool operator==(const Refusal&) const = default;
};
BOOST_DESCRIBE_STRUCT(Refusal, (), (file_line, text, code, meaning))

/// The account of one refused line and of those that were on their way behind it. A controller with an error latch
/// (grblHAL) answers them with the same number and executes none; Grbl and Rabbit read and execute them one by one
/// (protocol.md 6.4). Which of the two happens is seen from the answers, not believed from a name.
class RefusalAccount {
 public:
  /// `has_latch`: of the dialect. error:40 never latches (protocol.md 6.4).
  RefusalAccount(Refusal refusal, bool has_latch)
      : refusal_(std::move(refusal)),
        last_line_(refusal_.file_line),
        may_latch_(has_latch && refusal_.code != kNeverLatched) {}

  /// The answer to a later line. True when it repeats the latched error: the line was not executed, and it is no
  /// refusal of its own.
  bool on_answer(int error_code, std::uint32_t file_line) {
    last_line_ = file_line;
    if (error_code == 0) {
      ++executed_;
      return false;
    }
    const bool repeats = may_latch_ && executed_ == 0 && error_code == refusal_.code;
    if (repeats) ++latched_;
    return repeats;
  }

  [[nodiscard]] const Refusal& refusal() const { return refusal_; }
  /// Lines behind it that the controller took all the same.
  [[nodiscard]] std::uint32_t lines_executed() const { return executed_; }
  /// Lines behind it that the latch kept from being executed.
  [[nodiscard]] std::uint32_t lines_latched() const { return latched_; }
  /// The line to go on with once every line sent has been answered: the one behind the refused line if nothing behind
  /// it was executed, so that what the latch refused is sent again; else the one behind what was sent.
  [[nodiscard]] std::uint32_t goes_on_at() const {
    return (latched_ > 0 && executed_ == 0 ? refusal_.file_line : last_line_) + 1;
  }

 private:
  static constexpr int kNeverLatched = 40;

  Refusal refusal_;
  std::uint32_t last_line_ = 0;
  bool may_latch_ = false;
  std::uint32_t executed_ = 0;
  std::uint32_t latched_ = 0;
};

}  // namespace kerf::job
