#pragma once
// O words: which lines of a program are executed (grblHAL core ngc_flowctrl.c).

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/gcode/expression.hpp"

namespace kerf::gcode {

/// `O100` or `O<name>`.
struct FlowLabel {
  std::uint32_t number = 0;
  std::string name{};
  bool operator==(const FlowLabel&) const = default;

  /// Calls of such labels look for a file of that name.
  [[nodiscard]] bool names_file() const { return !name.empty() || number > kLastLocal; }
  static constexpr std::uint32_t kLastLocal = 65535;
};

/// Behind the line that is executed: where its file is read on, and which line that was.
struct FilePlace {
  std::uint64_t position = 0;
  std::int32_t line = 0;
};

/// What an O word asks for besides its answer.
struct FlowRequest {
  std::optional<int> alarm{};
};

/// Branches work anywhere. Loops, subroutines and calls go back in their file, so that they answer error:80 in a
/// stream.
class FlowControl {
 public:
  /// Lines are read and not executed.
  [[nodiscard]] bool skips() const { return skips_; }
  /// Forgets branches, loops and subroutines, and ends calls.
  void clear(Parameters& parameters);

  /// The statement at `at`, behind its label; `here` is nothing in a stream. An error forgets all that is open.
  ErrorCode run(const FlowLabel& label, ExpressionReader& reader, std::uint8_t at, Parameters& parameters,
                const std::optional<FilePlace>& here, FlowRequest& request);
  /// Where the last statement wants the file read on; asked for once.
  [[nodiscard]] std::optional<FilePlace> take_jump() { return std::exchange(jump_, std::nullopt); }

 private:
  enum class Keyword : std::uint8_t;
  /// What opened a level; a branch that was taken is known by its last word.
  enum class Opened : std::uint8_t { If, ElseIf, Else, Do, While, Repeat, Call };
  struct Level {
    FlowLabel label;
    Opened by = Opened::If;
    /// Where a loop begins, and where a call goes on.
    FilePlace place{};
    /// Of a WHILE: from the `[` on.
    std::string condition{};
    std::uint32_t repeats = 0;
    /// Its lines are passed over now.
    bool skips = false;
    /// One of its branches was taken.
    bool handled = false;
    /// BREAK has left the loop, whose end is still to come.
    bool left = false;
    bool in_subroutine = false;
  };
  struct Subroutine {
    FlowLabel label;
    FilePlace place;
  };
  /// A statement that is carried out.
  struct Statement;

  static std::optional<Keyword> read_keyword(const char* text, std::uint8_t& at);
  ErrorCode execute(Keyword keyword, Statement& statement);
  ErrorCode execute_in_file(Keyword keyword, Statement& statement);
  ErrorCode begin_if(Statement& statement);
  ErrorCode else_if(Statement& statement);
  ErrorCode otherwise(const FlowLabel& label);
  ErrorCode end_if(const FlowLabel& label);
  ErrorCode begin_while(Statement& statement);
  ErrorCode end_while(Statement& statement);
  ErrorCode begin_repeat(Statement& statement);
  ErrorCode end_repeat(Statement& statement);
  ErrorCode leave_loop(Statement& statement);
  ErrorCode next_round(Statement& statement);
  ErrorCode begin_subroutine(Statement& statement);
  ErrorCode call(Statement& statement);
  void end_call(Statement& statement);
  /// Looks at a loop's condition again, and goes back to its beginning.
  ErrorCode repeat_while(Level& level, Statement& statement);

  ErrorCode open(Level level);
  void close(Parameters& parameters);
  [[nodiscard]] bool is_branch() const { return !levels_.empty() && levels_.back().by <= Opened::Else; }
  [[nodiscard]] bool is_open(Opened by) const { return !levels_.empty() && levels_.back().by == by; }
  [[nodiscard]] ErrorCode misplaced() const;
  [[nodiscard]] bool is_passed_over() const { return skips_subroutine_ || (!levels_.empty() && levels_.back().skips); }

  static constexpr std::size_t kDeepest = 20;

  std::vector<Level> levels_;
  std::vector<Subroutine> subroutines_;
  /// The lines of a subroutine are passed over where it stands.
  bool skips_subroutine_ = false;
  bool in_subroutine_ = false;
  bool skips_ = false;
  std::optional<FilePlace> jump_{};
};

}  // namespace kerf::gcode
